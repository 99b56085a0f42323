"""Words: exact values, formats, floating values and places.

A Value is raw / 2^frac, two integers. Sums, products and comparisons of Values are exact. Format.hold() is the only
rounding: in hardware, one shift at the end of an accumulator."""

from fractions import Fraction


class Value:
    __slots__ = ("raw", "frac")

    def __init__(self, raw, frac=0):
        self.raw, self.frac = raw, frac

    def at(self, frac):
        """Its integer with `frac` fraction bits, which must be enough for it."""
        return self.raw << (frac - self.frac)

    def pair(self, other):
        """Both integers at the larger number of fraction bits, and that number."""
        other = value(other)
        if self.frac == other.frac:
            return self.raw, other.raw, self.frac
        frac = max(self.frac, other.frac)
        return self.at(frac), other.at(frac), frac

    def __add__(self, other):
        a, b, frac = self.pair(other)
        return Value(a + b, frac)

    def __sub__(self, other):
        a, b, frac = self.pair(other)
        return Value(a - b, frac)

    def __rsub__(self, other):
        a, b, frac = self.pair(other)
        return Value(b - a, frac)

    def __mul__(self, other):
        other = value(other)
        return Value(self.raw * other.raw, self.frac + other.frac)

    def __neg__(self):
        return Value(-self.raw, self.frac)

    def __abs__(self):
        return Value(abs(self.raw), self.frac)

    def __lt__(self, other):
        a, b, _ = self.pair(other)
        return a < b

    def __le__(self, other):
        a, b, _ = self.pair(other)
        return a <= b

    def __gt__(self, other):
        a, b, _ = self.pair(other)
        return a > b

    def __ge__(self, other):
        a, b, _ = self.pair(other)
        return a >= b

    def __eq__(self, other):
        a, b, _ = self.pair(other)
        return a == b

    __radd__ = __add__
    __rmul__ = __mul__
    __hash__ = None

    def __repr__(self):
        return f"{self.raw}/2^{self.frac}"


ZERO = Value(0)


def value(x):
    return x if x.__class__ is Value else Value(x)


def exact(number):
    """A double or a Fraction with a power of two below it, as a Value."""
    over, under = Fraction(number).as_integer_ratio()
    return Value(over, under.bit_length() - 1)


def shifted(raw, places, nearest):
    """raw / 2^places as an integer: to the nearest, ties to even, or towards minus infinity."""
    if places <= 0:
        return raw << -places
    word = raw >> places
    if nearest:
        above = raw - (word << places)
        half = 1 << (places - 1)
        if above > half or (above == half and word & 1):
            word += 1
    return word


class Format:
    """Q i.f in two's complement, the sign among the i."""

    def __init__(self, i, f, nearest=True):
        self.i, self.f, self.nearest, self.bits = i, f, nearest, i + f
        self.high = (1 << (i + f - 1)) - 1
        self.low = -self.high - 1
        self.most, self.least = Value(self.high, f), Value(self.low, f)

    def word(self, raw):
        return Value(raw, self.f)

    def hold(self, x):
        """Rounds, then saturates."""
        x = value(x)
        raw = shifted(x.raw, x.frac - self.f, self.nearest)
        return Value(min(max(raw, self.low), self.high), self.f)


def clamp(x, low, high):
    return low if x < low else high if x > high else x


def bits_to(limit):
    """The least b >= 0 with 2^b >= limit."""
    b = 0
    while 1 << b < limit:
        b += 1
    return b


class Formats:
    """All formats of a machine. `depth`: of its cube, a Fraction."""

    def __init__(self, width_of_word, nearest, columns, rows, depth, levels):
        W = self.W = width_of_word
        F = self.F = W - 2
        depth_bits = bits_to(depth)
        diagonal = bits_to_root(columns ** 2 + rows ** 2 + depth ** 2)
        offset_bits = 1 + bits_to(4 + Fraction(depth) / levels)
        scene_bits = 3 + bits_to(max(columns, rows, depth))
        longer = max(W - 20, 0)
        self.unit = Format(2, F, nearest)
        self.depth = self.edge_offset = Format(depth_bits + 4, min(F, 44 - depth_bits), nearest)
        self.distance = Format(diagonal + 2, min(F, 46 - diagonal), nearest)
        self.reach = Format(diagonal + 1, W - diagonal - 1, nearest)
        self.offset = Format(offset_bits, W - offset_bits, nearest)
        self.normal = Format(4, W - 4, nearest)
        self.field = Format(6, F + 2, nearest)
        self.accumulator = Format(4, min(2 * F, 40))
        self.intensity = Format(4, W - 4, nearest)
        self.mantissa = Format(1, W - 1, nearest)
        self.feature = Format(3, min(W, 12) + longer - 2)
        self.ior = Format(3, min(W, 16) + longer - 2)
        self.array_exponent = scene_bits - 3        # coordinates of the array are below 2 to this power
        self.loading = Format(scene_bits, W + 16 - scene_bits)
        self.share = Format(4, W + 11, nearest)     # a point, as a share of a place's power of two
        self.shine_bits = 12 + longer
        self.one = self.unit.word(1 << F)
        self.nothing = self.unit.word(0)
        self.hair = self.tie = Value(4, F)          # tolerances, in last bits of a word
        self.least_fresh = Value(64, F)
        self.normal_offset = Value(8, F)


def bits_to_root(square):
    b = 0
    while 1 << 2 * b < square:
        b += 1
    return b


def read_floating(text, bits):
    """`mantissa:exponent` of a record: mantissa * 2^(exponent - bits + 1)."""
    mantissa, exponent = text.split(":")
    return Value(int(mantissa), bits - 1 - int(exponent))


def leading_exponent(x):
    """e with 2^e <= |x| < 2^(e + 1)."""
    return abs(x.raw).bit_length() - 1 - x.frac


def to_mantissas(v, form):
    """A vector as mantissas below 1 of a common exponent: (words of `form`, exponent)."""
    exponent = 1 + max(leading_exponent(x) for x in v if x.raw != 0)
    return [form.hold(Value(x.raw, x.frac + exponent)) for x in v], exponent


def place_exponent(place, f):
    """e: a place's coordinates are below 2^e, and so are those of the array."""
    return max([f.array_exponent] + [1 + leading_exponent(x) for x in place if x.raw])


def hold_place(place, f):
    """A place far away: three mantissas of W + 12 bits and one exponent."""
    exponent = place_exponent(place, f)
    form = Format(1, f.W + 11)
    return [Value(form.hold(Value(x.raw, x.frac + exponent)).raw, form.f - exponent) for x in place]


def way_to(place, point, f):
    """From a point in the array to a place: the point is rounded to the last bit of the place's mantissas."""
    exponent = place_exponent(place, f)
    rounded = [Value(f.share.hold(Value(x.raw, x.frac + exponent)).raw, f.share.f - exponent) for x in point]
    return [a - b for a, b in zip(place, rounded)]
