// Fixed-point words against SystemC's own fixed-point types, bit for bit.
#define SC_INCLUDE_FX
#include <gtest/gtest.h>

#include <cmath>
#include <systemc>

#include "../property.hpp"
#include "model/numbers/arithmetic.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {
namespace {

using property::Random;
using sc_dt::sc_fix;
using sc_dt::sc_fxval;

std::vector<int> word_lengths() {
    std::vector<int> lengths;
    for (int bits = 8; bits <= 32; ++bits) lengths.push_back(bits);
    lengths.push_back(48);
    return lengths;
}

const std::vector<Rounding> roundings = {Rounding::nearest, Rounding::truncate};

/// `value` as SystemC holds it in a word of this format.
template <class Value>
sc_fix word_of(const Format& format, const Value& value) {
    const auto mode = format.rounding() == Rounding::nearest ? sc_dt::SC_RND_CONV : sc_dt::SC_TRN;
    sc_fix word(format.bits(), format.integer_bits(), mode, sc_dt::SC_SAT);
    word = value;
    return word;
}

std::string label(const Format& format) {
    return "Q" + std::to_string(format.integer_bits()) + "." + std::to_string(format.fraction_bits()) +
           (format.rounding() == Rounding::nearest ? ", nearest" : ", truncate");
}

/// A word as an integer count of last bits. One in four is an end of the range, 0, or next to one of these.
std::int64_t raw_word(Random& random, int bits) {
    const std::int64_t end = std::int64_t(1) << (bits - 1);
    if (!random.chance(0.25))
        return std::uniform_int_distribution<std::int64_t>(-end, end - 1)(random.engine());
    switch (random.whole(0, 5)) {
        case 0:
            return -end;
        case 1:
            return -end + 1;
        case 2:
            return end - 1;
        case 3:
            return 0;
        case 4:
            return 1;
        default:
            return -1;
    }
}

double value_of(const Format& format, std::int64_t raw) { return double(raw) * format.step(); }

/// A format of `bits` bits, with -5 to bits + 5 integer bits.
Format random_format(Random& random, int bits, Rounding rounding) {
    const int integer_bits = random.whole(-5, bits + 5);
    return Format(integer_bits, bits - integer_bits, rounding);
}

/// A format of 4 to 48 bits that keeps 1 to 30 fraction bits fewer than the result has; often too short.
Format result_format(Random& random, int fraction_bits, Rounding rounding) {
    const int bits = random.whole(4, 48);
    const int kept = fraction_bits - random.whole(1, 30);
    return Format(bits - kept, kept, rounding);
}

/// Calls `check` with a seeded random source, for all word lengths and roundings.
template <class Check>
void for_formats(std::uint64_t first_seed, Check check) {
    for (const std::uint64_t seed : property::seeds(first_seed, 6)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        for (const int bits : word_lengths()) {
            for (const Rounding rounding : roundings) {
                check(random, bits, rounding);
                if (::testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

TEST(FixedWords, HoldAnyValueAsSystemCConvertsIt) {
    for_formats(1, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 8; ++i) {
            const Format format = random_format(random, bits, rounding);
            SCOPED_TRACE(label(format));
            for (int j = 0; j < 30; ++j) {
                const double word = value_of(format, raw_word(random, bits));
                // On a word, at ties, next to them, and beyond the ends.
                for (const double rest : {0.0, 0.5, -0.5, 1.0, -1.0, 1.5, random.uniform(-1, 1)}) {
                    const double value = word + rest * format.step();
                    for (const double x :
                         {value, std::nextafter(value, -1e300), std::nextafter(value, 1e300)}) {
                        ASSERT_EQ(format.hold(x), word_of(format, x).to_double()) << x;
                    }
                }
            }
        }
    });
}

TEST(FixedWords, SaturateAsSystemCDoesHoweverFarBeyondTheEnd) {
    for_formats(100, [](Random& random, int bits, Rounding rounding) {
        const Format format = random_format(random, bits, rounding);
        SCOPED_TRACE(label(format));
        const double end = -format.least();
        EXPECT_EQ(format.most(), word_of(format, 2 * end).to_double());
        EXPECT_EQ(format.least(), word_of(format, -2 * end).to_double());
        for (const double x : {end, end - format.step() / 2, end - format.step() / 4, end + format.step(),
                               1.5 * end, std::ldexp(end, 10), std::ldexp(end, 60), 0.0}) {
            ASSERT_EQ(format.hold(x), word_of(format, x).to_double()) << x;
            ASSERT_EQ(format.hold(-x), word_of(format, -x).to_double()) << -x;
        }
        ASSERT_EQ(format.hold(1e300), format.most());
        ASSERT_EQ(format.hold(-1e300), format.least());
    });
}

TEST(FixedWords, ConvertBetweenFormatsAsSystemCDoes) {
    for_formats(200, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 60; ++i) {
            const Format from = random_format(random, bits, rounding);
            const Format to = result_format(random, from.fraction_bits() + random.whole(0, 20), rounding);
            SCOPED_TRACE(label(from) + " to " + label(to));
            const std::int64_t raw = raw_word(random, bits);
            const double x = value_of(from, raw);
            const double expected = word_of(to, word_of(from, x)).to_double();
            ASSERT_EQ(to.hold(x), expected) << x;
            const int scale = to.fraction_bits() + random.whole(1, 20);
            if (scale < from.fraction_bits() || scale - from.fraction_bits() > 70) continue;
            ASSERT_EQ(to.hold_wide(__int128(raw) << (scale - from.fraction_bits()), scale), expected) << x;
        }
    });
}

TEST(FixedWords, AddAndSubtractAsSystemCDoes) {
    for_formats(300, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 40; ++i) {
            const Format a_format = random_format(random, bits, rounding);
            // So close that a double holds the sum.
            const int apart = random.whole(-4, 4);
            const Format b_format(a_format.integer_bits() + apart, a_format.fraction_bits() - apart,
                                  rounding);
            const Format to =
                random.chance(0.5)
                    ? a_format
                    : result_format(random, std::max(a_format.fraction_bits(), b_format.fraction_bits()),
                                    rounding);
            SCOPED_TRACE(label(a_format) + " and " + label(b_format) + " to " + label(to));
            const double a = value_of(a_format, raw_word(random, bits));
            const double b = value_of(b_format, raw_word(random, bits));
            const sc_fix sa = word_of(a_format, a);
            const sc_fix sb = word_of(b_format, b);
            ASSERT_EQ(to.hold(a + b), word_of(to, sa + sb).to_double()) << a << " + " << b;
            ASSERT_EQ(to.hold(a - b), word_of(to, sa - sb).to_double()) << a << " - " << b;
        }
    });
}

