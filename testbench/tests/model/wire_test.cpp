// Rays and answers packed into the bits that they are charged for.
#include "model/machine/wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../property.hpp"
#include "layout_tables.hpp"
#include "model/machine/storage_bits.hpp"
#include "model/numbers/arithmetic.hpp"

namespace raycell {
namespace {

struct Setting {
    PictureSettings picture;
    MachineSettings machine;
    ArrayExtent extent;
    Formats formats() const { return Formats(picture.numbers.word_bits, picture.numbers.rounding, extent); }
    Arithmetic arithmetic() const { return Arithmetic(picture.numbers, extent); }
    Wire wire() const { return Wire(picture, machine, formats()); }
};

Setting any_setting(property::Random& random) {
    Setting s;
    s.picture.numbers.word_bits = random.whole(8, 32);
    s.picture.width = random.whole(1, 200);
    s.picture.height = random.whole(1, 200);
    s.picture.shadows = Shadows(random.whole(0, 2));
    s.machine.ray_store = random.whole(1, 20);
    if (random.chance(0.5)) {
        s.picture.pixels_wide = s.picture.width * random.whole(1, 4);
        s.picture.pixels_high = s.picture.height * random.whole(1, 4);
        s.machine.own_rays = random.whole(1, most_own_rays);
    }
    s.extent = {s.picture.width, s.picture.height, random.uniform(1, 400), 0.25};
    return s;
}

RayKind verdict_kind(const Setting& s) {
    return s.picture.shadows == Shadows::per_hit ? RayKind::shadow
           : s.picture.shadows == Shadows::memo  ? RayKind::memo
                                                 : RayKind::precast;
}

/// A ray on its way between two cells, in the setting's words.
Ray any_ray(const Setting& s, property::Random& random) {
    const Arithmetic arithmetic = s.arithmetic();
    const Formats& f = arithmetic.formats();
    Ray ray;
    dvec3 direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (random.chance(0.2)) direction.x = 0;
    if (random.chance(0.2)) direction.y = 0;
    set_direction(ray, arithmetic.normalise(direction + dvec3(0, 0, 1e-3)), arithmetic);
    ray.position = {arithmetic.hold(f.unit, random.uniform(0, 1)), random.chance(0.3) ? 1.0 : 0.0,
                    random.chance(0.2) ? f.depth.least()
                                       : arithmetic.hold(f.depth, random.uniform(-1, 1) * s.extent.depth)};
    ray.fresh = false;
    ray.outside = random.chance(0.3);
    ray.leaves = random.chance(0.3) ? no_polygon : std::uint32_t(random.whole(0, (1 << 20) - 2));
    ray.home_x = std::uint16_t(random.whole(0, s.picture.width - 1));
    ray.home_y = std::uint16_t(random.whole(0, s.picture.height - 1));
    if (random.chance(0.5)) {
        ray.kind = verdict_kind(s);
        ray.child = std::uint8_t(random.whole(0, 63));
        ray.slot =
            std::uint32_t(random.whole(0, ray.kind == RayKind::shadow ? s.machine.ray_store - 1 : 1023));
        ray.reach = random.chance(0.2) ? std::numeric_limits<double>::infinity()
                                       : arithmetic.hold_reach(random.uniform(-0.5, 1) * f.reach.most());
        return ray;
    }
    ray.weight = arithmetic.hold(f.unit, random.uniform(0, 1));
    ray.generation = std::uint8_t(random.whole(0, 62));
    if (ray.generation == 0) {
        ray.slot = std::uint32_t(random.whole(0, own_rays_of(s.picture, s.machine) - 1));
        return ray;
    }
    ray.child = std::uint8_t(random.whole(0, 1));
    ray.kind = ray.child == 0 ? RayKind::reflected : RayKind::refracted;
    ray.slot = std::uint32_t(random.whole(0, s.machine.ray_store - 1));
    return ray;
}

void expect_equal(const Ray& a, const Ray& b) {
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.direction, b.direction);
    EXPECT_EQ(a.inverse_x, b.inverse_x);
    EXPECT_EQ(a.inverse_y, b.inverse_y);
    EXPECT_EQ(a.weight, b.weight);
    EXPECT_EQ(a.reach, b.reach);
    EXPECT_EQ(a.leaves, b.leaves);
    EXPECT_EQ(a.slot, b.slot);
    EXPECT_EQ(a.home_x, b.home_x);
    EXPECT_EQ(a.home_y, b.home_y);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.child, b.child);
    EXPECT_EQ(a.generation, b.generation);
    EXPECT_EQ(a.fresh, b.fresh);
    EXPECT_EQ(a.outside, b.outside);
}

