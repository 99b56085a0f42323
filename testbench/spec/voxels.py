"""How a cell makes a voxel from a span.

A span's words are of the format `loading`; here they are plain integers in units of its last bit (of `S.formats.loading.f`
fraction bits), since sums of them are cut off at that bit."""

from hits import Voxel, WINDOW
from load_wire import CENTRE, COLOURS, FIELD_OF_NORMALS, LOAD_TYPES
from words import Value, clamp

MASK = 8                                            # sub-cells of a mask, along each axis


def span_names(option):
    """The words of a span in a record, but for edges and colours."""
    names = ["polygon", "x1", "xr"]
    if option["hit"] != "depth":
        return names + ["axis", "nx", "ny", "nz", "c", "slack"] + FIELD_OF_NORMALS + ["edges"]
    normals = CENTRE if option["normals"] == "voxel" else FIELD_OF_NORMALS
    return names + ["z", "dz", "axis", "nx", "ny", "nz"] + normals


class Span:
    """A part of a polygon in a row of cells, relative to the corner of column x1: the words of its message."""
    kind = "span"

    def __init__(self, S, words):
        self.S, self.names = S, span_names(S.option)
        fields = dict(zip(self.names, (int(word) for word in words)))
        def take(*names):
            return [fields.get(name, 0) for name in names]
        self.polygon, self.x1, self.last, self.drop = take("polygon", "x1", "xr", "axis")
        self.n, (self.c, self.slack) = take("nx", "ny", "nz"), take("c", "slack")
        self.normal, self.du, self.dv = (take(*FIELD_OF_NORMALS[i:i + 3]) for i in (0, 3, 6))
        self.z, self.dz = take("z", "dz")
        self.centre, self.d_centre = take(*CENTRE[:3]), take(*CENTRE[3:])
        rest = [int(word) for word in words[len(self.names):]]
        count = 3 * fields.get("edges", 0)
        self.edges = [rest[i:i + 3] for i in range(0, count, 3)]
        colours = rest[count:]
        if len(colours) != (6 if S.option["display"] == "gouraud" else 0) or len(words) < len(self.names):
            raise ValueError(f"a span does not have {len(words)} words")
        self.colour, self.d_colour = colours[:3], colours[3:]

    def words(self):
        values = dict(zip(FIELD_OF_NORMALS, self.normal + self.du + self.dv), polygon=self.polygon, x1=self.x1,
                      xr=self.last, axis=self.drop, c=self.c, slack=self.slack, z=self.z, dz=self.dz,
                      edges=len(self.edges))
        values.update(zip(["nx", "ny", "nz"] + CENTRE, self.n + self.centre + self.d_centre))
        numbers = [values[name] for name in self.names] + [word for edge in self.edges for word in edge]
        return [str(number) for number in numbers + self.colour + self.d_colour]

    def word_names(self):
        edges = [f"edge {i} {letter}" for i in range(len(self.edges)) for letter in "abc"]
        return self.names + edges + COLOURS * bool(self.colour)

    def wire_values(self):
        """In the order of the wires."""
        u, v = self.axes()
        plane = [self.drop, int(self.n[self.drop] < 0), self.n[u], self.n[v]]
        normals = self.normal + self.du + self.dv
        values = [LOAD_TYPES["span"], self.polygon, self.x1, self.last]
        if self.S.option["hit"] != "depth":
            values += plane + [self.c, self.slack] + normals + [len(self.edges)]
            values += [word for edge in self.edges for word in edge]
        else:
            values += [self.z, self.dz] + plane
            values += self.centre + self.d_centre if self.S.option["normals"] == "voxel" else normals
        return values + self.colour + self.d_colour

    def axes(self):
        return [axis for axis in range(3) if axis != self.drop]

    def advance(self):
        """To the next column."""
        form = self.S.formats.loading
        self.x1 += 1
        self.c -= self.n[0]
        if self.drop != 0:                          # x is u
            self.normal = sums(self.normal, self.du)
            self.edges = [[a, b, c + a] for a, b, c in self.edges]
        self.z += self.dz
        self.centre = sums(self.centre, self.d_centre)
        self.colour = [clamp(c, form.low, form.high) for c in sums(self.colour, self.d_colour)]


def sums(a, b):
    return [x + y for x, y in zip(a, b)]


