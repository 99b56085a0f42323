"""The shading unit's arithmetic: set-up of a hit, its children, its intensity, and their cycles."""

from hits import project
from lights import lit_cycles, set_up_cycles, shift_of, view
from operators import dot, normalise, square_root
from rays import KINDS, Ray, point_at
from words import Value, ZERO, clamp, exact


class Setup:
    """A hit, set up: place, normal turned to the ray, sources that it faces, directions of its children."""

    def __init__(self, S, ray, t, voxel, x, y):
        f = S.formats
        self.material = S.objects[voxel.object]
        self.local = point_at(ray, t, S)
        self.position = [self.local[0] + x, self.local[1] + y, self.local[2]]
        self.direction = ray.d
        normal = hit_normal(S, self.local, voxel)
        self.entering = dot(f.accumulator, normal, ray.d) < 0
        self.normal = normal if self.entering else [-c for c in normal]
        shift = shift_of(voxel.polygon, x, y)
        self.views = [view(S, light, self.position, self.normal, shift) for light in S.lights]
        self.facing = [k for k, v in enumerate(self.views) if v.cosine > 0 and v.emission > 0]
        shares = [self.material.mirrored, self.material.t]
        self.sends = [worth(S, ray, share) for share in shares]
        self.children = [reflected(S, self) if self.sends[0] else None, refracted(S, self) if self.sends[1] else None]

    def cycles(self, S):
        root, start = S.cost("root"), S.cost("ray_start") + 2 * S.cost("reciprocal")
        cycles = S.cost("shade_setup") + root + set_up_cycles(S)
        if S.option["normals"] == "linear":
            cycles += S.cost("normal_linear")
        if S.option["shadows"] == "per-hit":
            cycles += len(self.facing) * start
        if self.sends[0]:
            cycles += S.cost("reflect") + root + start
        if self.sends[1]:
            cycles += S.cost("refract") + S.cost("reciprocal") + 2 * root + start
        return cycles

    def lit_cycles(self, S, lit, waited):
        """`waited`: the hit was in a slot, which keeps no directions of sources."""
        lights = [k for k in self.facing if k in lit]
        cycles = S.cost("local_intensity") + lit_cycles(S, lights, waited)
        if lights and self.material.ks > 0 and not self.sends[0] and S.cost("mirrored") > 0:
            cycles += S.cost("mirrored") + S.cost("root")
        return cycles


def hit_normal(S, local, voxel):
    f = S.formats
    u, v = project(local, voxel)
    field = [f.field.hold(voxel.normal[i] + u * voxel.du[i] + v * voxel.dv[i]) for i in range(3)]
    least = Value(64, 2 * (f.W - 4))
    stands = dot(f.accumulator, field, field) > least
    return normalise(field if stands else voxel.n, S)[0]


def worth(S, ray, share):
    return share > 0 and ray.generation < S.option["max-depth"] and ray.weight * share >= S.min_weight


def reflected(S, s):
    f = S.formats
    twice = dot(f.unit, s.direction, s.normal) * -2
    return normalise([f.field.hold(d + twice * n) for d, n in zip(s.direction, s.normal)], S)[0]


def refracted(S, s):
    """The mirrored direction on total internal reflection."""
    f = S.formats
    ior = s.material.ior
    eta = f.normal.hold(S.operators.reciprocal(ior) if s.entering else ior)
    cosine = f.unit.hold(-dot(f.unit, s.direction, s.normal))
    squared_sine = f.field.hold(1 - cosine * cosine)
    squared = 1 - f.field.hold(f.field.hold(eta * eta) * squared_sine)
    if squared < 0:
        return reflected(S, s)
    across = f.field.hold(eta * cosine - square_root(squared, S))
    way = [f.field.hold(eta * d) for d in s.direction]
    way = [f.field.hold(w + across * n) for w, n in zip(way, s.normal)]
    if not any(w != ZERO for w in way):             # short words may leave nothing of it
        return reflected(S, s)
    return normalise(way, S)[0]


