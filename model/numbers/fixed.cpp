#include "model/numbers/fixed.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace raycell {

Format::Format(int integer_bits, int fraction_bits, Rounding rounding)
    : integer_bits_(integer_bits), fraction_bits_(fraction_bits), rounding_(rounding) {
    if (bits() < 2 || bits() > 48) {
        throw std::invalid_argument("a word of " + std::to_string(bits()) + " bits; allowed are 2 to 48");
    }
    step_ = scale_by(1, -fraction_bits);
    least_ = -scale_by(1, integer_bits - 1);
    most_ = -least_ - step_;
    shift_ = scale_by(1.5, 52 - fraction_bits);
}

double Format::hold_wide(__int128 value, int scale) const {
    const int drop =
        scale - fraction_bits_;  // bits behind the last one; scale is chosen so that there are some
    const __int128 one = __int128(1) << drop;
    __int128 word = value >> drop;  // towards minus infinity
    if (rounding_ == Rounding::nearest) {
        const __int128 rest = value - word * one;
        const __int128 half = one >> 1;
        if (rest > half || (rest == half && (word & 1))) ++word;
    }
    const __int128 limit = __int128(1) << (bits() - 1);
    word = std::min(std::max(word, -limit), limit - 1);
    return scale_by(double(std::int64_t(word)), -fraction_bits_);
}

int exponent_of(double x) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return int(bits >> 52 & 0x7ff) - 1023;
}

double scale_by(double x, int e) {
    if (e < -1000 || e > 1000) return std::ldexp(x, e);
    const std::uint64_t bits = std::uint64_t(1023 + e) << 52;
    double factor = 0;
    std::memcpy(&factor, &bits, sizeof factor);
    return x * factor;
}

}  // namespace raycell
