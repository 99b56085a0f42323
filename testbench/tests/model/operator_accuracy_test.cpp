// Errors of the operators over all arguments, against double precision.
#include <gtest/gtest.h>

#include "operator_reference.hpp"

namespace raycell {
namespace {

using namespace operator_reference;

struct Errors {
    double largest = 0;
    double sum = 0;
    int count = 0;
    void add(double error) {
        largest = std::max(largest, std::abs(error));
        sum += std::abs(error);
        ++count;
    }
    double bits() const { return -std::log2(largest); }
    double mean() const { return sum / count; }
};

Errors reciprocal_errors(const Operators& operators, int word_bits) {
    Errors errors;
    for_words(1, 2, word_bits - 1, [&](double m) { errors.add(operators.reciprocal(m) - 1 / m); });
    return errors;
}

Errors root_errors(const Operators& operators, int word_bits) {
    Errors errors;
    for_words(1, 4, word_bits - 2,
              [&](double m) { errors.add(operators.inverse_root(m) - 1 / std::sqrt(m)); });
    return errors;
}

Errors power_errors(const Operators& operators, int word_bits, double most_exponent) {
    Errors errors;
    for (const double exponent : {1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1000, 1024}) {
        if (exponent > most_exponent) break;
        for_words(0, 1, std::min(word_bits - 2, 18), [&](double base) {
            errors.add(operators.power(base, exponent) - std::pow(base, exponent));
        });
    }
    return errors;
}

TEST(Operators, RoundedIsTheNearestWordOrTheOneBelow) {
    for (const int word_bits : {8, 13, 20, 27, 32}) {
        const Operators nearest = of(Iteration::rounded, 64, word_bits);
        const Operators below = of(Iteration::rounded, 64, word_bits, Rounding::truncate);
        const long double step = std::ldexp(1.0L, 1 - word_bits);
        const auto expect = [&](double near, double under, long double truth) {
            ASSERT_LE(std::abs(near - truth), step / 2);
            ASSERT_LE(under, truth);
            ASSERT_LT(truth - under, step);
        };
        for_words(1, 2, word_bits - 1, [&](double m) {
            expect(nearest.reciprocal(m), below.reciprocal(m), 1 / (long double)(m));
        });
        for_words(1, 4, word_bits - 2, [&](double m) {
            expect(nearest.inverse_root(m), below.inverse_root(m), 1 / std::sqrt((long double)(m)));
        });
    }
}

TEST(Operators, RoundedPowersAreTheNearestWord) {
    for (const int word_bits : {8, 20, 32}) {
        const Operators nearest = of(PowerMethod::rounded, 32, word_bits);
        const Operators below = of(PowerMethod::rounded, 32, word_bits, Rounding::truncate);
        const double step = std::ldexp(1, 2 - word_bits);
        for (const double exponent : {0.25, 1.0, 2.5, 20.0, 1024.0, 100000.0}) {
            for_words(0, 1, std::min(word_bits - 2, 16), [&](double base) {
                const double truth = std::pow(base, exponent);
                ASSERT_LE(std::abs(nearest.power(base, exponent) - truth), step / 2) << base;
                ASSERT_LE(below.power(base, exponent), truth) << base;
                ASSERT_LT(truth - below.power(base, exponent), step) << base;
            });
        }
    }
}

struct Accuracy {
    Iteration method;
    int entries;
    int word_bits;
    double bits;  ///< of the largest error
    double mean;
};

void expect_accuracy(const Errors& errors, const Accuracy& expected) {
    SCOPED_TRACE(std::string(name_of(expected.method)) + ", " + std::to_string(expected.entries) +
                 " entries, words of " + std::to_string(expected.word_bits) + " bits");
    EXPECT_NEAR(errors.bits(), expected.bits, 0.06);
    EXPECT_NEAR(errors.mean(), expected.mean, 0.02 * expected.mean);
}

TEST(Reciprocal, HasTheAccuracyOfItsTableSizeAndWordOverAllMantissas) {
    const std::vector<Accuracy> table = {
        {Iteration::table, 16, 20, 10.1, 2.44e-4},   {Iteration::table, 64, 20, 14.0, 1.52e-5},
        {Iteration::table, 128, 20, 15.9, 3.78e-6},  {Iteration::table, 64, 12, 10.9, 1.52e-4},
        {Iteration::table, 64, 32, 14.0, 1.53e-5},   {Iteration::newton, 16, 20, 18.5, 5.74e-7},
        {Iteration::newton, 64, 20, 19.0, 5.58e-7},  {Iteration::newton, 64, 32, 27.9, 5.03e-10},
        {Iteration::newton, 64, 8, 7.5, 2.18e-3},    {Iteration::rounded, 64, 20, 20.0, 4.77e-7},
        {Iteration::rounded, 64, 32, 32.0, 1.16e-10}};
    for (const Accuracy& expected : table) {
        const Operators operators = of(expected.method, expected.entries, expected.word_bits);
        expect_accuracy(reciprocal_errors(operators, expected.word_bits), expected);
    }
}

TEST(InverseRoot, HasTheAccuracyOfItsTableSizeAndWordOverAllMantissas) {
    const std::vector<Accuracy> table = {
        {Iteration::table, 16, 20, 9.63, 3.38e-4},   {Iteration::table, 64, 20, 13.46, 2.12e-5},
        {Iteration::table, 128, 20, 15.41, 5.25e-6}, {Iteration::table, 64, 12, 11.04, 1.49e-4},
        {Iteration::table, 64, 32, 13.47, 2.12e-5},  {Iteration::newton, 16, 20, 17.72, 6.94e-7},
        {Iteration::newton, 64, 20, 18.75, 5.62e-7}, {Iteration::newton, 64, 32, 26.28, 1.42e-9},
        {Iteration::newton, 64, 8, 7.39, 2.31e-3},   {Iteration::rounded, 64, 20, 20.0, 4.77e-7},
        {Iteration::rounded, 64, 32, 32.0, 1.16e-10}};
    for (const Accuracy& expected : table) {
        const Operators operators = of(expected.method, expected.entries, expected.word_bits);
        expect_accuracy(root_errors(operators, expected.word_bits), expected);
    }
}

TEST(Power, OfTablesWithThirtyTwoEntriesIsWithinThreeThousandths) {
    const Operators operators = of(PowerMethod::tables, 32, 20);
    EXPECT_NEAR(power_errors(operators, 20, 100).largest, 0.00166, 0.00002);
    const Errors all = power_errors(operators, 20, 1024);
    EXPECT_NEAR(all.largest, 0.00296, 0.00003);
    EXPECT_NEAR(all.mean(), 1.54e-5, 0.03e-5);
}

TEST(Power, OfTablesGetsTwiceAsAccurateWithTwiceTheEntriesUntilTheLogarithmsLastBitCounts) {
    double before = power_errors(of(PowerMethod::tables, 8, 32), 32, 1024).largest;
    for (const int entries : {16, 32, 64, 128}) {
        const double now = power_errors(of(PowerMethod::tables, entries, 32), 32, 1024).largest;
        EXPECT_LT(now, 0.55 * before) << entries << " entries";
        EXPECT_GT(now, 0.4 * before) << entries << " entries";
        before = now;
    }
    // One last bit of the logarithm (half from the table's entries, half from the line) times 1024.
    const double last_bit = std::ldexp(1, -19) * 1024 * std::log(2.0);
    const double least = power_errors(of(PowerMethod::tables, 4096, 20), 20, 1024).largest;
    EXPECT_LT(least, last_bit);
    EXPECT_GT(least, 0.6 * last_bit);
}

TEST(Power, OfSchlickIsWithinAFifth) {
    const Errors errors = power_errors(of(PowerMethod::schlick, 32, 20), 20, 1024);
    EXPECT_NEAR(errors.largest, 0.203, 0.002);
    EXPECT_NEAR(errors.mean(), 3.87e-2, 0.05e-2);
    EXPECT_NEAR(of(PowerMethod::schlick, 32, 20).power(0.5, 2), 0.5 / 1.5, 4e-6);
}

/// Largest distance between a chord over `width` and a curve whose second derivative is `bend`.
double chord_gap(double width, double bend) { return width * width / 8 * bend; }

TEST(Operators, ErrorsStayBelowTheChordsGapOrItsSquareAndTheRoundings) {
    for (const int word_bits : {8, 12, 16, 20, 32}) {
        const double step = std::ldexp(1, 1 - word_bits);
        for (int entries = 4; entries <= 4096; entries *= 4) {
            SCOPED_TRACE(std::to_string(entries) + " entries, words of " + std::to_string(word_bits) +
                         " bits");
            const double gap = chord_gap(1.0 / entries, 2);
            const double root_gap = chord_gap(2.0 / entries, 0.75);  // over [1, 2), where it is larger
            // The rounding of an entry and of the result.
            const Operators table = of(Iteration::table, entries, word_bits);
            EXPECT_LE(reciprocal_errors(table, word_bits).largest, gap + step);
            EXPECT_LE(root_errors(table, word_bits).largest, root_gap + step);
            if (word_bits == 32 && entries <= 256) {  // the gap alone must show
                EXPECT_GE(reciprocal_errors(table, word_bits).largest, gap * (1 - 4.0 / entries) - step);
                EXPECT_GE(root_errors(table, word_bits).largest, root_gap * (1 - 3.0 / entries) - step);
            }
            // An error e before the Newton step becomes e^2 (of 1/x, m <= 2) or 1.5*e^2 (relative). The
            // rounding of the correction adds up to a half, that of m*r up to a quarter of a last bit.
            const Operators newton = of(Iteration::newton, entries, word_bits);
            const double before = gap + step;
            const double root_before = root_gap + step;
            EXPECT_LE(reciprocal_errors(newton, word_bits).largest, 2 * before * before + step);
            EXPECT_LE(root_errors(newton, word_bits).largest, 3 * root_before * root_before + 1.25 * step);
        }
    }
}

TEST(Operators, TruncatedResultsAreUpToThreeLastBitsLow) {
    for (const int word_bits : {8, 14, 20}) {
        const double step = std::ldexp(1, 1 - word_bits);
        const Operators newton = of(Iteration::newton, 256, word_bits, Rounding::truncate);
        double least = 0;
        double most = 0;
        for_words(1, 2, word_bits - 1, [&](double m) {
            least = std::min(least, newton.reciprocal(m) - 1 / m);
            most = std::max(most, newton.reciprocal(m) - 1 / m);
        });
        EXPECT_LE(most, 0);
        EXPECT_GT(least, -2.1 * step);
        EXPECT_LT(least, -0.98 * step);
        least = 0;
        for_words(1, 4, word_bits - 2, [&](double m) {
            const double error = newton.inverse_root(m) - 1 / std::sqrt(m);
            least = std::min(least, error);
            most = std::max(most, error);
        });
        EXPECT_LE(most, step);  // a truncated product m*r makes the correction larger
        EXPECT_GT(least, -3 * step);
    }
}

}  // namespace
}  // namespace raycell
