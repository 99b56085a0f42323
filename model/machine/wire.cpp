#include "model/machine/wire.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {
namespace {

constexpr std::uint32_t no_polygon_code = (1U << field::polygon_id) - 1;

}  // namespace

Wire::Wire(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats)
    : formats_(formats),
      shadows_(picture.shadows),
      x_bits_(bits_for(picture.width)),
      y_bits_(bits_for(picture.height)),
      slot_bits_(slot_address_bits(picture, machine)),
      own_rays_(own_rays_of(picture, machine)) {
    if (picture.numbers.arithmetic == Numbers::exact)
        throw std::invalid_argument("the numbers of exact arithmetic are no words");
}

/// A mantissa without its sign, which is the direction's, and an exponent of base 2: 1/x = mantissa ·
/// 2^(exponent − word + 1). Mantissa 0: the ray never crosses such a side.
void Wire::put_reciprocal(WireBits& bits, const char* name, double value) const {
    int exponent = 0;
    const double mantissa = std::ldexp(std::frexp(std::abs(value), &exponent), formats_.word_bits - 1);
    const int limit = 1 << (Formats::exponent_bits - 1);
    if (mantissa != std::floor(mantissa) || exponent < -limit || exponent >= limit)
        refuse_value(name, value, formats_.word_bits + Formats::exponent_bits);
    put_number(bits, name, std::uint64_t(mantissa), formats_.word_bits);
    bits.put_signed(exponent, Formats::exponent_bits);
}

double Wire::get_reciprocal(WireBits& bits, double direction) const {
    const auto mantissa = double(bits.get(formats_.word_bits));
    const auto exponent = int(bits.get_signed(Formats::exponent_bits));
    const double size = std::ldexp(mantissa, exponent - formats_.word_bits + 1);
    return direction < 0 ? -size : size;
}

void Wire::put_place(WireBits& bits, const Ray& ray) const {
    const int word = formats_.word_bits;
    put_word(bits, "x", ray.position.x, formats_.unit, word);
    put_word(bits, "y", ray.position.y, formats_.unit, word);
    put_word(bits, "z", ray.position.z, formats_.depth, wire_depth_bits(formats_));
    put_word(bits, "dx", ray.direction.x, formats_.unit, word);
    put_word(bits, "dy", ray.direction.y, formats_.unit, word);
    put_word(bits, "dz", ray.direction.z, formats_.unit, word);
    put_reciprocal(bits, "1/dx", ray.inverse_x);
    put_reciprocal(bits, "1/dy", ray.inverse_y);
}

void Wire::get_place(WireBits& bits, Ray& ray) const {
    const int word = formats_.word_bits;
    ray.position.x = get_word(bits, formats_.unit, word);
    ray.position.y = get_word(bits, formats_.unit, word);
    ray.position.z = get_word(bits, formats_.depth, wire_depth_bits(formats_));
    ray.direction.x = get_word(bits, formats_.unit, word);
    ray.direction.y = get_word(bits, formats_.unit, word);
    ray.direction.z = get_word(bits, formats_.unit, word);
    ray.inverse_x = get_reciprocal(bits, ray.direction.x);
    ray.inverse_y = get_reciprocal(bits, ray.direction.y);
}

void Wire::put_address(WireBits& bits, int x, int y, std::uint32_t slot, bool of_pixel,
                       unsigned child) const {
    put_number(bits, "home x", std::uint64_t(x), x_bits_);
    put_number(bits, "home y", std::uint64_t(y), y_bits_);
    put_number(bits, "slot", of_pixel ? own_ray_code(slot) : slot, slot_bits_);
    put_number(bits, "child", child, field::child);
}

RayKind Wire::verdict_kind(bool precast) const {
    if (precast) return RayKind::precast;
    return shadows_ == Shadows::memo ? RayKind::memo : RayKind::shadow;
}

WireBits Wire::pack(const Ray& ray) const {
    const bool shadow = is_shadow(ray.kind);
    WireBits bits;
    bits.put(std::uint64_t(shadow ? WireType::shadow_ray : WireType::ray), field::type);
    put_place(bits, ray);
    if (shadow) {
        const Format& reach = formats_.reach;
        const double way = std::isinf(ray.reach) ? reach.most() : ray.reach;
        put_word(bits, "reach", way, reach, formats_.word_bits);
    } else {
        put_word(bits, "weight", ray.weight, formats_.unit, formats_.word_bits);
    }
    if (ray.leaves >= no_polygon_code && ray.leaves != no_polygon)
        refuse_value("polygon left", ray.leaves, field::polygon_id);
    bits.put(ray.leaves == no_polygon ? no_polygon_code : ray.leaves, field::polygon_id);
    if (!shadow) put_number(bits, "generation", ray.generation, field::generation);
    bits.put(ray.outside ? 1 : 0, 1);
    put_address(bits, ray.home_x, ray.home_y, ray.slot, ray.kind == RayKind::primary, ray.child);
    return bits;
}

