// Fixed-point words: formats, sums of products and the operations built on them, checked against integers.
#include "model/numbers/arithmetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "testbench/tests/property.hpp"

namespace raycell {
namespace {

using property::Random;
using Integer = __int128;

const ArrayExtent usual{128, 128, 256, 0.25};

NumberSettings words(int bits, Rounding rounding = Rounding::nearest) {
    NumberSettings settings;
    settings.word_bits = bits;
    settings.rounding = rounding;
    return settings;
}

/// A random word of a format. Small words, the two ends and powers of two are drawn more often than by
/// chance.
double random_word(const Format& f, Random& random) {
    const double steps = std::ldexp(1.0, f.bits() - 1);
    const int kind = random.whole(0, 5);
    if (kind == 0) return random.chance(0.5) ? f.least() : f.most();
    if (kind == 1) return random.whole(-3, 3) * f.step();
    if (kind == 2)
        return f.hold(std::ldexp(random.chance(0.5) ? 1.0 : -1.0, random.whole(0, f.bits())) * f.step());
    return f.hold(std::floor(random.uniform(-steps, steps)) * f.step());
}

/// value / 2^scale with the format's rounding and saturation, computed in integers alone.
double by_integers(const Format& f, Integer value, int scale) {
    const int drop = scale - f.fraction_bits();
    Integer word = 0;
    if (drop <= 0) {
        word = value * (Integer(1) << -drop);
    } else {
        const Integer one = Integer(1) << drop;
        word = value / one;
        Integer rest = value % one;
        if (rest < 0) rest += one, --word;
        if (f.rounding() == Rounding::nearest) {
            if (2 * rest > one || (2 * rest == one && (word & 1) != 0)) ++word;
        }
    }
    const Integer limit = Integer(1) << (f.bits() - 1);
    if (word < -limit) word = -limit;
    if (word > limit - 1) word = limit - 1;
    return std::ldexp(double(std::int64_t(word)), -f.fraction_bits());
}

Integer raw(double word, const Format& f) {
    const double steps = std::ldexp(word, f.fraction_bits());
    EXPECT_EQ(steps, std::floor(steps)) << word << " is no word";
    return Integer(std::int64_t(steps));
}

TEST(Format, RoundsToTheNearestTiesToEvenOrCutsOff) {
    for (const std::uint64_t seed : property::seeds(1, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int bits = random.whole(2, 48);
        const int fraction = random.whole(-8, 40);
        const Format nearest(bits - fraction, fraction, Rounding::nearest);
        const Format cut(bits - fraction, fraction, Rounding::truncate);
        for (int i = 0; i < 100; ++i) {
            // Values are quarters of the last bit, so that a quarter of them are ties; a few lie beyond the
            // ends.
            const double range = std::ldexp(1.1, std::min(bits - 1, 46));
            const double steps = std::floor(random.uniform(-range, range)) + 0.25 * random.whole(0, 3);
            const double value = std::ldexp(steps, -fraction);
            const Integer quarters = Integer(std::int64_t(std::floor(4 * steps)));
            EXPECT_EQ(nearest.hold(value), by_integers(nearest, quarters, fraction + 2)) << steps;
            EXPECT_EQ(cut.hold(value), by_integers(cut, quarters, fraction + 2)) << steps;
        }
    }
}

TEST(Format, SaturatesAtBothEndsAndKeepsItsWords) {
    for (int bits = 2; bits <= 48; ++bits) {
        for (const Rounding rounding : {Rounding::nearest, Rounding::truncate}) {
            const Format f(3, bits - 3, rounding);
            EXPECT_EQ(f.least(), -4);
            EXPECT_EQ(f.most(), 4 - f.step());
            for (const double beyond : {4.0, 4.1, 1e6, 1e300}) {
                EXPECT_EQ(f.hold(beyond), f.most());
                EXPECT_EQ(f.hold(-beyond), f.least());
            }
            EXPECT_EQ(f.hold(f.most()), f.most());
            EXPECT_EQ(f.hold(f.least()), f.least());
            EXPECT_EQ(f.hold(f.step()), f.bits() == 2 ? f.most() : f.step());
            EXPECT_EQ(f.hold(0), 0);
        }
    }
}

TEST(Format, HasFrom2To48Bits) {
    EXPECT_THROW(Format(1, 0), std::invalid_argument);
    EXPECT_THROW(Format(24, 25), std::invalid_argument);
    EXPECT_NO_THROW(Format(24, 24));
    EXPECT_NO_THROW(Format(30, -20));
    for (const int bits : {7, 33, -1, 0, 1000}) {
        EXPECT_THROW(Formats(bits, Rounding::nearest, usual), std::invalid_argument) << bits;
        EXPECT_THROW(Arithmetic(words(bits), usual), std::invalid_argument) << bits;
    }
}

/// Sums of products at every width: narrow sums run in doubles, wide ones in 128-bit integers. Both must
/// equal the integer result, also at the width where the method changes.
TEST(Arithmetic, SumsOfProductsAreExactUntilTheirOneRounding) {
    for (const std::uint64_t seed : property::seeds(1000, 50)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        for (int bits = 8; bits <= 32; ++bits) {
            const Rounding rounding = random.chance(0.5) ? Rounding::nearest : Rounding::truncate;
            const Arithmetic arithmetic(words(bits, rounding), usual);
            const Formats& f = arithmetic.formats();
            const Format* const results[] = {&f.unit, &f.depth, &f.field, &f.intensity, &f.offset};
            for (int i = 0; i < 40; ++i) {
                const Format& to = *results[random.whole(0, 4)];
                double a[3];
                double b[3];
                const int scale = 2 * f.unit.fraction_bits();
                Integer sum = 0;
                const double c = random_word(f.depth, random);
                sum += raw(c, f.depth) * (Integer(1) << (scale - f.depth.fraction_bits()));
                for (int k = 0; k < 3; ++k) {
                    a[k] = random_word(k == 2 ? f.depth : f.unit, random);
                    b[k] = random_word(f.unit, random);
                    sum += raw(a[k], k == 2 ? f.depth : f.unit) * raw(b[k], f.unit);
                }
                ASSERT_EQ(arithmetic.mac(to, c, a[0], b[0], a[1], b[1], a[2], b[2]),
                          by_integers(to, sum, scale))
                    << bits << " bits";
                const Integer one = raw(a[2], f.depth) * raw(b[2], f.unit);
                ASSERT_EQ(arithmetic.product(to, a[2], b[2]), by_integers(to, one, scale)) << bits << " bits";
            }
        }
    }
}

TEST(Arithmetic, NarrowAndWideSumsAgreeWhereBothApply) {
    // The same 20-bit words: narrow sums in a usual cube, wide ones in a cube too deep for doubles.
    const ArrayExtent deep{128, 128, 1e6, 1e3};
    for (const std::uint64_t seed : property::seeds(1500, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Arithmetic narrow(words(20), usual);
        const Arithmetic wide(words(20), deep);
        const Formats& f = narrow.formats();
        ASSERT_EQ(f.unit.fraction_bits(), wide.formats().unit.fraction_bits());
        for (int i = 0; i < 200; ++i) {
            double v[7];
            for (double& x : v) x = random_word(f.unit, random);
            for (const Format* to : {&f.unit, &f.depth, &f.field, &f.accumulator}) {
                ASSERT_EQ(narrow.mac(*to, v[0], v[1], v[2], v[3], v[4], v[5], v[6]),
                          wide.mac(*to, v[0], v[1], v[2], v[3], v[4], v[5], v[6]));
            }
            // A reciprocal's mantissa has an exponent of its own.
            const double r = narrow.reciprocal(v[1] == 0 ? 1 : v[1]);
            ASSERT_EQ(narrow.product(f.distance, v[0], r), wide.product(f.distance, v[0], r));
        }
    }
}

TEST(Arithmetic, NormalisedVectorsOfAnyMagnitudeAreUnitButForTheirLastBits) {
    for (const std::uint64_t seed : property::seeds(2000, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        for (int bits = 8; bits <= 32; ++bits) {
            NumberSettings settings = words(bits);
            settings.operators.root = random.chance(0.5) ? Iteration::newton : Iteration::rounded;
            const Arithmetic arithmetic(settings, usual);
            // One Newton step from table lines that are off by 2^-12: its error, 3/2 of that squared, limits
            // long words.
            const double step_limit = settings.operators.root == Iteration::newton ? 1.5 * 0x1p-24 : 0;
            const double last_bit = arithmetic.formats().unit.step() + step_limit;
            for (int i = 0; i < 20; ++i) {
                const dvec3 shape{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
                const dvec3 v = std::ldexp(1.0, random.whole(-100, 100)) * shape;
                double length = 0;
                const dvec3 n = arithmetic.normalise(v, length);
                EXPECT_NEAR(glm::length(n), 1, 3 * last_bit) << bits << " bits";
                EXPECT_LT(glm::length(n - glm::normalize(v)), 4 * last_bit) << bits << " bits";
                const Format& reach = arithmetic.formats().reach;
                const double true_length = std::min(glm::length(v), reach.most());
                EXPECT_NEAR(length, true_length, reach.step() / 2 + 3 * last_bit * true_length)
                    << bits << " bits";
                EXPECT_EQ(length, reach.hold(length)) << "a word";
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_EQ(n[axis], arithmetic.formats().unit.hold(n[axis])) << "a word";
                }
            }
        }
    }
}

TEST(Arithmetic, SquareRootsAreRightToTheirLastBits) {
    for (int bits = 8; bits <= 32; ++bits) {
        NumberSettings settings = words(bits);
        settings.operators.root = Iteration::rounded;
        const Arithmetic arithmetic(settings, usual);
        const double last_bit = arithmetic.formats().unit.step();
        EXPECT_EQ(arithmetic.square_root(0), 0);
        EXPECT_EQ(arithmetic.square_root(-1), 0);
        EXPECT_EQ(arithmetic.square_root(1), 1);
        for (int i = 1; i <= 200; ++i) {
            const double x = arithmetic.formats().unit.hold(i / 128.0);
            EXPECT_NEAR(arithmetic.square_root(x), std::sqrt(x), 3 * last_bit)
                << x << ", " << bits << " bits";
        }
    }
}

TEST(Arithmetic, PlacesKeepTheirShapeHoweverFarAway) {
    for (const std::uint64_t seed : property::seeds(2500, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int bits = random.whole(8, 32);
        const Arithmetic arithmetic(words(bits), usual);
        const double size = std::ldexp(1.0, random.whole(-20, 40));
        const dvec3 place = size * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const dvec3 held = arithmetic.hold_place(place);
        const double largest =
            std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z), usual.depth});
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(std::abs(held[axis] - place[axis]), std::ldexp(largest, -bits - 11)) << bits << " bits";
        }
        EXPECT_EQ(arithmetic.hold_place(held), held) << "held once and for all";
    }
    EXPECT_EQ(Arithmetic(words(20), usual).hold_place(dvec3(0)), dvec3(0));
}

TEST(Arithmetic, DistancesBeyondTheCubeAreInfinite) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (int bits = 8; bits <= 32; ++bits) {
        const Arithmetic arithmetic(words(bits), usual);
        const double diagonal = std::sqrt(2 * 128.0 * 128 + 256.0 * 256);
        const double last_bit = arithmetic.formats().reach.step();
        for (const double inside : {0.0, 1.0, 100.0, diagonal - 1}) {
            EXPECT_NEAR(arithmetic.hold_reach(inside), inside, last_bit) << bits << " bits";
        }
        for (const double beyond : {2048.0, 1e9, infinity}) {
            EXPECT_EQ(arithmetic.hold_reach(beyond), infinity) << bits << " bits";
        }
        EXPECT_EQ(arithmetic.hold_reach(infinity - 5), infinity) << "and stays so from hop to hop";
    }
    EXPECT_EQ(exact_arithmetic().hold_reach(1e9), 1e9);
}

TEST(Arithmetic, ShineKeepsEightBinaryDigitsFromA256thToHalfAMillion) {
    const Arithmetic arithmetic(words(20), usual);
    EXPECT_EQ(arithmetic.hold_shine(0), 0);
    EXPECT_EQ(arithmetic.hold_shine(1e-9), 0);
    for (double shine = 1.0 / 256; shine < 5e5; shine *= 1.13) {
        const double held = arithmetic.hold_shine(shine);
        EXPECT_LE(std::abs(held - shine), shine / 256) << shine;
        EXPECT_EQ(arithmetic.hold_shine(held), held) << shine;
    }
    EXPECT_EQ(arithmetic.hold_shine(1e30), arithmetic.hold_shine(1e20));
    EXPECT_GE(arithmetic.hold_shine(1e30), 5e5);
    for (const double whole : {1.0, 2.0, 8.0, 30.0, 50.0, 100.0, 255.0}) {
        EXPECT_EQ(arithmetic.hold_shine(whole), whole) << "whole powers to 255 are exact";
    }
}

TEST(Arithmetic, ExactArithmeticChangesNothing) {
    Random random(1);
    const Arithmetic& exact = exact_arithmetic();
    for (int i = 0; i < 1000; ++i) {
        const double x = random.uniform(-1e6, 1e6);
        EXPECT_EQ(exact.hold(exact.formats().unit, x), x);
        EXPECT_EQ(exact.mac(exact.formats().unit, 1, x, 3), 1 + x * 3);
        EXPECT_EQ(exact.reciprocal(x), 1 / x);
        EXPECT_EQ(exact.hold_shine(x), x);
        EXPECT_EQ(exact.hold_place(dvec3(x)), dvec3(x));
    }
}

std::vector<const Format*> formats_of(const Formats& f) {
    return {&f.unit,  &f.depth,       &f.distance,  &f.reach,   &f.offset, &f.edge_offset, &f.normal,
            &f.field, &f.accumulator, &f.intensity, &f.feature, &f.ior,    &f.loading};
}

TEST(Formats, AreNamedAsInTheTable) {
    const Formats formats(20, Rounding::nearest, usual);
    const auto names = formats.names();
    EXPECT_EQ(names.size(), formats_of(formats).size());
    const auto has = [&](const std::string& name, const std::string& format) {
        return std::find(names.begin(), names.end(), std::make_pair(name, format)) != names.end();
    };
    EXPECT_TRUE(has("unit", "Q2.18"));
    EXPECT_TRUE(has("depth", "Q12.18"));
    EXPECT_TRUE(has("loading", "Q11.25"));
    EXPECT_TRUE(has("feature", "UQ2.10"));
}

TEST(Formats, OfEveryArrayAndWordExistAndHoldWhatTheyAreFor) {
    for (const int bits : {8, 9, 12, 20, 24, 31, 32}) {
        for (const int size : {1, 2, 128, 4096}) {
            for (const double depth : {1e-6, 0.5, 1.0, 256.0, 1e5, 1e9}) {
                for (const int levels : {1, 1024, 65536}) {
                    const ArrayExtent extent{size, size == 2 ? 1 : size, depth, depth / levels};
                    SCOPED_TRACE(std::to_string(bits) + " bits, " + std::to_string(size) + " cells, depth " +
                                 std::to_string(depth) + ", " + std::to_string(levels) + " levels");
                    const Formats f(bits, Rounding::nearest, extent);
                    for (const Format* format : formats_of(f)) {
                        EXPECT_GE(format->bits(), 2);
                        EXPECT_LE(format->bits(), 48);
                        EXPECT_GT(format->step(), 0);
                        EXPECT_TRUE(std::isfinite(format->most()));
                        EXPECT_EQ(format->hold(format->most()), format->most());
                    }
                    const double diagonal = std::sqrt(2.0 * size * size + depth * depth);
                    EXPECT_GE(f.depth.most(), depth);
                    EXPECT_GE(f.distance.most(), diagonal);
                    EXPECT_GE(f.reach.most() + f.reach.step(), diagonal);
                    EXPECT_GE(f.loading.most(), std::max(double(size), depth));
                    EXPECT_GE(f.offset.most(), 1 + extent.level);
                    EXPECT_GE(f.unit.most(), 1);
                    EXPECT_EQ(f.unit.bits(), bits);
                    EXPECT_GE(f.depth_word_bits(), bits);
                    const Arithmetic arithmetic(words(bits), extent);
                    EXPECT_GT(arithmetic.hair(), 0);
                    EXPECT_GT(arithmetic.least_fresh_distance(), arithmetic.default_normal_offset());
                    EXPECT_TRUE(
                        std::isfinite(arithmetic.mac(f.depth, f.depth.most(), f.distance.most(),
                                                     f.unit.most(), f.depth.least(), f.unit.least())));
                }
            }
        }
    }
}

}  // namespace
}  // namespace raycell