TEST(FixedWords, MultiplyAsSystemCDoes) {
    for_formats(400, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 60; ++i) {
            const Format a_format = random_format(random, bits, rounding);
            const Format b_format = random_format(random, bits, rounding);
            const int scale = a_format.fraction_bits() + b_format.fraction_bits();
            const Format to = result_format(random, scale, rounding);
            SCOPED_TRACE(label(a_format) + " times " + label(b_format) + " to " + label(to));
            const std::int64_t a = raw_word(random, bits);
            const std::int64_t b = raw_word(random, bits);
            const double expected = word_of(to, word_of(a_format, value_of(a_format, a)) *
                                                    word_of(b_format, value_of(b_format, b)))
                                        .to_double();
            ASSERT_EQ(to.hold_wide(__int128(a) * b, scale), expected) << a << " * " << b;
            if (bits > 26) continue;  // no double holds the product
            ASSERT_EQ(to.hold(value_of(a_format, a) * value_of(b_format, b)), expected) << a << " * " << b;
        }
    });
}

TEST(FixedWords, ShiftAsSystemCDoes) {
    for_formats(500, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 30; ++i) {
            const Format format = random_format(random, bits, rounding);
            SCOPED_TRACE(label(format));
            const double a = value_of(format, raw_word(random, bits));
            const sc_fix word = word_of(format, a);
            const int by = random.whole(0, bits + 2);
            ASSERT_EQ(format.hold(scale_by(a, by)), word_of(format, word << by).to_double())
                << a << " << " << by;
            ASSERT_EQ(format.hold(scale_by(a, -by)), word_of(format, word >> by).to_double())
                << a << " >> " << by;
        }
    });
}

TEST(FixedWords, SumProductsAsSystemCDoesWithOneRounding) {
    for_formats(600, [](Random& random, int bits, Rounding rounding) {
        for (int i = 0; i < 40; ++i) {
            const Format a_format = random_format(random, bits, rounding);
            const Format b_format = random_format(random, bits, rounding);
            const int scale = a_format.fraction_bits() + b_format.fraction_bits();
            const int c_fraction_bits = scale - random.whole(0, 24);
            const Format c_format(48 - c_fraction_bits, c_fraction_bits, rounding);
            const Format to = result_format(random, scale, rounding);
            SCOPED_TRACE(label(a_format) + " times " + label(b_format) + " to " + label(to));
            const std::int64_t c = raw_word(random, c_format.bits());
            __int128 sum = __int128(c) << (scale - c_format.fraction_bits());
            sc_fxval expected(value_of(c_format, c));
            for (int term = 0; term < 3; ++term) {
                const std::int64_t a = raw_word(random, bits);
                const std::int64_t b = raw_word(random, bits);
                sum += __int128(a) * b;
                expected = expected + word_of(a_format, value_of(a_format, a)) *
                                          word_of(b_format, value_of(b_format, b));
            }
            ASSERT_EQ(to.hold_wide(sum, scale), word_of(to, expected).to_double());
        }
    });
}

