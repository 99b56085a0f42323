"""The operators beside the ALU: reciprocal, 1/sqrt and power, and what is made of them."""

from functools import lru_cache
from math import isqrt

from words import Value, ZERO, leading_exponent, shifted, to_mantissas

GUARD = 200         # fraction bits while a table's words are computed


def reciprocal_word(i, n, f):
    """2^f / (1 + i/n) to the nearest."""
    over, under = n << (f + 1), n + i
    return (over // under + 1) >> 1


def rounded_root(m, f, nearest=True):
    """2^f / sqrt(m), m of f - 1 fraction bits."""
    twice = isqrt((1 << (3 * f + 1)) // m)
    return (twice + 1 if nearest else twice) >> 1


def root_word(i, n, f):
    """1/sqrt from 1 to 2."""
    return rounded_root(((n + i) << (f - 1)) // n, f)


def upper_root_word(i, n, f):
    """1/sqrt from 2 to 4."""
    return rounded_root(((n + i) << f) // n, f)


def log2_word(i, n, f):
    """2^f * log2(1 + i/n) to the nearest: a bit of the logarithm for each squaring."""
    if i == n:
        return 1 << f
    x = ((n + i) << GUARD) // n
    word = 0
    for _ in range(f + 30):
        x = x * x >> GUARD
        word <<= 1
        if x >> (GUARD + 1):
            word |= 1
            x >>= 1
    return (word + (1 << 29)) >> 30


def exp2_word(i, n, f):
    """2^f * 2^(i/n) to the nearest: a square root for each bit of i/n."""
    product = 1 << GUARD
    factor = 2 << GUARD
    for bit in range(n.bit_length() - 1, -1, -1):
        if i >> bit & 1:
            product = product * factor >> GUARD
        factor = isqrt(factor << GUARD)
    return (product + (1 << (GUARD - f - 1))) >> (GUARD - f)


class Lines:
    """A table of 2^k lines; the leading bits of the argument choose the line, the rest the place on it."""

    def __init__(self, word, size, argument_bits, f):
        k = min(size.bit_length() - 1, argument_bits)
        self.rest = argument_bits - k
        self.words = [word(i, 1 << k, f) for i in range((1 << k) + 1)]

    def at(self, argument, nearest):
        line, along = argument >> self.rest, argument & ((1 << self.rest) - 1)
        a, b = self.words[line], self.words[line + 1]
        return shifted((a << self.rest) + (b - a) * along, self.rest, nearest)


table = lru_cache(maxsize=None)(Lines)               # many cells have the same


def table_size(name, configured, W):
    if configured:
        return configured
    if name == "reciprocal":
        return 64 << ((W - 25) // 4 if W >= 25 else 0)
    if name == "root":
        return 64 << ((W - 21) // 4 if W >= 21 else 0)
    return 32 << ((W - 19) // 2 if W >= 19 else 0)


class Operators:
    def __init__(self, option):
        W = option["word-bits"]
        f = self.f = W - 1
        self.nearest = option["rounding"] == "nearest"
        self.method = {name: option[name] for name in ("reciprocal", "root", "power")}
        size = {name: table_size(name, option[name + "-table"], W) for name in self.method}
        self.reciprocals = table(reciprocal_word, size["reciprocal"], f, f)
        self.roots = [table(root_word, size["root"] // 2, f - 1, f), table(upper_root_word, size["root"] // 2, f, f)]
        self.logarithms = table(log2_word, size["power"], f, f)
        self.powers = table(exp2_word, size["power"], f, f)

    def cut(self, raw, places):
        return shifted(raw, places, self.nearest)

    def mantissa(self, raw, exponent):
        """raw as a mantissa of f fraction bits from 1 to 2, and its exponent, which may grow by one."""
        m = self.cut(raw, raw.bit_length() - 1 - self.f)
        if m >> (self.f + 1):
            return m >> 1, exponent + 1
        return m, exponent

    def reciprocal_of_mantissa(self, m):
        f = self.f
        if self.method["reciprocal"] == "rounded":
            return ((1 << 2 * f) + (m // 2 if self.nearest else 0)) // m
        r = self.reciprocals.at(m - (1 << f), self.nearest)
        if self.method["reciprocal"] == "newton":
            r = self.cut(r * self.cut((2 << 2 * f) - m * r, f), f)
        return r

    def root_of_mantissa(self, m):
        f = self.f
        if self.method["root"] == "rounded":
            return rounded_root(m, f, self.nearest)
        octave = m >> f
        r = self.roots[octave].at(m - (1 << (f - 1 + octave)), self.nearest)
        if self.method["root"] == "newton":
            root = self.cut(m * r, f - 1)
            r = self.cut(r * self.cut((3 << 2 * f) - root * r, f + 1), f)
        return r

    def reciprocal(self, x):
        if x.raw == 0:
            return Value((2 << self.f) - 1, self.f - 127)
        m, exponent = self.mantissa(abs(x.raw), leading_exponent(x))
        r = self.reciprocal_of_mantissa(m)
        return Value(-r if x.raw < 0 else r, self.f + exponent)

    def inverse_root(self, x):
        f = self.f
        exponent = leading_exponent(x)
        odd = exponent & 1
        half = (exponent - odd) >> 1
        m = self.cut(x.raw, x.raw.bit_length() - f - odd)
        if m >> (f + 1):                            # rounded up to 4, which is 1 with twice the power
            m, half = m >> 2, half + 1
        return Value(self.root_of_mantissa(m), f + half)

    def power(self, base, exponent):
        """base^exponent, a word of the format unit."""
        f = self.f
        schlick = self.method["power"] == "schlick"
        bits = 8 if schlick else max(8, f - 11)
        n = self.cut(exponent.raw, exponent.frac - bits)
        if n == 0 or base >= 1:
            return Value(1 << (f - 1), f - 1)
        if base <= 0:
            return Value(0, f - 1)
        if schlick:
            return Value(self.schlick(self.cut(base.raw, base.frac - f), n), f - 1)
        return Value(self.power_by_tables(*self.mantissa(base.raw, leading_exponent(base)), n, bits), f - 1)

    def power_by_tables(self, m, exponent, n, bits):
        f = self.f
        octaves = (-exponent << f) - self.logarithms.at(m - (1 << f), self.nearest)
        octaves = min(octaves, 32 << f)
        if octaves * n >= 1 << (f + bits + 6):
            return 0
        product = self.cut(octaves * n, bits)
        whole = -(-product >> f)                    # rounded up
        return self.cut(self.powers.at((whole << f) - product, self.nearest), whole + 1)

    def schlick(self, b, n):
        f = self.f
        divisor = n * ((1 << f) - b) + (b << 8)
        m, exponent = self.mantissa(divisor, divisor.bit_length() - 1 - (f + 8))
        return min(self.cut(b * self.reciprocal_of_mantissa(m), f + 1 + exponent), 1 << (f - 1))


def dot(form, a, b):
    return form.hold(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def normalise(v, S):
    """(direction, length) of a vector that is not 0; the length is a word of the format reach."""
    m, exponent = to_mantissas(v, S.formats.mantissa)
    squared = dot(S.formats.field, m, m)
    inverse = S.operators.inverse_root(squared)
    length = squared * inverse
    return [S.formats.unit.hold(x * inverse) for x in m], S.formats.reach.hold(Value(length.raw, length.frac - exponent))


def square_root(x, S):
    unit = S.formats.unit
    if not x > ZERO:
        return unit.word(0)
    return unit.hold(unit.hold(x) * S.operators.inverse_root(x))