def received(S, s, k, mirrored):
    """N·L and the highlight of a light, both times what it sends this way."""
    unit, seen = S.formats.unit, s.views[k]
    shine, cosine = ZERO, seen.cosine
    if mirrored:
        along = dot(unit, mirrored, seen.direction)
        if along > 0:
            shine = S.operators.power(along, s.material.shine)
    if S.lights[k][0].kind == "spot" or S.lights[k][0].is_flat():
        cosine, shine = unit.hold(cosine * seen.emission), unit.hold(shine * seen.emission)
    return cosine, shine


def intensity_of(S, s, lit, answers):
    """What a hit sends home. `lit`: lights whose light arrives; `answers`: of the reflected and the refracted ray."""
    f, material = S.formats, s.material
    ambient = f.unit.hold(f.unit.hold(exact(0.1)) * material.kd)
    total = [f.intensity.hold(ambient * c) for c in material.colour]
    mirrored = reflected(S, s) if material.ks > 0 else None
    for source in S.sources:
        shares = [received(S, s, k, mirrored) for k in s.facing if k in lit and S.lights[k][0] is source]
        if not shares:
            continue
        cosine, shine = shares[0]
        if source.is_area():                        # the mean over its samples: the sums are exact
            cosine, shine = (f.unit.hold(sum(share, ZERO) * S.share) for share in zip(*shares))
        highlight = f.intensity.hold(material.ks * shine)
        diffuse = f.unit.hold(material.kd * cosine)
        for i in range(3):
            share = f.intensity.hold(highlight + diffuse * material.colour[i])
            total[i] = f.intensity.hold(total[i] + source.intensity[i] * share)
    return [f.intensity.hold(c + material.mirrored * a + material.t * b) for c, a, b in zip(total, *answers)]


def mixed(h):
    h = (h ^ h >> 16) * 0x85ebca6b & 0xffffffff
    h = (h ^ h >> 13) * 0xc2b2ae35 & 0xffffffff
    return h ^ h >> 16


def child_ray(S, kind, child, pixel, branch, generation, slot, home):
    ray = Ray(S, kind, home)
    ray.pixel, ray.child, ray.generation, ray.slot = pixel, child, generation + 1, slot
    ray.branch = mixed((branch * 31 + (KINDS.index(kind) << 8) + child + 1) & 0xffffffff)
    return ray


def leave_surface(S, ray, local, voxel):
    """It starts a small offset off the plane, on the side that it goes to."""
    f = S.formats
    back = dot(f.accumulator, voxel.n, ray.d) < 0
    offset = -S.normal_offset if back else S.normal_offset
    x, y, z = [form.hold(p + offset * n) for form, p, n in zip((f.unit, f.unit, f.depth), local, voxel.n)]
    ray.p = [clamp(x, f.nothing, f.one), clamp(y, f.nothing, f.one), z]
    ray.leaves, ray.leaves_front = voxel.polygon, not back


def secondary_ray(S, parent, s, voxel, child, slot, home):
    """child 0: reflected, 1: refracted."""
    ray = child_ray(S, KINDS[1 + child], child, parent.pixel, parent.branch, parent.generation, slot, home)
    ray.weight = S.formats.unit.hold(parent.weight * (s.material.t if child else s.material.mirrored))
    ray.set_direction(s.children[child], S)
    leave_surface(S, ray, s.local, voxel)
    return ray


def shadow_ray(S, parent, s, voxel, light, slot, home):
    ray = child_ray(S, "shadow", light, parent.pixel, parent.branch, parent.generation, slot, home)
    ray.reach = s.views[light].distance
    ray.set_direction(s.views[light].direction, S)
    leave_surface(S, ray, s.local, voxel)
    return ray


def voxel_shadow_ray(S, voxels, index, light, kind, home):
    """memo, precast: from the voxel's own point."""
    voxel, (x, y) = voxels[index], home
    ray = child_ray(S, kind, light, y * S.width + x, index, 0, index, home)
    point = voxel.point
    place = [point[0] + x, point[1] + y, point[2]]
    seen = view(S, S.lights[light], place, None, shift_of(voxel.polygon, x, y))
    ray.reach = seen.distance
    ray.set_direction(seen.direction, S)
    leave_surface(S, ray, point, voxel)
    return ray
