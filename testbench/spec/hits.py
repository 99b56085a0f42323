"""What a voxel holds, and the tests of the five rungs."""

from words import Value, ZERO, clamp, shifted
from operators import dot

WINDOW = 32         # windows of masks are in 32nds of the cell


class Voxel:
    polygon = object = near_level = 0
    near = far = base = ZERO
    drop = 0
    n, c = None, None
    edges = ()                                      # (a, b, c, piece)
    mask, window = 0, (0, WINDOW, 0, WINDOW)
    normal = du = dv = point = None


def project(p, voxel):
    q = [p[0], p[1], p[2] - voxel.base]
    del q[voxel.drop]
    return q


def nearest_hit(ray, t_end, voxels, S, v):
    """(distance, number), or None; counts into `v`."""
    f = S.formats
    if not voxels:
        return None
    z0 = ray.p[2]
    z1 = f.depth.hold(z0 + t_end * ray.d[2])
    low, high = (z0, z1) if z0 < z1 else (z1, z0)
    test = test_run if S.option["hit"] in ("depth", "interval") else test_plane
    nearest = None
    low, high, inwards = low - f.hair, high + f.hair, ray.d[2].raw >= 0
    for i, most in index_table(voxels) if inwards else reversed(index_table(voxels)):
        voxel = voxels[i]
        v.runs += 1
        if voxel.near > high if inwards else most < low:
            break
        if voxel.polygon == ray.leaves or voxel.near > high or voxel.far < low:
            continue
        v.tests += 1
        v.edges += len(voxel.edges)
        t = test(ray, t_end, z1, voxel, S)
        if t is None:
            continue
        if nearest:
            first, other = nearest[0], voxels[nearest[1]]
            nearer = t <= first + f.tie if voxel.polygon < other.polygon else t < first - f.tie
        if not nearest or nearer:
            nearest = (t, i)
            z = f.depth.hold(z0 + t * ray.d[2])
            low, high = (low, min(high, z + f.tie)) if inwards else (max(low, z - f.tie), high)
    return nearest


def index_table(voxels):
    """By near: number of the voxel, largest far up to it."""
    table, most = [], None
    for i in sorted(range(len(voxels)), key=lambda i: voxels[i].near_level):
        most = voxels[i].far if most is None else max(most, voxels[i].far)
        table.append((i, most))
    return table


def test_run(ray, t_end, z1, voxel, S):
    """Rungs interval and depth."""
    f, z0, dz = S.formats, ray.p[2], ray.d[2]
    if (z0 < voxel.near and z1 < voxel.near) or (z0 > voxel.far and z1 > voxel.far):
        return None
    if S.option["hit"] == "depth" and z0 >= voxel.far and z1 >= voxel.far:
        return None                                 # the far end of a level is the next one's
    if voxel.near <= z0 <= voxel.far:
        t = f.distance.word(0)
    else:
        end = voxel.near if dz > 0 else voxel.far
        t = clamp(f.distance.hold((end - z0) * S.operators.reciprocal(dz)), f.distance.word(0), t_end)
    return t


def test_plane(ray, t_end, _, voxel, S):
    """Rungs plane, mask and edge."""
    f, rung = S.formats, S.option["hit"]
    n, p = voxel.n, ray.p
    along = dot(f.accumulator, n, ray.d)
    if abs(along.raw) < (2 if f.accumulator.f == 40 else 1):
        return None                                 # in the plane
    off = f.depth.hold(voxel.c - n[0] * p[0] - n[1] * p[1] - n[2] * (p[2] - voxel.base))
    inverse = S.operators.reciprocal(along)
    t = f.distance.hold(off * inverse)
    room = f.hair * clamp(abs(inverse), Value(1), Value(1024))
    starts_here = ray.fresh and ray.leaves != -1
    if t < (f.least_fresh if starts_here else -room) or t > t_end + room:
        return None
    if starts_here and rung != "edge" and ray.leaves_front == (along > 0):
        return None                                 # the plane runs on behind its polygon
    point = [f.unit.hold(p[0] + t * ray.d[0]), f.unit.hold(p[1] + t * ray.d[1]), f.depth.hold(p[2] + t * ray.d[2])]
    if point[2] < voxel.near - room or point[2] > voxel.far + room:
        return None
    if rung == "edge" and not inside_edges(point, voxel, S):
        return None
    if rung == "mask" and not inside_mask(point, room, voxel, S):
        return None
    return t if t > 0 else f.distance.word(0)


def inside_edges(point, voxel, S):
    """Inside all edges of one of its pieces."""
    if not voxel.edges:
        return True
    u, v = project(point, voxel)
    form, hair = S.formats.edge_offset, S.formats.hair
    inside = {}
    for a, b, c, piece in voxel.edges:
        if inside.setdefault(piece, True):
            inside[piece] = form.hold(c + a * u + b * v) >= -hair
    return any(inside.values())


def inside_mask(point, room, voxel, S):
    f = S.formats
    place, rooms = list(point), [room] * 3
    if voxel.drop != 2:                             # z as a share of the run
        per_run = S.operators.reciprocal(voxel.far - voxel.near)
        place[2] = f.field.hold((point[2] - voxel.near) * per_run)
        rooms[2] = f.field.hold(room * per_run)
    bit = []
    for k, axis in enumerate([i for i in range(3) if i != voxel.drop]):
        low, high = voxel.window[2 * k], voxel.window[2 * k + 1]
        per_window = S.operators.reciprocal(Value(high - low))
        at = f.field.hold((place[axis] * WINDOW - low) * per_window)
        around = f.field.hold(rooms[axis] * WINDOW * per_window)
        if at < -around or at > 1 + around:
            return False
        bit.append(clamp(shifted(at.raw * 8, at.frac, False), 0, 7))
    return bool(voxel.mask >> (8 * bit[1] + bit[0]) & 1)