TEST(Wire, EveryRayUnpacksToWhatWasPackedInTheBitsItIsChargedFor) {
    for (const std::uint64_t seed : property::seeds(1, 2000)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Setting s = any_setting(random);
        const Ray ray = any_ray(s, random);
        const WireBits bits = s.wire().pack(ray);
        expect_equal(s.wire().unpack_ray(bits, ray.kind == RayKind::precast), ray);
        const MessageBits charged = message_bits(s.picture, s.machine, s.formats());
        EXPECT_EQ(bits.size(), is_shadow(ray.kind) ? charged.shadow_ray : charged.ray);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Wire, EveryAnswerUnpacksToWhatWasPackedInTheBitsItIsChargedFor) {
    for (const std::uint64_t seed : property::seeds(1, 2000)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Setting s = any_setting(random);
        const Ray ray = any_ray(s, random);
        const bool shadow = is_shadow(ray.kind);
        Answer answer = answer_to(ray, shadow ? random.chance(0.5) ? Answer::Kind::lit : Answer::Kind::blocked
                                       : random.chance(0.2) ? Answer::Kind::postponed
                                                            : Answer::Kind::intensity);
        if (answer.kind == Answer::Kind::intensity) {
            for (int c = 0; c < 3; ++c)
                answer.colour[c] = s.arithmetic().hold(s.formats().intensity, random.uniform(0, 9));
        }
        const WireBits bits = s.wire().pack(answer);
        const Answer back = s.wire().unpack_answer(bits, ray.kind == RayKind::precast);
        EXPECT_EQ(back.kind, answer.kind);
        EXPECT_EQ(back.colour, answer.colour);
        EXPECT_EQ(back.slot, answer.slot);
        EXPECT_EQ(back.child, answer.child);
        EXPECT_EQ(back.home_x, answer.home_x);
        EXPECT_EQ(back.home_y, answer.home_y);
        EXPECT_EQ(back.ray_kind, answer.ray_kind);
        const MessageBits charged = message_bits(s.picture, s.machine, s.formats());
        EXPECT_EQ(bits.size(), answer.kind == Answer::Kind::intensity ? charged.intensity : charged.verdict);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Wire, TheLayoutsAddUpToTheMessagesBits) {
    for (const std::uint64_t seed : property::seeds(1, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Setting s = any_setting(random);
        const MessageBits charged = message_bits(s.picture, s.machine, s.formats());
        const auto sum = [&](WireType type) {
            int bits = 0;
            for (const WireField& field : s.wire().layout(type)) bits += field.bits;
            return bits;
        };
        EXPECT_EQ(sum(WireType::ray), charged.ray);
        EXPECT_EQ(sum(WireType::shadow_ray), charged.shadow_ray);
        EXPECT_EQ(sum(WireType::intensity), charged.intensity);
        EXPECT_EQ(sum(WireType::lit), charged.verdict);
        EXPECT_EQ(sum(WireType::postponed), charged.verdict);
    }
}

TEST(Wire, AValueWithoutACodeIsRefusedByItsFieldsName) {
    property::Random random(1);
    Setting s;
    s.picture.width = s.picture.height = 16;
    s.extent = {16, 16, 20, 0.25};
    const auto message = [&](auto change) {
        Ray ray = any_ray(s, random);
        change(ray);
        try {
            s.wire().pack(ray);
        } catch (const std::range_error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(message([](Ray&) {}), "none");
    EXPECT_NE(message([](Ray& r) { r.leaves = (1 << 20) - 1; }).find("polygon left of 20 bits"),
              std::string::npos);
    EXPECT_NE(message([](Ray& r) { r.home_x = 16; }).find("home x of 4 bits"), std::string::npos);
    EXPECT_NE(message([](Ray& r) { r.position.x = 0.1; }).find("field x of 20 bits"), std::string::npos);
    EXPECT_NE(message([](Ray& r) { r.position.z = 1e6; }).find("field z of"), std::string::npos);
    EXPECT_NE(message([](Ray& r) { r.inverse_x = 1.0 / 3; }).find("field 1/dx of 26 bits"),
              std::string::npos);
    EXPECT_NE(message([](Ray& r) {
                  r.kind = RayKind::reflected;
                  r.generation = 1;
                  r.slot = 16;
              }).find("slot of 4 bits"),
              std::string::npos);
}

TEST(Wire, BitsAreReadInTheirOrderAndPrintedFirstBitFirst) {
    WireBits bits;
    bits.put(5, 3);
    bits.put_signed(-2, 9);
    bits.put(0xfedcba9876543210, 64);
    bits.put(1, 1);
    EXPECT_EQ(bits.size(), 77);
    EXPECT_EQ(bits.hex(), "bfefedcba98765432108");
    EXPECT_EQ(bits.get(3), 5u);
    EXPECT_EQ(bits.get_signed(9), -2);
    EXPECT_EQ(bits.get(64), 0xfedcba9876543210);
    EXPECT_EQ(bits.get(1), 1u);
    EXPECT_THROW(bits.get(1), std::length_error);
}

TEST(Wire, ExactNumbersAreNoWords) {
    Setting s;
    s.picture.numbers.arithmetic = Numbers::exact;
    EXPECT_THROW(s.wire(), std::invalid_argument);
}

TEST(Wire, TheDocumentsLayoutsAreThese) {
    Setting s;
    s.picture.width = s.picture.height = 128;
    s.extent = {128, 128, 200, 0.2};
    const std::vector<std::pair<std::string, WireType>> tables = {{"## Ray", WireType::ray},
                                                                  {"## Shadow ray", WireType::shadow_ray},
                                                                  {"## Intensity", WireType::intensity},
                                                                  {"## Verdict and notice", WireType::lit}};
    for (const auto& [heading, type] : tables) {
        std::vector<std::pair<std::string, int>> fields;
        for (const WireField& field : s.wire().layout(type)) fields.emplace_back(field.name, field.bits);
        EXPECT_EQ(layout_table(heading), fields) << heading;
    }
}

}  // namespace
}  // namespace raycell
