// Reference for the cell's operators: slow, in whole numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "model/numbers/operators.hpp"

namespace raycell::operator_reference {

inline const std::vector<Iteration> iterations = {Iteration::newton, Iteration::table, Iteration::rounded};
inline const std::vector<PowerMethod> power_methods = {PowerMethod::tables, PowerMethod::schlick,
                                                       PowerMethod::rounded};
inline const std::vector<Rounding> roundings = {Rounding::nearest, Rounding::truncate};

inline const char* name_of(Iteration method) {
    return method == Iteration::newton ? "newton" : method == Iteration::table ? "table" : "rounded";
}
inline const char* name_of(PowerMethod method) {
    return method == PowerMethod::tables ? "tables" : method == PowerMethod::schlick ? "schlick" : "rounded";
}

/// Settings with the same method and size for 1/x and 1/sqrt(x).
inline OperatorSettings same(Iteration method, int entries) {
    OperatorSettings settings;
    settings.reciprocal = settings.root = method;
    settings.reciprocal_table = settings.root_table = entries;
    return settings;
}

/// Operators with these settings and defaults for the rest.
inline Operators of(Iteration method, int entries, int word_bits, Rounding rounding = Rounding::nearest) {
    return Operators(same(method, entries), word_bits, rounding);
}
inline Operators of(PowerMethod method, int entries, int word_bits, Rounding rounding = Rounding::nearest) {
    OperatorSettings settings;
    settings.power = method;
    settings.power_table = entries;
    return Operators(settings, word_bits, rounding);
}

inline std::string label(const OperatorSettings& s, int word_bits, Rounding rounding) {
    return std::to_string(word_bits) + " bits, " + (rounding == Rounding::nearest ? "nearest" : "truncate") +
           ", reciprocal " + name_of(s.reciprocal) + " " + std::to_string(s.reciprocal_table) + ", root " +
           name_of(s.root) + " " + std::to_string(s.root_table) + ", power " + name_of(s.power) + " " +
           std::to_string(s.power_table);
}

/// Calls `visit` with words of `fraction_bits` from `first` to `last`, both included: with every mantissa of
/// up to 20 bits, and with about as many of a longer one, evenly spread.
template <class Visit>
void for_words(double first, double last, int fraction_bits, Visit visit) {
    const auto from = std::int64_t(std::ldexp(first, fraction_bits));
    const auto to = std::int64_t(std::ldexp(last, fraction_bits));
    const std::int64_t most = 3 << 18;
    const std::int64_t stride = to - from <= most ? 1 : (to - from) / most | 1;
    for (std::int64_t i = from; i < to; i += stride) visit(std::ldexp(double(i), -fraction_bits));
    visit(last);
}

/// The results that the operators must give, written in fractions of whole numbers: no shifts, no masks, and
/// every rounding is a division.
class Reference {
  public:
    Reference(const OperatorSettings& settings, int word_bits, Rounding rounding)
        : settings_(settings),
          sizes_(table_sizes(settings, word_bits)),
          f_(word_bits - 1),
          one_(two_to(f_)),
          per_one_(settings.power == PowerMethod::schlick || word_bits <= 20 ? 256 : two_to(word_bits - 12)),
          nearest_(rounding == Rounding::nearest) {}

    double reciprocal(double x) const {
        const Argument a = argument(std::abs(x), 2);
        return std::copysign(std::ldexp(double(reciprocal_of(a.mantissa)), -f_ - a.exponent), x);
    }

    double inverse_root(double x) const {
        const Argument a = argument(x, 4);
        return std::ldexp(double(root_of(a.mantissa)), -f_ - a.exponent / 2);
    }

    double power(double base, double exponent) const {
        const auto scaled = Integer(whole(double(per_one_) * std::min(exponent, 524288.0)));
        if (scaled == 0 || base >= 1) return 1;
        if (base == 0) return 0;
        const Integer word = settings_.power == PowerMethod::tables ? by_tables(argument(base, 2), scaled)
                                                                    : by_schlick(base, scaled);
        return std::ldexp(double(word), 1 - f_);
    }

  private:
    using Integer = __int128;
    struct Argument {
        Integer mantissa;
        int exponent;
    };

    static Integer two_to(int exponent) { return Integer(1) << exponent; }

    double whole(double x) const { return nearest_ ? std::nearbyint(x) : std::floor(x); }

    static Integer nearest(Integer numerator, Integer denominator) {
        Integer quotient = numerator / denominator;
        const Integer rest = numerator % denominator;
        if (2 * rest > denominator || (2 * rest == denominator && quotient % 2 == 1)) ++quotient;
        return quotient;
    }

    Integer rounded(Integer numerator, Integer denominator) const {
        return nearest_ ? nearest(numerator, denominator) : numerator / denominator;
    }