const std::vector<Format Formats::*> all_formats = {
    &Formats::unit,        &Formats::depth,       &Formats::distance, &Formats::reach,
    &Formats::offset,      &Formats::edge_offset, &Formats::normal,   &Formats::field,
    &Formats::accumulator, &Formats::intensity,   &Formats::feature,  &Formats::loading};

const std::vector<Format Formats::*> lengths = {&Formats::unit, &Formats::depth, &Formats::distance};

/// A random one of the formats in `choice`.
const Format& any_of(Random& random, const Formats& formats, const std::vector<Format Formats::*>& choice) {
    return formats.*choice[std::size_t(random.whole(0, int(choice.size()) - 1))];
}

/// The arithmetic of one word length for a random array, from the smallest to the largest size.
Arithmetic arithmetic_of(Random& random, int bits, Rounding rounding) {
    NumberSettings settings;
    settings.word_bits = bits;
    settings.rounding = rounding;
    ArrayExtent extent;
    extent.width = 1 << random.whole(0, 12);
    extent.height = 1 << random.whole(0, 12);
    extent.depth = 1 << random.whole(0, 16);
    extent.level = random.chance(0.5) ? 1 : extent.depth / 1024;
    return Arithmetic(settings, extent);
}

TEST(Arithmetic, SumsProductsAsSystemCDoesWithOneRounding) {
    for_formats(700, [](Random& random, int bits, Rounding rounding) {
        if (bits > 32) return;
        const Arithmetic arithmetic = arithmetic_of(random, bits, rounding);
        const Formats& formats = arithmetic.formats();
        for (int i = 0; i < 200; ++i) {
            const Format& to = any_of(random, formats, all_formats);
            const Format& a_format = any_of(random, formats, lengths);
            const Format& b_format = any_of(random, formats, {&Formats::unit, &Formats::normal});
            const Format& c_format = any_of(random, formats, lengths);
            SCOPED_TRACE(label(a_format) + " times " + label(b_format) + " to " + label(to) + " from " +
                         label(c_format));
            // Next to a tie by a product's last bits: a double with too few bits would lose the difference.
            const bool next_to_tie = random.chance(0.3);
            const auto factor = [&](const Format& format) {
                return value_of(format, next_to_tie ? random.whole(-2, 2) : raw_word(random, format.bits()));
            };
            double c = value_of(c_format, raw_word(random, c_format.bits()));
            if (next_to_tie) c = c_format.hold(to.hold(c) + to.step() / 2);
            double a[3];
            double b[3];
            std::vector<sc_fxval> sums = {sc_fxval(c)};
            for (int term = 0; term < 3; ++term) {
                a[term] = factor(a_format);
                b[term] = factor(b_format);
                sums.emplace_back(sums.back() + word_of(a_format, a[term]) * word_of(b_format, b[term]));
            }
            ASSERT_EQ(arithmetic.mac(to, c, a[0], b[0]), word_of(to, sums[1]).to_double());
            ASSERT_EQ(arithmetic.mac(to, c, a[0], b[0], a[1], b[1]), word_of(to, sums[2]).to_double());
            ASSERT_EQ(arithmetic.mac(to, c, a[0], b[0], a[1], b[1], a[2], b[2]),
                      word_of(to, sums[3]).to_double());
        }
    });
}

TEST(Arithmetic, MultipliesByReciprocalsAsSystemCDoes) {
    for_formats(800, [](Random& random, int bits, Rounding rounding) {
        if (bits > 32) return;
        const Arithmetic arithmetic = arithmetic_of(random, bits, rounding);
        const Formats& formats = arithmetic.formats();
        for (int i = 0; i < 200; ++i) {
            const Format& to = any_of(random, formats, all_formats);
            const Format& a_format = any_of(random, formats, lengths);
            const Format& x_format =
                any_of(random, formats, {&Formats::unit, &Formats::depth, &Formats::accumulator});
            SCOPED_TRACE(label(a_format) + " over " + label(x_format) + " to " + label(to));
            const double a = value_of(a_format, raw_word(random, a_format.bits()));
            const double x = value_of(x_format, raw_word(random, x_format.bits()) >> random.whole(0, bits));
            const double r = arithmetic.reciprocal(x);
            ASSERT_EQ(arithmetic.product(to, a, r), word_of(to, sc_fxval(a) * sc_fxval(r)).to_double())
                << a << " / " << x;
        }
    });
}

}  // namespace
}  // namespace raycell
