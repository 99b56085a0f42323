// The cell's operators against a slow reference in whole numbers, and properties over all arguments.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../property.hpp"
#include "operator_reference.hpp"

namespace raycell {
namespace {

using namespace operator_reference;
using property::Random;

TEST(Operators, EqualTheReferenceForAllMantissasOfShortWords) {
    for (const int word_bits : {8, 9, 11, 14}) {
        for (const Iteration method : iterations) {
            for (const int entries : {4, 64, 4096}) {
                for (const Rounding rounding : roundings) {
                    const OperatorSettings settings = same(method, entries);
                    SCOPED_TRACE(label(settings, word_bits, rounding));
                    const Operators operators(settings, word_bits, rounding);
                    const Reference reference(settings, word_bits, rounding);
                    for_words(1, 2, word_bits - 1, [&](double m) {
                        ASSERT_EQ(operators.reciprocal(m), reference.reciprocal(m)) << m;
                    });
                    for_words(1, 4, word_bits - 2, [&](double m) {
                        ASSERT_EQ(operators.inverse_root(m), reference.inverse_root(m)) << m;
                    });
                }
            }
        }
    }
}

TEST(Operators, EqualTheReferenceForArgumentsOfAnyMagnitudeAndEveryWordLength) {
    for (const std::uint64_t seed : property::seeds(1, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int word_bits = random.whole(8, 32);
        const Rounding rounding = roundings[std::size_t(random.whole(0, 1))];
        OperatorSettings settings;
        settings.reciprocal = iterations[std::size_t(random.whole(0, 2))];
        settings.root = iterations[std::size_t(random.whole(0, 2))];
        settings.reciprocal_table = 1 << random.whole(2, 12);
        settings.root_table = 1 << random.whole(2, 12);
        SCOPED_TRACE(label(settings, word_bits, rounding));
        const Operators operators(settings, word_bits, rounding);
        const Reference reference(settings, word_bits, rounding);
        for (int i = 0; i < 300; ++i) {
            // Usually not a word, so that the rounding of the argument is tested too.
            double x = std::ldexp(random.uniform(1, 2), random.whole(-40, 40));
            if (random.chance(0.1)) x = std::ldexp(2 - std::ldexp(random.uniform(0, 4), -word_bits), 3);
            if (random.chance(0.1)) {  // a tie
                const double word = random.whole(1 << (word_bits - 3), (1 << (word_bits - 2)) - 1);
                x = std::ldexp(word + 0.125 * random.whole(0, 7), random.whole(-9, 9));
            }
            ASSERT_EQ(operators.inverse_root(x), reference.inverse_root(x)) << x;
            if (random.chance(0.5)) x = -x;
            ASSERT_EQ(operators.reciprocal(x), reference.reciprocal(x)) << x;
        }
    }
}

TEST(Operators, PowersEqualTheReferenceForEveryWordLength) {
    for (const std::uint64_t seed : property::seeds(1000, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int word_bits = random.whole(8, 32);
        const Rounding rounding = roundings[std::size_t(random.whole(0, 1))];
        OperatorSettings settings;
        settings.power = power_methods[std::size_t(random.whole(0, 1))];
        settings.reciprocal = iterations[std::size_t(random.whole(0, 2))];
        settings.power_table = 1 << random.whole(2, 12);
        settings.reciprocal_table = 1 << random.whole(2, 12);
        SCOPED_TRACE(label(settings, word_bits, rounding));
        const Operators operators(settings, word_bits, rounding);
        const Reference reference(settings, word_bits, rounding);
        for (int i = 0; i < 300; ++i) {
            double base = random.uniform(0, 1);
            if (random.chance(0.3)) base = 1 - std::ldexp(base, -random.whole(0, word_bits));
            if (random.chance(0.1)) base = std::ldexp(base, -random.whole(0, 40));
            if (random.chance(0.5))
                base = std::ldexp(std::floor(std::ldexp(base, word_bits - 2)), 2 - word_bits);
            double exponent = random.chance(0.5) ? random.uniform(0, 40) : std::exp2(random.uniform(-9, 20));
            if (random.chance(0.5)) exponent = std::floor(exponent);
            ASSERT_EQ(operators.power(base, exponent), reference.power(base, exponent))
                << base << "^" << exponent;
        }
    }
}

TEST(Operators, RoundedRootIsRightWhereDoublePrecisionIsNot) {
    // 32-bit mantissas whose roots lie so near to the end of a digit that 2^32 / std::sqrt(m) is beyond it.
    for (const std::uint64_t m :
         {4294574095u, 4294180924u, 4291094545u, 4280767953u, 1382920971u, 1299971749u}) {
        const double x = std::ldexp(double(m), -30);
        for (const Rounding rounding : roundings) {
            const OperatorSettings settings = same(Iteration::rounded, 64);
            const Reference reference(settings, 32, rounding);
            EXPECT_EQ(Operators(settings, 32, rounding).inverse_root(x), reference.inverse_root(x)) << m;
        }
    }
}

/// Arguments of a power: base = `word` / 2^(word_bits - 1), exponent = `power` / 256.
struct LongDivisor {
    int word_bits;
    Rounding rounding;
    double word;
    double power;
};

TEST(Power, OfSchlickIsRightWhereTheDivisorHasMoreBitsThanADouble) {
    // The divisor n - n*b + b lies beside a tie or just below a word. Computed in doubles, it rounds the
    // other way.
    for (const LongDivisor& a : std::vector<LongDivisor>{{28, Rounding::truncate, 40356247, 127354663},
                                                         {29, Rounding::truncate, 116945501, 63304437},
                                                         {29, Rounding::nearest, 158290339, 126774027},
                                                         {29, Rounding::nearest, 174149831, 132354057},
                                                         {31, Rounding::truncate, 645136615, 25498583},
                                                         {31, Rounding::nearest, 412530651, 15307949},
                                                         {32, Rounding::truncate, 1806735235, 28094507},
                                                         {32, Rounding::nearest, 729008231, 11087273},
                                                         {32, Rounding::nearest, 2048477577, 134217145}}) {
        OperatorSettings settings = same(Iteration::rounded, 64);
        settings.power = PowerMethod::schlick;
        SCOPED_TRACE(label(settings, a.word_bits, a.rounding));
        const double base = std::ldexp(a.word, 1 - a.word_bits);
        const double exponent = std::ldexp(a.power, -8);
        EXPECT_EQ(Operators(settings, a.word_bits, a.rounding).power(base, exponent),
                  Reference(settings, a.word_bits, a.rounding).power(base, exponent));
    }
}

TEST(Operators, AreExactAtPowersOfTwoAndOfFour) {
    for (int word_bits = 8; word_bits <= 32; ++word_bits) {
        for (const Iteration method : iterations) {
            for (const int entries : {4, 64, 4096}) {
                for (const Rounding rounding : roundings) {
                    const Operators operators = of(method, entries, word_bits, rounding);
                    for (int e = -120; e <= 120; ++e) {
                        ASSERT_EQ(operators.reciprocal(std::ldexp(1, e)), std::ldexp(1, -e));
                        ASSERT_EQ(operators.reciprocal(-std::ldexp(1, e)), -std::ldexp(1, -e));
                        ASSERT_EQ(operators.inverse_root(std::ldexp(1, 2 * e)), std::ldexp(1, -e));
                    }
                }
            }
        }
    }
}

TEST(Operators, ArgumentsThatRoundToTheNextPowerCountAsIt) {
    for (const Iteration method : iterations) {
        const Operators nearest = of(method, 64, 20);
        EXPECT_EQ(nearest.reciprocal(2 - 0x1p-21), 0.5);
        EXPECT_EQ(nearest.reciprocal(2 - 0x1p-20), 0.5);  // a tie, to even
        EXPECT_EQ(nearest.inverse_root(4 - 0x1p-20), 0.5);
        EXPECT_EQ(nearest.inverse_root(1 - 0x1p-22), 1);
        EXPECT_EQ(nearest.reciprocal(1 + 0x1p-20), 1);  // a tie, to even
        const Operators truncate = of(method, 64, 20, Rounding::truncate);
        EXPECT_EQ(truncate.reciprocal(2 - 0x1p-50), truncate.reciprocal(2 - 0x1p-19));
        EXPECT_EQ(truncate.inverse_root(4 - 0x1p-50), truncate.inverse_root(4 - 0x1p-18));
        EXPECT_EQ(truncate.reciprocal(1 + 0x1p-20), 1);
    }
    // 2 is not a power of four.
    EXPECT_NEAR(of(Iteration::rounded, 64, 20).inverse_root(2), std::sqrt(0.5), 0x1p-20);
}

TEST(Operators, TablesAreExactAtTheStartsOfTheirLines) {
    for (const int word_bits : {8, 20, 32}) {
        const Operators exact = of(Iteration::rounded, 4, word_bits);
        for (const int entries : {4, 32}) {
            const Operators table = of(Iteration::table, entries, word_bits);
            for (int i = 0; i < entries; ++i) {
                const double m = 1 + double(i) / entries;
                EXPECT_EQ(table.reciprocal(m), exact.reciprocal(m)) << m;
                // Half of the lines over [1, 2), half over [2, 4).
                const double q = 2 * i < entries ? 1 + 2.0 * i / entries : 4.0 * i / entries;
                EXPECT_EQ(table.inverse_root(q), exact.inverse_root(q)) << q;
            }
        }
    }
}

TEST(Operators, TablesAreContinuousAndMonotone) {
    for (const int word_bits : {8, 10, 15, 20}) {
        const double step = std::ldexp(1, 1 - word_bits);
        for (const Rounding rounding : roundings) {
            for (int entries = 4; entries <= 4096; entries *= 8) {
                const Operators table = of(Iteration::table, entries, word_bits, rounding);
                double before = 1;
                for_words(1, 2, word_bits - 1, [&](double m) {
                    const double now = table.reciprocal(m);
                    ASSERT_LE(now, before) << m;
                    ASSERT_LE(before - now, step) << m;
                    before = now;
                });
                ASSERT_EQ(before, 0.5);
                before = 1;
                for_words(1, 4, word_bits - 2, [&](double m) {
                    const double now = table.inverse_root(m);
                    ASSERT_LE(now, before) << m;
                    ASSERT_LE(before - now, step) << m;
                    before = now;
                });
                ASSERT_EQ(before, 0.5);
            }
        }
    }
}

TEST(Operators, NewtonFallsBackByOneLastBitAtMost) {
    for (const int word_bits : {8, 14, 20}) {
        const double step = std::ldexp(1, 1 - word_bits);
        const Operators newton = of(Iteration::newton, 64, word_bits);
        double least = 1;
        for_words(1, 2, word_bits - 1, [&](double m) {
            const double now = newton.reciprocal(m);
            ASSERT_LE(now, least + step) << m;
            ASSERT_GE(now, 0.5) << m;
            least = std::min(least, now);
        });
        least = 1;
        for_words(1, 4, word_bits - 2, [&](double m) {
            const double now = newton.inverse_root(m);
            ASSERT_LE(now, least + step) << m;
            ASSERT_GE(now, 0.5) << m;
            least = std::min(least, now);
        });
    }
}

TEST(Power, RisesWithTheBaseAndFallsWithTheExponent) {
    for (const int word_bits : {8, 14, 20}) {
        for (const PowerMethod method : power_methods) {
            if (method == PowerMethod::schlick) continue;  // as monotone as the reciprocal
            for (const int entries : {4, 32, 4096}) {
                SCOPED_TRACE(std::string(name_of(method)) + ", words of " + std::to_string(word_bits) +
                             " bits");
                const Operators operators = of(method, entries, word_bits);
                for (const double exponent : {0.25, 1.0, 7.0, 100.0, 1024.0}) {
                    double before = 0;
                    for_words(0, 1, std::min(word_bits - 2, 14), [&](double base) {
                        const double now = operators.power(base, exponent);
                        ASSERT_GE(now, before) << base << "^" << exponent;
                        ASSERT_LE(now, 1);
                        before = now;
                    });
                    ASSERT_EQ(before, 1);
                }
                for (const double base : {0.01, 0.3, 0.5, 0.9, 0.99}) {
                    double before = 1;
                    for (double exponent = 0; exponent <= 1030; exponent += 0.25) {
                        const double now = operators.power(base, exponent);
                        ASSERT_LE(now, before) << base << "^" << exponent;
                        before = now;
                    }
                }
            }
        }
    }
}

TEST(Power, OfPowersOfTwoIsExact) {
    for (const int word_bits : {8, 20, 32}) {
        for (const PowerMethod method : {PowerMethod::tables, PowerMethod::rounded}) {
            const Operators operators = of(method, 32, word_bits);
            for (int e = 1; e <= word_bits - 2; ++e) {
                EXPECT_EQ(operators.power(0.5, e), std::ldexp(1, -e)) << e;
                EXPECT_EQ(operators.power(std::ldexp(1, -e), 1), std::ldexp(1, -e)) << e;
                if (e > 16) continue;  // the base would be below the least base
                EXPECT_EQ(operators.power(std::ldexp(1, -2 * e), 0.5), std::ldexp(1, -e)) << e;
            }
        }
    }
}

TEST(Power, HasItsEndsInEveryMethod) {
    const double denormal = std::numeric_limits<double>::denorm_min();
    for (const int word_bits : {8, 20, 32}) {
        for (const PowerMethod method : power_methods) {
            SCOPED_TRACE(std::string(name_of(method)) + ", words of " + std::to_string(word_bits) + " bits");
            const Operators operators = of(method, 32, word_bits);
            EXPECT_EQ(operators.power(0, 0), 1);
            EXPECT_EQ(operators.power(0, 0.25), 0);
            EXPECT_EQ(operators.power(0, 1024), 0);
            EXPECT_EQ(operators.power(-1, 3), 0);
            EXPECT_EQ(operators.power(0.3, 0), 1);
            EXPECT_EQ(operators.power(0.3, -5), 1);
            const bool longer = word_bits > 20 && method != PowerMethod::schlick;
            EXPECT_EQ(operators.power(0.3, 0.0019) == 1, !longer) << "nearest 256th: 0";
            EXPECT_EQ(operators.power(0.3, 0.0021) == operators.power(0.3, 0.00390625), !longer);
            EXPECT_EQ(operators.power(1, 1024), 1);
            EXPECT_EQ(operators.power(1.5, 1024), 1);
            EXPECT_EQ(operators.power(1e300, 1e300), 1);
            EXPECT_EQ(operators.power(0.999, 1e300), operators.power(0.999, 524288));
            EXPECT_LE(operators.power(0.5, 1e300), 0.001);
            EXPECT_LE(operators.power(std::ldexp(1, -1022), 1), std::ldexp(1, -32));
            EXPECT_LE(operators.power(denormal, 1), std::ldexp(1, -32));
            // The word next to 1.
            const double next = 1 - std::ldexp(1, 2 - word_bits);
            EXPECT_NEAR(operators.power(next, 1), next, 2 * (1 - next));
        }
    }
}

TEST(Operators, EveryFiniteArgumentHasAFiniteResult) {
    using Limits = std::numeric_limits<double>;
    std::vector<double> corners = {0.0, -0.0, 1, 2, 4, Limits::min(), Limits::denorm_min(), Limits::max()};
    for (int e = -1074; e <= 1023; e += 1) {
        corners.push_back(std::ldexp(1, e));
        corners.push_back(std::ldexp(1.9999999999, e));
    }
    for (int word_bits = 8; word_bits <= 32; word_bits += 3) {
        for (const Rounding rounding : roundings) {
            for (const Iteration method : iterations) {
                const Operators operators = of(method, 64, word_bits, rounding);
                const double limit = std::ldexp(2 - std::ldexp(1, 1 - word_bits), 127);
                for (const double x : corners) {
                    for (const double y : {x, -x}) {
                        const double r = operators.reciprocal(y);
                        ASSERT_LE(std::abs(r), limit) << y;
                        ASSERT_TRUE(y == 0 || std::signbit(r) == std::signbit(y)) << y;
                        if (std::abs(y) > 0x1p-127 && std::abs(y) < 0x1p1000) {
                            ASSERT_NEAR(r * y, 1, 0.02) << y;
                        }
                        const double root = operators.inverse_root(y);
                        ASSERT_GE(root, 0) << y;
                        ASSERT_LE(root, limit) << y;
                    }
                }
                EXPECT_EQ(operators.reciprocal(0), limit);
                EXPECT_EQ(operators.reciprocal(-0.0), limit);
                EXPECT_EQ(operators.reciprocal(-Limits::denorm_min()), -limit);
                EXPECT_EQ(operators.reciprocal(0x1p-128), limit);
                EXPECT_EQ(operators.reciprocal(0x1p-127), 0x1p127);
                EXPECT_EQ(operators.inverse_root(0), limit);
                EXPECT_EQ(operators.inverse_root(-1), limit);
                EXPECT_EQ(operators.inverse_root(0x1p-255), limit);
                EXPECT_EQ(operators.inverse_root(0x1p-254), 0x1p127);
            }
        }
    }
}

TEST(Operators, TreatBothSignsAlike) {
    for (const std::uint64_t seed : property::seeds(5000, 20)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        for (const Rounding rounding : roundings) {
            const Operators operators = of(Iteration::newton, 64, random.whole(8, 32), rounding);
            for (int i = 0; i < 200; ++i) {
                const double x = random.uniform(0, 100);
                ASSERT_EQ(operators.reciprocal(-x), -operators.reciprocal(x)) << x;
            }
        }
    }
}

TEST(Operators, ResultsAreWordsAtTheEndsOfTheirRange) {
    for (int word_bits = 8; word_bits <= 32; ++word_bits) {
        const double smallest = std::ldexp(1, 2 - word_bits);  // format Q2.(W - 2)
        const double largest = 2 - smallest;
        for (const Iteration method : iterations) {
            const Operators operators = of(method, 64, word_bits);
            EXPECT_EQ(operators.reciprocal(smallest), 1 / smallest);
            const double relative = 4 * smallest + (method == Iteration::table ? 2e-4 : 0);
            EXPECT_NEAR(operators.reciprocal(largest) * largest, 1, relative);
            EXPECT_NEAR(operators.inverse_root(smallest) * std::sqrt(smallest), 1, relative);
            EXPECT_NEAR(operators.inverse_root(largest) * std::sqrt(largest), 1, relative);
            const double r = std::ldexp(operators.reciprocal(largest), word_bits - 1);
            EXPECT_EQ(r, std::floor(r));
            const double root = std::ldexp(operators.inverse_root(largest), word_bits - 1);
            EXPECT_EQ(root, std::floor(root));
        }
    }
}

TEST(Operators, RefuseTablesAndWordsOfOtherSizes) {
    OperatorSettings settings;
    for (int OperatorSettings::*size : {&OperatorSettings::reciprocal_table, &OperatorSettings::root_table,
                                        &OperatorSettings::power_table}) {
        for (const int entries : {-4, 1, 2, 3, 63, 65, 4095, 8192}) {
            settings = {};
            settings.*size = entries;
            EXPECT_THROW(Operators(settings, 20, Rounding::nearest), std::invalid_argument) << entries;
        }
        for (const int entries : {0, 4, 4096}) {
            settings = {};
            settings.*size = entries;
            EXPECT_NO_THROW(Operators(settings, 8, Rounding::nearest)) << entries;
        }
    }
    for (const int word_bits : {-1, 0, 7, 33, 64, 1000}) {
        EXPECT_THROW(Operators({}, word_bits, Rounding::nearest), std::invalid_argument) << word_bits;
    }
}

}  // namespace
}  // namespace raycell