    /// Splits x into mantissa * base^k. The mantissa is a word from 1 to `base`; exponent = log2(base) * k.
    Argument argument(double x, double base) const {
        int exponent = 0;
        const int octaves = base == 4 ? 2 : 1;
        while (x < 1) x *= base, exponent -= octaves;
        while (x >= base) x /= base, exponent += octaves;
        const int fraction_bits = f_ + 1 - octaves;
        const double word = whole(std::ldexp(x, fraction_bits));
        if (word == std::ldexp(base, fraction_bits)) return {two_to(fraction_bits), exponent + octaves};
        return {Integer(word), exponent};
    }

    /// The same for numerator / unit with a binary mantissa, in whole numbers.
    Argument mantissa_of(Integer numerator, Integer unit) const {
        int exponent = 0;
        while (numerator < unit) numerator *= 2, --exponent;
        while (numerator >= 2 * unit) unit *= 2, ++exponent;
        const Integer word = rounded(numerator * one_, unit);
        if (word == 2 * one_) return {one_, exponent + 1};
        return {word, exponent};
    }

    Integer between(Integer start, Integer next, Integer rest, Integer width) const {
        return rounded(start * (width - rest) + next * rest, width);
    }

    Integer reciprocal_of(Integer m) const {
        const auto exact = [&](Integer x) { return nearest(one_ * one_, x); };
        if (settings_.reciprocal == Iteration::rounded) return rounded(one_ * one_, m);
        const Integer lines = std::min(Integer(sizes_.reciprocal), one_);
        const Integer width = one_ / lines;
        const Integer start = m - (m - one_) % width;
        const Integer r = between(exact(start), exact(start + width), m - start, width);
        if (settings_.reciprocal == Iteration::table) return r;
        return rounded(r * rounded(2 * one_ * one_ - m * r, one_), one_);
    }

    /// 1/sqrt digit by digit, with one digit more than a word has.
    Integer root_of(Integer m) const {
        const auto digits = [&](Integer x) {
            Integer root = 0;
            for (int digit = f_ + 1; digit >= 0; --digit) {
                const Integer next = root + two_to(digit);
                if (next * next * x <= 2 * one_ * one_ * one_) root = next;
            }
            return root;
        };
        if (settings_.root == Iteration::rounded) return (digits(m) + (nearest_ ? 1 : 0)) / 2;
        const auto exact = [&](Integer x) { return (digits(x) + 1) / 2; };
        // Half of the table's lines cover [1, 2), half [2, 4). Here 1 is represented by one_ / 2.
        const Integer first = m < one_ ? one_ / 2 : one_;
        const Integer lines = std::min(Integer(sizes_.root / 2), first);
        const Integer width = first / lines;
        const Integer start = m - (m - first) % width;
        const Integer r = between(exact(start), exact(start + width), m - start, width);
        if (settings_.root == Iteration::table) return r;
        const Integer root = std::min(rounded(m * r, one_ / 2), 2 * one_ - 1);
        return rounded(r * rounded(3 * one_ * one_ - root * r, 2 * one_), one_);
    }

    Integer by_tables(Argument base, Integer scaled) const {
        if (base.exponent >= 0) return one_ / 2;
        const auto word = [&](long double x) { return Integer(std::llround(x * (long double)(one_))); };
        const auto line = [&](Integer x, Integer range, auto curve) {
            const Integer lines = std::min(Integer(sizes_.power), range);
            const Integer width = range / lines;
            const Integer i = x / width;
            return between(word(curve((long double)(i) / (long double)(lines))),
                           word(curve((long double)(i + 1) / (long double)(lines))), x % width, width);
        };
        const Integer logarithm = base.exponent * one_ + line(base.mantissa - one_, one_,
                                                              [](long double x) { return std::log2(1 + x); });
        // Rounded as a magnitude, as in the cell.
        const Integer product = -rounded(-std::max(logarithm, -32 * one_) * scaled, per_one_);
        Integer octave = 0;
        while (octave * one_ > product && octave > -200) --octave;
        if (octave == -200) return 0;
        const Integer mantissa = std::min(
            line(product - octave * one_, one_, [](long double x) { return std::exp2(x); }), 2 * one_ - 1);
        return octave < -90 ? 0 : rounded(mantissa, two_to(int(1 - octave)));
    }

    Integer by_schlick(double base, Integer scaled) const {
        const auto b = Integer(whole(base * double(one_)));
        const Integer divisor = scaled * (one_ - b) + 256 * b;
        const Argument a = mantissa_of(divisor, 256 * one_);
        // 2^(exponent + 8) is whole because the divisor is at least 1/256.
        return std::min(rounded(256 * b * reciprocal_of(a.mantissa), 2 * one_ * two_to(a.exponent + 8)),
                        one_ / 2);
    }

    OperatorSettings settings_;
    TableSizes sizes_;
    int f_;
    Integer one_;
    Integer per_one_;  ///< resolution of an exponent, in parts of one
    bool nearest_;
};

}  // namespace raycell::operator_reference
