"""What every cell knows, rays, the walk, and what becomes of a tested ray."""

from math import gcd

from hits import nearest_hit
from operators import Operators, normalise
from words import ZERO, Formats, Value, clamp, exact, hold_place, way_to

EAST, SOUTH, WEST, NORTH = range(4)
SIDES = ["east", "south", "west", "north"]
STEP = [(1, 0), (0, 1), (-1, 0), (0, -1)]
FRONT, BACK = 4, 5
FACE_OF_SIDE = [1, 3, 0, 2]                         # left, right, top, bottom, front, back
KINDS = ["primary", "reflected", "refracted", "shadow", "memo", "precast"]
AREAS = ("rectangle", "triangle", "sphere")
SHADOWS = ("shadow", "memo", "precast")
ANSWERS = {"shared": 0, "split": 1, "half": 2, "quadrant": 4}      # class of answers; the last one of all


class Machine:
    """What a cell has latched when loading is over: a record's head."""

    def __init__(self, option, columns, rows, depth, eye, beyond):
        """depth: a Fraction; eye: three Values, None at infinity."""
        self.option, self.width, self.height = option, columns, rows
        f = self.formats = Formats(option["word-bits"], option["rounding"] == "nearest", columns, rows, depth,
                                   option["depth"])
        self.operators = Operators(option)
        self.depth = f.depth.hold(exact(depth))
        self.level = exact(depth / option["depth"])
        self.eye = None if eye is None else hold_place(eye, f)
        self.faces = beyond
        self.beyond = beyond if option["exterior"] == "host" else [False] * 6
        offset = option["normal-offset"]
        self.normal_offset = f.unit.hold(exact(offset) if offset >= 0 else f.normal_offset)
        self.min_weight = exact(option["min-weight"])
        self.background, self.objects, self.sources = None, [], []
        self.lights = []                            # (source, u, v): one for each shadow ray of a hit

    def set_sources(self, sources):
        self.sources, samples = sources, self.option["source-samples"]
        step_u, step_v = sample_steps(samples)
        for source in sources:
            for k in range(samples if source.is_area() else 1):
                self.lights.append((source, k * step_u & 0xffff, k * step_v & 0xffff))
        self.share = share_of(samples, self.formats)

    def cost(self, name):
        option, costs = self.option, self.option["cost"]
        if name in ("reciprocal", "root"):
            return costs[name + "_" + option[name]]
        if name == "power":
            divides = option["power"] == "schlick"
            return costs["power_" + option["power"]] + (self.cost("reciprocal") if divides else 0)
        return costs[name]

    def class_of_rays(self, d):
        west, north = int(d[0] < 0), int(d[1] < 0)
        return {"half": west, "quadrant": west + 2 * north}.get(self.option["networks"], 0)

    def carries_rays(self, index, side):
        """Whether rays of this class come in over `side`."""
        networks = self.option["networks"]
        if networks in ("shared", "split"):
            return index == 0
        if index == ANSWERS[networks]:
            return False
        if side in (EAST, WEST):
            return (index & 1) == (1 if side == EAST else 0)
        return networks == "half" or (index >> 1) == (1 if side == SOUTH else 0)


class Material:
    def __init__(self, colour, kd, ks, t, shine, ior, mirror):
        self.colour, self.kd, self.ks, self.t = colour, kd, ks, t
        self.shine, self.ior, self.mirror = shine, ior, mirror
        self.mirrored = ks if mirror else ZERO      # share of the reflected ray


class Source:
    def __init__(self, kind, position, intensity):
        self.kind, self.position, self.intensity = kind, position, intensity
        self.axis = self.cut_off = self.falloff = None      # of some kinds
        self.edge_u = self.edge_v = self.radius = self.exponent = None

    def is_area(self):
        return self.kind in AREAS

    def is_flat(self):
        return self.kind in ("rectangle", "triangle")


