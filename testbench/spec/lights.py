"""Lights: what shadow rays go to. A source that is an area is as many points as there are samples."""

from operators import dot, normalise, square_root
from words import Format, Value, ZERO, exact, way_to


class View:
    """Of a light: direction, distance, N·L, and the share of its intensity that goes this way."""

    def __init__(self, f):
        self.direction, self.distance, self.cosine = [f.nothing, f.nothing, f.one], f.reach.word(0), f.nothing
        self.emission = f.one


def shift_of(polygon, x, y):
    return [(x * a + y * b + polygon * c) & 0xffff for a, b, c in ((56143, 48097, 40503), (41203, 35297, 49471))]


def view(S, light, position, normal, shift):
    """`normal` None: no cosine."""
    f, (source, u, v) = S.formats, light
    seen = View(f)
    if source.kind == "directional":
        seen.direction, seen.distance = source.axis, f.reach.most
    else:
        place = source.position
        if source.is_area():
            place = sample_place(S, source, u + shift[0] & 0xffff, v + shift[1] & 0xffff, position)
        way = way_to(place, position, f)
        if all(c.raw == 0 for c in way):            # on the surface
            return seen
        seen.direction, seen.distance = normalise(way, S)
    if source.kind == "spot" or source.is_flat():
        along = dot(f.unit, source.axis, seen.direction)
        seen.emission = along
        if source.kind == "spot":
            seen.emission = S.operators.power(along, source.falloff) if along > source.cut_off else ZERO
    seen.cosine = normal and dot(f.unit, normal, seen.direction)
    return seen


def sample_place(S, source, u, v, position):
    if source.kind == "sphere":
        axes = disc_axes(S, way_to(source.position, position, S.formats))
        if axes is None:
            return source.position
        a, b = on_disc(S, u, v)
        unit = S.formats.unit
        return on_grid(S, source, [source.radius * unit.hold(a * t + b * s) for t, s in zip(*axes)])
    if source.kind == "triangle" and u + v > 0xffff:
        u, v = 0xffff - u, 0xffff - v               # the other half of the parallelogram
    return on_grid(S, source, [Value(u, 16) * a + Value(v, 16) * b for a, b in zip(source.edge_u, source.edge_v)])


def on_grid(S, source, away):
    """Rounded to the source's mantissas."""
    form = Format(1, S.formats.W + 11)
    e = source.exponent
    held = [form.hold(Value((c + d).raw, (c + d).frac + e)) for c, d in zip(source.position, away)]
    return [Value(m.raw, m.frac - e) for m in held]


def disc_axes(S, way):
    """Two unit vectors across a way and each other; None if there is no way."""
    if all(c.raw == 0 for c in way):
        return None
    f = S.formats
    l, _ = normalise(way, S)
    least = min(range(3), key=lambda i: abs(l[i].raw))
    p, q = (least + 1) % 3, (least + 2) % 3
    across = [f.nothing] * 3
    across[p], across[q] = l[q], -l[p]
    first, _ = normalise(across, S)
    second = []
    for j, k in ((1, 2), (2, 0), (0, 1)):
        second.append(f.unit.hold(l[j] * first[k] - l[k] * first[j]))
    return first, second


def on_disc(S, u, v):
    unit = S.formats.unit
    radius = square_root(unit.hold(Value(u, 16)), S)
    t = unit.hold(Value(v & 0x3fff, 14))
    sine, cosine = quarter_sine(S, t), quarter_sine(S, S.formats.one - t)
    x, y = [(cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine)][v >> 14]
    return unit.hold(radius * x), unit.hold(radius * y)


def quarter_sine(S, t):
    """sin(t · 90 degrees), 1.1e-4 off at most."""
    unit = S.formats.unit
    first, third, fifth = (unit.hold(exact(c)) for c in (1.5706268, -0.6432292, 0.0727102))
    squared = unit.hold(t * t)
    return unit.hold(t * unit.hold(first + squared * unit.hold(third + squared * fifth)))


def views_cycles(S, count, source, way):
    """Of so many lights of a source; `way`: the cost of a direction."""
    if count == 0:
        return 0
    root = S.cost("root")
    if source.kind == "directional":
        each = S.cost("source_facing")
    elif source.kind == "sphere":
        each = S.cost("disc_place") + S.cost(way) + 2 * root
    else:
        each = S.cost(way) + root
    if source.is_flat():
        each += S.cost("sample_place") + S.cost("source_emission")
    if source.kind == "spot":
        each += S.cost("source_emission") + S.cost("power")
    return count * each + (S.cost("disc_axes") + 2 * root if source.kind == "sphere" else 0)


def set_up_cycles(S):
    shift = S.cost("sample_shift") if any(source.is_area() for source in S.sources) else 0
    return shift + sum(views_cycles(S, lights_of(S, source), source, "source_view") for source in S.sources)


def lights_of(S, source, which=None):
    """How many lights, of those in `which`, a source has."""
    return sum(light[0] is source for k, light in enumerate(S.lights) if which is None or k in which)


def lit_cycles(S, lit, waited):
    """`waited`: the hit was in a slot, which keeps no directions of lights."""
    cycles, samples = 0, False
    for source in S.sources:
        count = lights_of(S, source, lit)
        if count == 0:
            continue
        shares = source.kind == "spot" or source.is_flat()
        cycles += S.cost("per_lit_source") + count * (S.cost("power") + (S.cost("emitted") if shares else 0))
        if source.is_area():
            cycles += S.cost("sample_mean") + count * S.cost("per_lit_sample")
            samples = True
        if waited and S.cost("light_again") > 0:
            cycles += views_cycles(S, count, source, "light_again")
    return cycles + (S.cost("sample_shift") if samples and waited and S.cost("light_again") > 0 else 0)