Ray Wire::unpack_ray(WireBits bits, bool precast) const {
    Ray ray;
    const bool shadow = WireType(bits.get(field::type)) == WireType::shadow_ray;
    get_place(bits, ray);
    if (shadow) {
        const double way = get_word(bits, formats_.reach, formats_.word_bits);
        ray.reach = way == formats_.reach.most() ? std::numeric_limits<double>::infinity() : way;
    } else {
        ray.weight = get_word(bits, formats_.unit, formats_.word_bits);
    }
    const auto leaves = std::uint32_t(bits.get(field::polygon_id));
    ray.leaves = leaves == no_polygon_code ? no_polygon : leaves;
    if (!shadow) ray.generation = std::uint8_t(bits.get(field::generation));
    ray.outside = bits.get(1) != 0;
    ray.fresh = false;
    ray.home_x = std::uint16_t(bits.get(x_bits_));
    ray.home_y = std::uint16_t(bits.get(y_bits_));
    const auto slot = std::uint32_t(bits.get(slot_bits_));
    ray.child = std::uint8_t(bits.get(field::child));
    if (shadow) {
        ray.kind = verdict_kind(precast);
    } else if (ray.generation > 0) {
        ray.kind = ray.child == 0 ? RayKind::reflected : RayKind::refracted;
    }
    ray.slot = ray.kind == RayKind::primary ? own_ray_code(slot) : slot;
    return ray;
}

WireBits Wire::pack(const Answer& answer) const {
    constexpr WireType types[] = {WireType::intensity, WireType::lit, WireType::blocked, WireType::postponed};
    WireBits bits;
    bits.put(std::uint64_t(types[std::size_t(answer.kind)]), field::type);
    if (answer.kind == Answer::Kind::intensity) {
        for (int channel = 0; channel < 3; ++channel)
            put_word(bits, "colour", answer.colour[channel], formats_.intensity, formats_.word_bits);
    }
    put_address(bits, answer.home_x, answer.home_y, answer.slot, answer.ray_kind == RayKind::primary,
                answer.child);
    return bits;
}

Answer Wire::unpack_answer(WireBits bits, bool precast) const {
    Answer answer;
    const auto type = WireType(bits.get(field::type));
    answer.kind = Answer::Kind(int(type) - int(WireType::intensity));
    const bool verdict = type == WireType::lit || type == WireType::blocked;
    if (type == WireType::intensity) {
        for (int channel = 0; channel < 3; ++channel)
            answer.colour[channel] = get_word(bits, formats_.intensity, formats_.word_bits);
    }
    answer.home_x = std::uint16_t(bits.get(x_bits_));
    answer.home_y = std::uint16_t(bits.get(y_bits_));
    answer.slot = std::uint32_t(bits.get(slot_bits_));
    answer.child = std::uint8_t(bits.get(field::child));
    if (verdict) {
        answer.ray_kind = verdict_kind(precast);
    } else if (answer.slot > own_ray_code(std::uint32_t(own_rays_))) {
        answer.ray_kind = RayKind::primary;
        answer.slot = own_ray_code(answer.slot);
    } else {
        answer.ray_kind = answer.child == 0 ? RayKind::reflected : RayKind::refracted;
    }
    return answer;
}

std::vector<WireField> Wire::layout(WireType type) const {
    const int word = formats_.word_bits;
    const std::vector<WireField> address = {
        {"home x", x_bits_, "column of the cell that the answer goes to"},
        {"home y", y_bits_, "its row"},
        {"slot", slot_bits_, "slot or voxel there; of a primary ray all ones less the own ray's number"},
        {"child", field::child,
         "of the slot: 0 reflected, 1 refracted; of a "
         "verdict: the source"}};
    std::vector<WireField> all = {{"type", field::type, std::to_string(int(type))}};
    if (type == WireType::ray || type == WireType::shadow_ray) {
        const std::string mantissa = "mantissa, exponent " + std::to_string(Formats::exponent_bits);
        const int reciprocal = word + Formats::exponent_bits;
        const std::vector<WireField> place = {{"x", word, "unit"},
                                              {"y", word, "unit"},
                                              {"z", wire_depth_bits(formats_), "depth"},
                                              {"dx", word, "unit"},
                                              {"dy", word, "unit"},
                                              {"dz", word, "unit"},
                                              {"1/dx", reciprocal, mantissa},
                                              {"1/dy", reciprocal, mantissa}};
        all.insert(all.end(), place.begin(), place.end());
        all.push_back(type == WireType::ray ? WireField{"weight", word, "unit"}
                                            : WireField{"reach", word, "reach; its largest value: infinite"});
        all.push_back({"polygon left", field::polygon_id, "all ones: none"});
        if (type == WireType::ray) all.push_back({"generation", field::generation, "0: primary"});
        all.push_back({"outside", 1, "on its way to the border"});
    } else if (type == WireType::intensity) {
        for (const char* channel : {"red", "green", "blue"}) all.push_back({channel, word, "intensity"});
    }
    all.insert(all.end(), address.begin(), address.end());
    return all;
}

}  // namespace raycell
