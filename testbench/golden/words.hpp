// Numbers as golden vectors have them: the integers that hardware's registers hold.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// What is wrong with golden vectors, or with what drives a cell: where, what, what was allowed.
struct GoldenError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The words of a line, which blanks separate.
std::vector<std::string> tokens_of(const std::string& line);

/// Text of numbers and back, nothing lost. A word is its integer, in units of its format's last bit; a
/// floating number is mantissa:exponent, the value mantissa · 2^(exponent - bits + 1), its mantissa of `bits`
/// bits beside the sign (zero is 0:0). What is no word (exact arithmetic) is C's hexadecimal floating point,
/// and infinity is "inf".
class Words {
  public:
    explicit Words(const Arithmetic& arithmetic) : arithmetic_(arithmetic) {}
    const Formats& formats() const { return arithmetic_.formats(); }

    std::string word(const Format& format, double value) const;
    std::string floating(int bits, double value) const;
    /// Both throw GoldenError for what is no number of this kind.
    double read_word(const Format& format, const std::string& text) const;
    double read_floating(int bits, const std::string& text) const;

    /// C's hexadecimal floating point, whatever the arithmetic, or "inf".
    static std::string hexadecimal(double value);
    static double read_hexadecimal(const std::string& text);

  private:
    const Arithmetic& arithmetic_;
};

}  // namespace raycell