def sample_steps(n):
    """Of the lattices with a point in every row and column, the one whose nearest points are farthest apart."""
    def gap(g):
        return min([min(k, n - k) ** 2 + min(g * k % n, n - g * k % n) ** 2 for k in range(1, n)], default=0)
    generator = max((g for g in range(1, n + 1) if gcd(g, n) == 1), key=gap)
    return [((k * 65536 + n // 2) // n) & 0xffff for k in (1, generator % n)]


def share_of(n, f):
    """1 / n: a mantissa below 1 of W - 1 bits."""
    if n == 1:
        return f.one
    exponent = -((n - 1).bit_length() - 1)
    digits = f.W - 1 - exponent
    quotient, rest = divmod(1 << digits + 1, n)
    mantissa = (quotient >> 1) + int(bool(quotient & 1) and (rest > 0 or quotient >> 1 & 1))
    return Value(min(mantissa, (1 << f.W - 1) - 1), digits)


class Ray:
    def __init__(self, S, kind, home):
        self.kind, self.home = kind, home
        self.pixel = self.branch = self.generation = self.slot = self.child = 0
        self.p = self.d = self.inverse = None
        self.weight = S.formats.one
        self.reach = S.formats.reach.most           # infinite
        self.leaves, self.leaves_front, self.fresh, self.outside = -1, False, True, False

    def is_shadow(self):
        return self.kind in SHADOWS

    def depth_face(self):
        return BACK if self.d[2] > 0 else FRONT

    def set_direction(self, d, S):
        self.d = d
        self.inverse = [S.operators.reciprocal(c) if c.raw else ZERO for c in d[:2]]


def primary_ray(S, x, y):
    f = S.formats
    ray = Ray(S, "primary", (x, y))
    ray.pixel = y * S.width + x
    half = f.unit.word(1 << (f.F - 1))
    ray.p = [half, half, f.depth.word(0)]
    if S.eye is None:
        d = [f.nothing, f.nothing, f.one]
    else:
        way = way_to(S.eye, [Value(2 * x + 1, 1), Value(2 * y + 1, 1), ZERO], f)
        d, _ = normalise([-c for c in way], S)
    ray.set_direction(d, S)
    return ray


def next_crossing(ray, S):
    """(distance, side); the distance is None if the ray crosses no side."""
    nearest = (None, EAST)
    for axis in (0, 1):
        if ray.d[axis].raw == 0:
            continue
        forward = ray.d[axis].raw > 0
        t = S.formats.distance.hold((int(forward) - ray.p[axis]) * ray.inverse[axis])
        if nearest[0] is None or t < nearest[0]:
            nearest = (t, axis if forward else axis + 2)
    return nearest


def point_at(ray, t, S):
    f = S.formats
    return [f.unit.hold(ray.p[0] + t * ray.d[0]), f.unit.hold(ray.p[1] + t * ray.d[1]),
            f.depth.hold(ray.p[2] + t * ray.d[2])]


def move_along(ray, t, S):
    f = S.formats
    x, y, z = point_at(ray, t, S)
    ray.p = [clamp(x, f.nothing, f.one), clamp(y, f.nothing, f.one), z]
    if ray.reach < f.reach.most:
        ray.reach = f.reach.hold(ray.reach - t)
    ray.fresh = False


def cross(ray, crossing, S):
    """Into the coordinates of the next cell."""
    t, side = crossing
    if ray.d[0].raw == 0 and ray.d[1].raw == 0:
        return                                      # on its way to the border outside the cube
    move_along(ray, t, S)
    ray.p[side % 2] = S.formats.nothing if side in (EAST, SOUTH) else S.formats.one


class Visit:
    """The traversal unit's answer to a ray, and the comparisons that it made."""

    def __init__(self):
        self.event = "forward"                      # or hit, leaves_cube, reaches_source
        self.crossing = self.hit = self.t_leave = None
        self.runs = self.tests = self.edges = 0

    def cycles(self, S):
        rung = S.option["hit"]
        run = S.cost("compare_depth" if rung == "depth" else "compare_interval")
        test = S.cost("reciprocal") + S.cost("compare_" + rung if rung in ("plane", "mask", "edge") else "enter_run")
        leaving = S.cost("leave_cube") if self.t_leave is not None else 0
        if leaving:
            leaving += S.cost("reciprocal")
        return S.cost("walk_step") + leaving + self.runs * run + self.tests * test + self.edges * S.cost("per_edge")


def visit(ray, voxels, S):
    v = Visit()
    v.crossing = next_crossing(ray, S)
    if ray.outside:
        if v.crossing[0] is None:
            v.crossing = (ZERO, EAST)
        return v
    t_end = way_in_cell(ray, v, S)
    infinite = not ray.reach < S.formats.reach.most
    if not infinite and ray.reach <= t_end:
        t_end, v.event = ray.reach, "reaches_source"
    hit = nearest_hit(ray, t_end, voxels, S, v)
    if hit and ray.is_shadow() and not infinite and hit[0] >= ray.reach - S.formats.hair:
        hit = None                                  # a surface at the source itself does not hide it
    if hit:
        v.event, v.hit = "hit", hit
    return v


def way_in_cell(ray, v, S):
    """The distance to the next side, or to the front or back of the cube if that is nearer."""
    f = S.formats
    t_end, dz = v.crossing[0], ray.d[2]
    bound = S.depth if dz > 0 else ZERO
    if t_end is not None:
        z = f.depth.hold(ray.p[2] + t_end * dz)
        if not (z > bound if dz > 0 else z < bound):
            return t_end
    t = f.distance.hold((bound - ray.p[2]) * S.operators.reciprocal(dz))
    if t < 0:
        t = f.distance.word(0)
    v.event = "leaves_cube"
    v.t_leave = t if t_end is None or t < t_end else t_end
    return v.t_leave


class Need:
    """What a tested ray waits for: output, response, nothing, border_walk, slot or shading_unit."""

    def __init__(self, kind):
        self.kind = kind
        self.side = self.index = self.answer = None
        self.over_border = self.lost = False


def end_of(ray, answer, lost=False):
    need = Need("nothing" if ray.kind == "precast" and answer == "lit" else "response")
    need.answer, need.lost = answer, lost
    return need


def end_beyond(ray):
    return end_of(ray, "lit" if ray.is_shadow() else "intensity", lost=True)


def need_of(ray, v, voxels, S, x, y):
    if v.event == "forward":
        side = v.crossing[1]
        to_x, to_y = x + STEP[side][0], y + STEP[side][1]
        inside = 0 <= to_x < S.width and 0 <= to_y < S.height
        face = ray.depth_face() if ray.outside else FACE_OF_SIDE[side]
        if not inside and not S.beyond[face]:
            return end_beyond(ray)
        need = Need("output")
        need.side, need.index, need.over_border = side, S.class_of_rays(ray.d), not inside
        return need
    if v.event == "reaches_source":
        return end_of(ray, "lit")
    if v.event == "leaves_cube":
        return Need("border_walk") if S.beyond[ray.depth_face()] else end_beyond(ray)
    if ray.is_shadow():
        return end_of(ray, "blocked")
    return Need("slot" if may_wait(S, ray, S.objects[voxels[v.hit[1]].object]) else "shading_unit")


def may_wait(S, ray, material):
    if S.option["shadows"] != "precast" and S.sources:
        return True
    return ray.generation < S.option["max-depth"] and (material.mirrored > 0 or material.t > 0)
