#include "model/numbers/arithmetic.hpp"

#include <cstdint>
#include <limits>
#include <stdexcept>

#include "model/numbers/tolerance.hpp"

namespace raycell {
namespace {

/// Number of bits of the integers below `reach`.
int bits_to(double reach) {
    int bits = 0;
    while (std::ldexp(1.0, bits) < reach) ++bits;
    return bits;
}

double diagonal(const ArrayExtent& e) {
    return std::sqrt(double(e.width) * e.width + double(e.height) * e.height + e.depth * e.depth);
}

constexpr int wide_scale = 80;

/// a·b·2^wide_scale. Bits behind the last one (only where a reciprocal is tiny) are kept as a sticky bit.
__int128 wide_product(double a, double b) {
    if (a == 0 || b == 0) return 0;
    // Scales both mantissas to integers of 48 bits, which hold every word.
    const int ea = exponent_of(a) - 47;
    const int eb = exponent_of(b) - 47;
    const __int128 product = __int128(std::int64_t(scale_by(a, -ea))) * std::int64_t(scale_by(b, -eb));
    const int shift = ea + eb + wide_scale;
    if (shift >= 0) return product * (__int128(1) << shift);
    const __int128 cut = product >> -shift;  // towards minus infinity
    return cut * (__int128(1) << -shift) == product ? cut : cut | 1;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> Formats::names() const {
    const auto word = [](const Format& f) {
        return "Q" + std::to_string(f.integer_bits()) + "." + std::to_string(f.fraction_bits());
    };
    const auto without_sign = [](const Format& f) {
        return "UQ" + std::to_string(f.integer_bits() - 1) + "." + std::to_string(f.fraction_bits());
    };
    return {{"unit", word(unit)},
            {"depth", word(depth)},
            {"distance", word(distance)},
            {"reach", word(reach)},
            {"offset", word(offset)},
            {"edge_offset", word(edge_offset)},
            {"normal", word(normal)},
            {"field", word(field)},
            {"accumulator", word(accumulator)},
            {"intensity", word(intensity)},
            {"feature", without_sign(feature)},
            {"index_of_refraction", without_sign(ior)},
            {"loading", word(loading)}};
}

Arithmetic::Arithmetic()
    : hair_(exact_hair), tie_(exact_tie), least_fresh_distance_(nearest_hit), default_normal_offset_(1e-8) {}

Formats::Formats(int word, Rounding rounding, const ArrayExtent& extent) : word_bits(word) {
    if (word < 8 || word > 32) {
        throw std::invalid_argument("a word of " + std::to_string(word) + " bits; allowed are 8 to 32");
    }
    const int fraction = word - 2;
    depth_bits = bits_to(extent.depth);
    const int way_bits = bits_to(diagonal(extent));
    const int offset_bits = 1 + bits_to(4 + extent.level);
    // Sums of three coordinates, each with a slope of at most 1, and a sign.
    const int scene_bits = 3 + bits_to(std::max({double(extent.width), double(extent.height), extent.depth}));
    // A format has at most 48 bits: in a very deep cube, the integer part leaves fewer fraction bits.
    const auto beside = [&](int integer_bits) { return std::min(fraction, 48 - integer_bits); };
    unit = Format(2, fraction, rounding);
    depth = Format(depth_bits + 4, beside(depth_bits + 4), rounding);
    distance = Format(way_bits + 2, beside(way_bits + 2), rounding);
    reach = Format(way_bits + 1, word - way_bits - 1, rounding);
    offset = Format(offset_bits, word - offset_bits, rounding);
    edge_offset = depth;
    normal = Format(4, word - 4, rounding);
    field = Format(6, fraction + 2, rounding);
    accumulator = Format(4, std::min(2 * fraction, 40));
    intensity = Format(4, word - 4, rounding);
    // The paper's widths for words of up to the paper's 20 bits. For longer words these fields grow too, so
    // that they don't limit the picture.
    const int more = std::max(word - 20, 0);
    feature = Format(3, std::min(word, 12) + more - 2);
    ior = Format(3, std::min(word, 16) + more - 2);
    shine_bits = 12 + more;
    loading = Format(scene_bits, word + 16 - scene_bits);
    from = Format(4, word + 11, rounding);
    array_exponent = scene_bits - 3;
}

int Formats::place_exponent(const dvec3& place) const {
    const double largest = std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
    return largest > 0 ? std::max(exponent_of(largest) + 1, array_exponent) : array_exponent;
}

Arithmetic::Arithmetic(const NumberSettings& settings, const ArrayExtent& extent) : Arithmetic() {
    formats_ = Formats(settings.word_bits, settings.rounding, extent);
    if (settings.arithmetic == Numbers::exact) return;
    exact_ = false;
    const int word = settings.word_bits;
    mantissa_ = Format(1, word - 1, settings.rounding);
    // The longest sum: a distance or a depth times a word's mantissa.
    const int way_bits = formats_.distance.integer_bits() - 2;
    narrow_ = std::max(formats_.depth_bits, way_bits) + 4 + (word - 2) + word <= 53;
    hair_ = 4 * formats_.unit.step();
    tie_ = hair_;
    least_fresh_distance_ = 64 * formats_.unit.step();
    default_normal_offset_ = 8 * formats_.unit.step();
    operators_ = std::make_shared<Operators>(settings.operators, word, settings.rounding);
}

double Arithmetic::wide(const Format& f, double c, double a1, double b1, double a2, double b2, double a3,
                        double b3) const {
    const double about = c + a1 * b1 + a2 * b2 + a3 * b3;
    const double size = std::abs(c) + std::abs(a1 * b1) + std::abs(a2 * b2) + std::abs(a3 * b3);
    // Far beyond every format: the sum saturates, whatever its last bits are.
    if (size > 0x1p44) return f.hold(about);
    // Seven roundings of at most 2^-53 each. If both ends of the error bound give the same word, it is the
    // word of the exact sum.
    const double bound = size * 0x1p-50;
    const double word = f.hold(about - bound);
    if (word == f.hold(about + bound)) return word;
    const __int128 sum =
        wide_product(c, 1) + wide_product(a1, b1) + wide_product(a2, b2) + wide_product(a3, b3);
    return f.hold_wide(sum, wide_scale);
}

double Arithmetic::square_root(double x) const {
    if (exact_) return std::sqrt(x);
    if (!(x > 0)) return 0;
    return product(formats_.unit, formats_.unit.hold(x), operators_->inverse_root(x));
}

dvec3 Arithmetic::normalise(const dvec3& v) const {
    double length = 0;
    return normalise(v, length);
}

dvec3 Arithmetic::normalise(const dvec3& v, double& length) const {
    if (exact_) {
        length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        return v * (1.0 / length);
    }
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const int exponent = exponent_of(largest) + 1;
    const dvec3 m(mantissa_.hold(scale_by(v.x, -exponent)), mantissa_.hold(scale_by(v.y, -exponent)),
                  mantissa_.hold(scale_by(v.z, -exponent)));
    const double squared = dot(formats_.field, m, m);
    const double inverse = operators_->inverse_root(squared);
    length = product(formats_.reach, squared, scale_by(inverse, exponent));
    return {product(formats_.unit, m.x, inverse), product(formats_.unit, m.y, inverse),
            product(formats_.unit, m.z, inverse)};
}

double Arithmetic::hold_reach(double distance) const {
    if (exact_) return distance;
    const double word = formats_.reach.hold(distance);
    return word >= formats_.reach.most() ? std::numeric_limits<double>::infinity() : word;
}

dvec3 Arithmetic::hold_place(const dvec3& place) const {
    if (exact_) return place;
    const int exponent = formats_.place_exponent(place);
    const Format mantissa(1, formats_.word_bits + 11);
    return {scale_by(mantissa.hold(scale_by(place.x, -exponent)), exponent),
            scale_by(mantissa.hold(scale_by(place.y, -exponent)), exponent),
            scale_by(mantissa.hold(scale_by(place.z, -exponent)), exponent)};
}

dvec3 Arithmetic::way(const dvec3& point, const dvec3& place) const {
    if (exact_) return place - point;
    const int exponent = formats_.place_exponent(place);
    dvec3 way;
    for (int axis = 0; axis < 3; ++axis) {
        way[axis] = place[axis] - scale_by(formats_.from.hold(scale_by(point[axis], -exponent)), exponent);
    }
    return way;
}

double Arithmetic::hold_shine(double shine) const {
    if (exact_) return shine;
    const int fraction_bits = formats_.shine_bits - Formats::shine_exponent_bits;
    const double least = scale_by(1, -8);
    if (!(shine >= least / 2)) return 0;
    const double inside = std::min(std::max(shine, least), scale_by(1, 19));
    const int exponent = exponent_of(inside);
    return scale_by(Format(2, fraction_bits).hold(scale_by(inside, -exponent) - 1) + 1, exponent);
}

const Arithmetic& exact_arithmetic() {
    static const Arithmetic exact;
    return exact;
}

}  // namespace raycell