class Plan:
    """The polygon's part in one cell, in (u, v): all integers are in last bits of the format `loading`."""

    def __init__(self, S, span):
        self.S, self.span = S, span
        self.f = S.formats.loading.f
        self.one = 1 << self.f
        self.hair = self.cut(S.formats.hair)
        self.axes = span.axes()

    def cut(self, x):
        """A Value in whole last bits, towards minus infinity."""
        return x.raw >> (x.frac - self.f) if x.frac > self.f else x.at(self.f)

    def at(self, line, p):
        a, b, c = line
        return c + (a * p[0] + b * p[1] >> self.f)

    def height(self):
        """The third coordinate over (u, v), as a line."""
        u, v = self.axes
        n, c = self.span.n, self.span.c
        sign = 1 if n[self.span.drop] > 0 else -1
        return -sign * n[u], -sign * n[v], sign * c

    def corners(self):
        """Of the part, in order round it; an empty list if there is none."""
        S, span = self.S, self.span
        ends = [self.one, self.one, self.cut(S.level * S.option["depth"])]
        u, v = (ends[axis] for axis in self.axes)
        corners = [(0, 0), (u, 0), (u, v), (0, v)]
        room = max(self.cut(Value(1, S.formats.F)), 1)
        for a, b, c in span.edges:
            corners = self.clipped(corners, (a, b, c + room))
        if span.drop != 2:                          # by the cell's two borders along the dropped axis
            a, b, c = self.height()
            slack = span.slack
            corners = self.clipped(corners, (a, b, c + slack))
            corners = self.clipped(corners, (-a, -b, self.one + slack - c))
        return corners

    def clipped(self, corners, line):
        values = [self.at(line, p) for p in corners]
        if all(x >= 0 for x in values):
            return corners
        kept = []
        for i, p in enumerate(corners):
            j = (i + 1) % len(corners)
            if values[i] >= 0:
                kept.append(p)
            if values[i] > 0 > values[j]:
                kept.append(self.border(p, corners[j], values[i], values[j]))
            elif values[j] > 0 > values[i]:
                kept.append(self.border(corners[j], p, values[j], values[i]))
        return kept if len(kept) >= 3 else []

    def border(self, inner, outer, inside, outside):
        """Where a side meets the line, from its inner end on."""
        bits = self.S.formats.W + 15
        share = (inside << bits) // (inside - outside)
        return tuple(a + ((b - a) * share >> bits) for a, b in zip(inner, outer))

    # Bounds, middle and area

    def measure(self, corners):
        n = len(corners)
        height = self.height()
        heights = [self.at(height, p) for p in corners]
        middle = [sum(p[k] for p in corners) * ((1 << 32) // n) >> 32 for k in (0, 1)]
        self.low = self.point([min(p[k] for p in corners) for k in (0, 1)], min(heights))
        self.high = self.point([max(p[k] for p in corners) for k in (0, 1)], max(heights))
        self.middle = self.point(middle, self.at(height, middle))
        u, v = corners[0]
        area = 0
        for p, q in zip(corners, corners[1:] + corners[:1]):
            area += ((p[0] - u) * (q[1] - v) >> self.f) - ((p[1] - v) * (q[0] - u) >> self.f)
        self.twice_area = area

    def point(self, uv, third):
        point = [0, 0, 0]
        point[self.axes[0]], point[self.axes[1]], point[self.span.drop] = uv[0], uv[1], third
        return point

    # Edges that cross the run's box, and the mask

    def least(self, line, low, high):
        return self.at(line, [low[k] if line[k] > 0 else high[k] for k in (0, 1)])

    def most(self, line, low, high):
        return self.at(line, [high[k] if line[k] > 0 else low[k] for k in (0, 1)])

    def cover(self, voxel):
        """The edges that cross; None if the polygon does not touch the box."""
        low, high = [0, 0, self.cut(voxel.near)], [self.one, self.one, self.cut(voxel.far)]
        low, high = [low[axis] for axis in self.axes], [high[axis] for axis in self.axes]
        if any(self.most(line, low, high) < -self.hair for line in self.span.edges):
            return None
        crossing = [line for line in self.span.edges if self.least(line, low, high) < -self.hair]
        if self.S.option["hit"] == "mask":
            self.set_mask(voxel, low, high, crossing)
        return crossing

    def set_mask(self, voxel, low, high, crossing):
        hair = self.hair
        bounds = [(self.low[axis] - hair, self.high[axis] + hair) for axis in self.axes]
        borders, window = [], []
        for k in (0, 1):
            size = high[k] - low[k]
            first = clamp((bounds[k][0] - low[k]) * WINDOW // size, 0, WINDOW - 1)
            last = clamp(-(-(bounds[k][1] - low[k]) * WINDOW // size), first + 1, WINDOW)
            window += [first, last]
            start, end = low[k] + (size * first >> 5), low[k] + (size * last >> 5)
            borders.append([start + ((end - start) * i >> 3) for i in range(MASK + 1)])
        for row in range(MASK):
            for column in range(MASK):
                near = [borders[0][column], borders[1][row]]
                far = [borders[0][column + 1], borders[1][row + 1]]
                touched = all(near[k] <= bounds[k][1] and bounds[k][0] <= far[k] for k in (0, 1))
                if touched and all(self.most(line, near, far) >= -hair for line in crossing):
                    voxel.mask |= 1 << (MASK * row + column)
        voxel.window = window

    # Words of the voxel; all Values below

    def word(self, raw):
        return Value(raw, self.f)

    def anchor(self, voxel):
        p = [voxel.point[0], voxel.point[1], voxel.point[2] - voxel.base]
        return [p[axis] for axis in self.axes]

    def set_plane(self, voxel):
        """The plane is right at the voxel's point, whatever its rounded slopes lose elsewhere."""
        f, span = self.S.formats, self.span
        if self.S.option["hit"] == "depth":         # a span's slopes are words of the voxel there
            voxel.n, voxel.c = [f.unit.word(raw) for raw in span.n], f.offset.word(0)
            return
        n = [self.word(raw) for raw in span.n]
        voxel.n = [f.unit.hold(c) for c in n]
        offset = self.word(span.c) - n[2] * voxel.base
        for axis, place in zip(self.axes, self.anchor(voxel)):
            offset += (voxel.n[axis] - n[axis]) * place
        voxel.c = f.offset.hold(offset)

    def set_normal(self, voxel):
        S, f, span = self.S, self.S.formats, self.span
        base, du, dv = [[self.word(raw) for raw in v] for v in (span.normal, span.du, span.dv)]
        none = [self.word(0)] * 3
        anchor = self.anchor(voxel)
        if S.option["normals"] == "voxel":
            if S.option["hit"] == "depth":
                base = [self.word(raw) for raw in span.centre]
            else:
                base = self.field(base, du, dv, [voxel.point[axis] for axis in self.axes])
            du = dv = none
        elif span.drop != 2:                        # v is z: from `base` on
            base = [f.loading.hold(b + voxel.base * d) for b, d in zip(base, dv)]
        if any(d.raw for d in du + dv):
            middle = self.field(base, du, dv, anchor)
            k = power_that_fills(base + du + dv)
            if all(abs(scaled(c, k)) < Value(64, f.normal.f) for c in middle):
                base, du, dv = middle, none, none   # it turns too fast for words
        k = power_that_fills(base + du + dv)
        base, du, dv = [[scaled(c, k) for c in v] for v in (base, du, dv)]
        voxel.du, voxel.dv = [f.normal.hold(d) for d in du], [f.normal.hold(d) for d in dv]
        voxel.normal = [f.normal.hold(base[i] + (du[i] - voxel.du[i]) * anchor[0] + (dv[i] - voxel.dv[i]) * anchor[1])
                        for i in range(3)]

    def field(self, base, du, dv, p):
        hold = self.S.formats.loading.hold
        return [hold(b + d * p[0] + e * p[1]) for b, d, e in zip(base, du, dv)]

    def held_edge(self, voxel, line):
        """An edge is right at its foot, next to the middle of the run's box."""
        f = self.S.formats
        a, b, c = (self.word(raw) for raw in line)
        middle = [Value(1, 1), Value(1, 1), (voxel.far - voxel.near) * Value(1, 1)]
        u, v = (middle[axis] for axis in self.axes)
        if voxel.drop != 2:
            c = f.loading.hold(c + b * voxel.base)
        off = f.loading.hold(c + a * u + b * v)
        foot_u, foot_v = f.loading.hold(u - off * a), f.loading.hold(v - off * b)
        a, b = f.unit.hold(a), f.unit.hold(b)
        return a, b, f.edge_offset.hold(-(a * foot_u) - b * foot_v), 0


def power_that_fills(components):
    """k: the largest component times 2^k is from 4 to below 8."""
    tops = [abs(c.raw).bit_length() - 1 - c.frac for c in components if c.raw]
    return 2 - max(tops) if tops else 0


def scaled(x, k):
    return Value(x.raw, x.frac - k)


def set_run(S, voxel, near, far):
    last = S.option["depth"] - 1
    voxel.near_level = clamp(level_below(S, near), 0, last)
    voxel.far_level = clamp(level_below(S, far), 0, last) + 1
    set_ends(S, voxel)
    voxel.base = voxel.near


def level_below(S, z):
    over, under, _ = z.pair(S.level)
    return over // under


def set_ends(S, voxel):
    form = S.formats.depth
    voxel.near, voxel.far = form.hold(S.level * voxel.near_level), form.hold(S.level * voxel.far_level)
    if not voxel.far > voxel.near:                  # a level is less than the last bit
        voxel.far = voxel.near + Value(1, form.f)


def voxel_of(S, span, plan, object_number):
    """A voxel without plane and normals, or None: the polygon does not touch the cell."""
    f, rung = S.formats, S.option["hit"]
    voxel = Voxel()
    voxel.polygon, voxel.object, voxel.drop = span.polygon, object_number, span.drop
    voxel.pieces = voxel.twice_area = 0
    if rung == "depth":
        z = plan.word(span.z)
        set_run(S, voxel, z, z)
        voxel.point = [f.unit.hold(Value(1, 1)), f.unit.hold(Value(1, 1)), f.depth.hold(z)]
        return voxel
    corners = plan.corners()
    if not corners:
        return None
    plan.measure(corners)
    room = f.hair + plan.word(span.slack) if span.drop == 2 else f.hair
    set_run(S, voxel, plan.word(plan.low[2]) - room, plan.word(plan.high[2]) + room)
    crossing = plan.cover(voxel)
    if crossing is None:
        return None
    voxel.twice_area = plan.twice_area
    x, y, z = (plan.word(raw) for raw in plan.middle)
    voxel.point = [f.unit.hold(clamp(x, Value(0), Value(1))), f.unit.hold(clamp(y, Value(0), Value(1))), f.depth.hold(z)]
    if rung == "edge":
        voxel.edges = [plan.held_edge(voxel, line) for line in crossing]
        voxel.pieces = 1 if voxel.edges else 0
    return voxel


def store_voxel(S, voxels, span, object_number):
    """Makes the voxel; a piece of the polygon that came last joins its voxel."""
    plan = Plan(S, span)
    piece = voxel_of(S, span, plan, object_number)
    if piece is None:
        return
    if S.option["hit"] != "mask" and voxels and voxels[-1].polygon == span.polygon:
        join(S, voxels[-1], piece, plan)
        return
    if len(voxels) >= (S.option["voxel-capacity"] or len(voxels) + 1):
        return
    plan.set_plane(piece)
    plan.set_normal(piece)
    voxels.append(piece)


def join(S, voxel, piece, plan):
    voxel.near_level = min(voxel.near_level, piece.near_level)
    voxel.far_level = max(voxel.far_level, piece.far_level)
    if piece.twice_area > voxel.twice_area:
        voxel.twice_area, voxel.point = piece.twice_area, piece.point
    set_ends(S, voxel)
    voxel.edges = moved(S, voxel, voxel.edges, voxel.near - voxel.base)
    voxel.base = voxel.near
    plan.set_plane(voxel)
    plan.set_normal(voxel)
    if voxel.pieces == 0:
        return                                      # it covers the cell
    if not piece.edges:
        voxel.edges, voxel.pieces = [], 0
        return
    more = moved(S, voxel, piece.edges, voxel.base - piece.base)
    voxel.edges = voxel.edges + [(a, b, c, voxel.pieces) for a, b, c, _ in more]
    voxel.pieces += 1


def moved(S, voxel, edges, way):
    """Edges with z counted from a place that is `way` farther."""
    if voxel.drop == 2 or way.raw == 0:
        return edges
    return [(a, b, S.formats.edge_offset.hold(c + b * way), piece) for a, b, c, piece in edges]
