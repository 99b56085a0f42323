// Words of a fixed length: the numbers of the cell (paper, section 4.1: a 20-bit ALU).
//
// A word is stored in a double that is an exact multiple of the word's last bit. Words have at most 48 bits,
// so nothing is lost, and exact and fixed arithmetic share their data structures. Formats are run-time
// values.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/settings/settings.hpp"

namespace raycell {

/// Two's complement Q(integer_bits).(fraction_bits); the sign is among the integer bits. Saturates (SC_SAT)
/// at both ends, never wraps round. integer_bits + fraction_bits is the word's length, 2 to 48; either part
/// may be negative.
class Format {
  public:
    Format() : Format(2, 18) {}
    Format(int integer_bits, int fraction_bits, Rounding rounding = Rounding::nearest);

    /// Rounds a finite value to a word by the rounding mode; a value out of range gives the nearer end of the
    /// range.
    double hold(double value) const {
        const double inside = std::min(std::max(value, least_), most_);
        // At this magnitude a double's last bit is the word's: the addition itself rounds, ties to even.
        double word = (inside + shift_) - shift_;
        if (rounding_ == Rounding::truncate && word > inside) word -= step_;
        return word;
    }
    /// The same for value / 2^`scale`, held exactly in 128 bits: for sums of products that no double can
    /// hold.
    double hold_wide(__int128 value, int scale) const;

    int bits() const { return integer_bits_ + fraction_bits_; }
    int integer_bits() const { return integer_bits_; }
    int fraction_bits() const { return fraction_bits_; }
    double step() const { return step_; }    ///< value of the last bit
    double least() const { return least_; }  ///< -2^(integer_bits - 1)
    double most() const { return most_; }    ///< 2^(integer_bits - 1) - step
    Rounding rounding() const { return rounding_; }

  private:
    int integer_bits_;
    int fraction_bits_;
    Rounding rounding_;
    double step_;
    double least_;
    double most_;
    double shift_;  ///< 1.5 * 2^(52 - fraction_bits)
};

/// Exponent e of 2^e <= |x| < 2^(e + 1), for a normal number other than 0: a leading-zero count.
int exponent_of(double x);

/// x * 2^e, exact unless the result leaves the range of double.
double scale_by(double x, int e);

}  // namespace raycell
