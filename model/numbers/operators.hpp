// Operators that the cell's ALU has no instruction for (paper, section 4.1: approximations of square root,
// division and exponentiation): reciprocal, 1/sqrt and power, each with a choice of methods.
#pragma once

#include <cstdint>
#include <vector>

#include "model/numbers/fixed.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// Lines of each table: as set, or else as many as the word length needs. Power has two tables of its size.
struct TableSizes {
    int reciprocal;
    int root;
    int power;
};
TableSizes table_sizes(const OperatorSettings& settings, int word_bits);

/// The operators of one word length W. Arguments and results are unsigned mantissas of W bits, 1.(W - 1),
/// with separate sign and exponent. A leading-zero count normalises them, so accuracy is relative and does
/// not depend on magnitude. An argument is first rounded to such a mantissa by the rounding mode, which acts
/// on magnitudes here: truncation goes towards 0. Powers of two (reciprocal) and of four (inverse_root) give
/// exact results.
///
/// All registers in between are words of W bits too; products and their sums are exact until they are rounded
/// to a word. Tables hold the nearest words in either mode, with lines between neighbours: results of `table`
/// are continuous and monotone. Nothing throws, and every finite argument has a finite result; the caller
/// checks that an argument makes sense.
class Operators {
  public:
    /// Builds the tables. Throws std::invalid_argument for a table size that is no power of two from 4 to
    /// 4096, and for a word length outside 8 to 32 bits.
    Operators(const OperatorSettings& settings, int word_bits, Rounding rounding);

    /// 1/x, its mantissa in [0.5, 1]. For |x| < 2^-127, 0 included: the largest mantissa times 2^127, with
    /// the sign of x; products with it are still finite.
    double reciprocal(double x) const;
    /// 1/sqrt(x), its mantissa in [0.5, 1]. An even exponent normalises x to 2.(W - 2) in [1, 4). Half of the
    /// table's lines lie over [1, 2), half over [2, 4): the exponent's last bit and the leading bits behind
    /// the 1 select a line. For x < 2^-254, 0 and negative x included: as the reciprocal of 0.
    double inverse_root(double x) const;
    /// base^exponent as a word Q2.(W - 2), 0 to 1. The base is clamped to 0 to 1 and the exponent to 0 to
    /// 2^19. The exponent has W - 12 fraction bits, at least 8 (`schlick`: 8). 0^0 = 1, as in Phong's term
    /// with Shine 0. `tables` can't distinguish bases below 2^-32.
    double power(double base, double exponent) const;

    const OperatorSettings& settings() const { return settings_; }

    using Word = std::uint64_t;  ///< raw bits of a word, or of a double-length product

    /// A function as lines between words on its curve.
    struct Table {
        struct Line {
            Word start;
            std::int64_t rise;  ///< to the start of the next line
        };
        std::vector<Line> lines;  ///< no more than there are arguments
        int rest_bits;            ///< of the argument, behind those that select the line
    };
    /// 1/m over [1, 2), W - 1 fraction bits.
    const Table& reciprocals() const { return reciprocals_; }
    /// 1/sqrt(m) over [1, 2) (octave 0) and [2, 4) (octave 1).
    const Table& roots(int octave) const { return roots_[octave]; }
    /// log2(m) over [1, 2) and 2^x over [0, 1).
    const Table& logarithms() const { return logarithms_; }
    const Table& exponentials() const { return exponentials_; }
    /// power's exponent as it is held.
    const Format& exponent_word() const { return exponent_word_; }

  private:
    template <class Curve>
    static Table tabulate(int size, int argument_bits, Curve curve);
    double signed_limit(double x) const;
    Word round_off(Word value, int drop) const;
    Word line_value(const Table& table, Word argument) const;
    Word reciprocal_mantissa(Word m) const;
    Word root_mantissa(Word m) const;
    Word tables_power(Word m, int exponent, Word power) const;
    Word schlick_power(Word base, Word power) const;

    OperatorSettings settings_;
    int fraction_bits_;  ///< of a mantissa: W - 1
    bool nearest_;
    int exponent_bits_;  ///< fraction bits of power's exponent
    Format power_word_;
    Format exponent_word_;  ///< holds exponents of power
    Table reciprocals_;     ///< 1/m over [1, 2)
    Table roots_[2];        ///< 1/sqrt(m) over [1, 2) and over [2, 4), as many lines each
    Table logarithms_;      ///< log2(m) over [1, 2)
    Table exponentials_;    ///< 2^f over [0, 1)
};

}  // namespace raycell
