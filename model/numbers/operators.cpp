#include "model/numbers/operators.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "model/numbers/table_words.hpp"

namespace raycell {

namespace {

using Word = std::uint64_t;

constexpr int significand_bits = 52;      // of a double, without the leading 1
constexpr int schlick_exponent_bits = 8;  // fraction bits of an exponent, where the method is coarse anyway
constexpr int most_exponent_bits = 19;
constexpr Word most_octaves = 32;  // between 1 and the least base that a logarithm can hold
constexpr int top_exponent = 127;  // largest exponent of a result

/// |x| = significand / 2^52 * 2^exponent, significand from 2^52 on. A subnormal number, or 0, gets exponent
/// -1023.
struct Split {
    Word significand;
    int exponent;
};

Split split(double x) {
    Word bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const Word leading = Word(1) << significand_bits;
    return {(bits & (leading - 1)) | leading, int(bits >> significand_bits & 0x7ff) - 1023};
}

/// 1/m as a word of F fraction bits: the nearest one, or the one below. There are no ties.
Word exact_reciprocal(Word m, int fraction_bits, bool nearest) {
    return ((Word(1) << (2 * fraction_bits)) + (nearest ? m / 2 : 0)) / m;
}

/// The same for 1/sqrt(m), where m has F - 1 fraction bits.
Word exact_root(Word m, int fraction_bits, bool nearest) {
    // Twice the root is the largest h with h^2 * m <= 4 * 2^(3F - 1). The search starts next to it, at the
    // double-precision value.
    using Wide = unsigned __int128;
    const Wide limit = Wide(1) << (3 * fraction_bits + 1);
    Word h = Word(scale_by(1, fraction_bits + 1) / std::sqrt(double(m) * scale_by(1, 1 - fraction_bits)));
    while (Wide(h) * h * m > limit) --h;
    while (Wide(h + 1) * (h + 1) * m <= limit) ++h;
    return (h + nearest) >> 1;
}

int log2_of(int power_of_two) {
    int bits = 0;
    while (1 << bits < power_of_two) ++bits;
    return bits;
}

int checked_bits(int word_bits) {
    if (word_bits >= 8 && word_bits <= 32) return word_bits;
    throw std::invalid_argument("operators of words of " + std::to_string(word_bits) +
                                " bits; allowed are 8 to 32");
}

void check_table(const char* name, int size) {
    if (size >= 4 && size <= 4096 && (size & (size - 1)) == 0) return;
    throw std::invalid_argument(std::string(name) + " of " + std::to_string(size) +
                                " entries; allowed are powers of two from 4 to 4096");
}

}  // namespace

namespace table_word {

Word reciprocal(Word i, Word n, int fraction_bits) {
    const Word one = Word(1) << fraction_bits;
    return exact_reciprocal(one + i * (one / n), fraction_bits, true);
}

Word root(int octave, Word i, Word n, int fraction_bits) {
    const Word first = Word(1) << (fraction_bits - 1 + octave);
    return exact_root(first + i * (first / n), fraction_bits, true);
}

Word logarithm(Word i, Word n, int fraction_bits) {
    return Word(std::llround(std::log2(1 + double(i) / double(n)) * scale_by(1, fraction_bits)));
}

Word exponential(Word i, Word n, int fraction_bits) {
    return Word(std::llround(std::exp2(double(i) / double(n)) * scale_by(1, fraction_bits)));
}

}  // namespace table_word

/// `curve` gives the word at line i of n, for i from 0 to n.
template <class Curve>
Operators::Table Operators::tabulate(int size, int argument_bits, Curve curve) {
    const int index_bits = std::min(log2_of(size), argument_bits);
    const Word count = Word(1) << index_bits;
    Table table{{}, argument_bits - index_bits};
    Word start = curve(Word(0), count);
    for (Word i = 0; i < count; ++i) {
        const Word next = curve(i + 1, count);
        table.lines.push_back({start, std::int64_t(next) - std::int64_t(start)});
        start = next;
    }
    return table;
}

TableSizes table_sizes(const OperatorSettings& settings, int word_bits) {
    const auto size = [](int asked, int first, int steps) {
        return asked != 0 ? asked : first << std::max(steps, 0);
    };
    // A Newton step doubles the bits of a table. 64 lines give 14 bits for 1/x and 12 for 1/sqrt; twice as
    // many lines give two more bits.
    return {size(settings.reciprocal_table, 64, (word_bits - 25) / 4),
            size(settings.root_table, 64, (word_bits - 21) / 4),
            size(settings.power_table, 32, (word_bits - 19) / 2)};
}

Operators::Operators(const OperatorSettings& settings, int word_bits, Rounding rounding)
    : settings_(settings),
      fraction_bits_(checked_bits(word_bits) - 1),
      nearest_(rounding == Rounding::nearest),
      exponent_bits_(settings.power == PowerMethod::schlick
                         ? schlick_exponent_bits
                         : std::max(schlick_exponent_bits, word_bits - 12)),
      power_word_(2, word_bits - 2, rounding),
      exponent_word_(most_exponent_bits + 2, exponent_bits_, rounding) {
    const TableSizes sizes = table_sizes(settings, word_bits);
    check_table("reciprocal table", sizes.reciprocal);
    check_table("root table", sizes.root);
    check_table("power table", sizes.power);
    const int f = fraction_bits_;
    reciprocals_ =
        tabulate(sizes.reciprocal, f, [&](Word i, Word n) { return table_word::reciprocal(i, n, f); });
    for (const int octave : {0, 1}) {
        roots_[octave] = tabulate(sizes.root / 2, f - 1 + octave,
                                  [&](Word i, Word n) { return table_word::root(octave, i, n, f); });
    }
    logarithms_ = tabulate(sizes.power, f, [&](Word i, Word n) { return table_word::logarithm(i, n, f); });
    exponentials_ =
        tabulate(sizes.power, f, [&](Word i, Word n) { return table_word::exponential(i, n, f); });
}

/// The value returned for a result beyond 2^top_exponent, with the sign of x.
double Operators::signed_limit(double x) const {
    const double limit = scale_by(2 - scale_by(1, -fraction_bits_), top_exponent);
    return x < 0 ? -limit : limit;
}

/// value / 2^drop, rounded by the rounding mode; 0 if no bit is left.
inline Word Operators::round_off(Word value, int drop) const {
    if (drop <= 0) return value;
    if (drop > 63) return 0;
    if (!nearest_) return value >> drop;
    const Word even = value >> drop & 1;
    return (value + (Word(1) << (drop - 1)) - 1 + even) >> drop;
}

/// Interpolates the table at `argument`, whose leading bits select the line.
inline Word Operators::line_value(const Table& table, Word argument) const {
    const Table::Line& line = table.lines[argument >> table.rest_bits];
    const Word rest = argument & ((Word(1) << table.rest_bits) - 1);
    return round_off((line.start << table.rest_bits) + Word(line.rise) * rest, table.rest_bits);
}

inline Word Operators::reciprocal_mantissa(Word m) const {
    const int f = fraction_bits_;
    if (settings_.reciprocal == Iteration::rounded) return exact_reciprocal(m, f, nearest_);
    const Word r = line_value(reciprocals_, m - (Word(1) << f));
    if (settings_.reciprocal == Iteration::table) return r;
    const Word correction = round_off((Word(2) << (2 * f)) - m * r, f);
    return round_off(r * correction, f);
}

inline Word Operators::root_mantissa(Word m) const {
    const int f = fraction_bits_;
    if (settings_.root == Iteration::rounded) return exact_root(m, f, nearest_);
    const int octave = int(m >> f);
    const Word r = line_value(roots_[octave], m - (Word(1) << (f - 1 + octave)));
    if (settings_.root == Iteration::table) return r;
    // m * r comes first: it keeps all bits of a word, where r * r would lose up to two. Next to m = 4 the
    // root rounds to 2, just beyond the largest word; the largest word gives the same result.
    const Word root = round_off(m * r, f - 1);
    const Word correction = round_off((Word(3) << (2 * f)) - root * r, f + 1);
    return round_off(r * correction, f);
}

double Operators::reciprocal(double x) const {
    const int f = fraction_bits_;
    auto [significand, exponent] = split(x);
    if (exponent < -top_exponent) return signed_limit(x);
    Word m = round_off(significand, significand_bits - f);
    if (m >> (f + 1)) {
        m >>= 1;
        ++exponent;
    }
    const double r = scale_by(double(reciprocal_mantissa(m)), -f - exponent);
    return x < 0 ? -r : r;
}

double Operators::inverse_root(double x) const {
    const int f = fraction_bits_;
    const auto [significand, exponent] = split(x);
    if (exponent < -2 * top_exponent || x < 0) return signed_limit(0);
    const int odd = exponent & 1;
    int half_exponent = (exponent - odd) / 2;
    Word m = round_off(significand, significand_bits - (f - 1) - odd);
    if (m >> (f + 1)) {
        m >>= 2;
        ++half_exponent;
    }
    return scale_by(double(root_mantissa(m)), -f - half_exponent);
}

/// 2^(power * log2(base)), for base = m * 2^exponent < 1.
inline Word Operators::tables_power(Word m, int exponent, Word power) const {
    const int f = fraction_bits_;
    const Word logarithm = line_value(logarithms_, m - (Word(1) << f));
    const Word octaves = std::min((Word(-exponent) << f) - logarithm, most_octaves << f);
    // The result is 2^-product: a shift by the product rounded up to a whole number, times 2^(what rounding
    // up added). A product of 64 octaves or more leaves no bit of a word, and in long words it would not fit
    // into 64 bits.
    if ((unsigned __int128)octaves * power >> (f + exponent_bits_ + 6)) return 0;
    const Word product = round_off(octaves * power, exponent_bits_);
    const Word one = Word(1) << f;
    const Word shift = (product + one - 1) >> f;
    const Word mantissa = line_value(exponentials_, shift * one - product);
    return round_off(mantissa, int(shift) + 1);
}

/// b / (n - n*b + b) (Schlick 1994), for b with f fraction bits.
inline Word Operators::schlick_power(Word base, Word power) const {
    const int f = fraction_bits_;
    const Word one = Word(1) << f;
    const Word divisor = power * (one - base) + (base << schlick_exponent_bits);
    // The divisor has up to 59 bits, more than a double holds. It is at least 1/256, so it has no fewer bits
    // than a mantissa.
    const int top = 63 - __builtin_clzll(divisor);
    Word m = round_off(divisor, top - f);
    int exponent = top - (f + schlick_exponent_bits);
    if (m >> (f + 1)) {
        m >>= 1;
        ++exponent;
    }
    // With an exponent below 1 and a coarse reciprocal, the result could exceed 1.
    return std::min(round_off(base * reciprocal_mantissa(m), f + 1 + exponent), one / 2);
}

double Operators::power(double base, double exponent) const {
    const int f = fraction_bits_;
    const double most = scale_by(1, most_exponent_bits);
    const double held = exponent_word_.hold(std::max(std::min(exponent, most), 0.0));
    const Word power = Word(scale_by(held, exponent_bits_));
    if (power == 0 || base >= 1) return 1;
    if (base <= 0) return 0;
    const auto [significand, base_exponent] = split(base);
    if (settings_.power == PowerMethod::schlick) {
        const Word b = round_off(significand, significand_bits - f - base_exponent);
        return double(schlick_power(b, power)) * power_word_.step();
    }
    const Word m = round_off(significand, significand_bits - f);
    if (settings_.power == PowerMethod::rounded) {
        return power_word_.hold(std::pow(scale_by(double(m), base_exponent - f), held));
    }
    if (m >> (f + 1)) return double(tables_power(m >> 1, base_exponent + 1, power)) * power_word_.step();
    return double(tables_power(m, base_exponent, power)) * power_word_.step();
}

}  // namespace raycell
