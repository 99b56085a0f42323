// Samples of sources that are areas: their pattern, their places, what they see of a scene.
#include "model/shading/lights.hpp"

#include <gtest/gtest.h>

#include <bitset>
#include <cmath>
#include <set>

#include "../model/shapes.hpp"
#include "../property.hpp"
#include "hand_made.hpp"
#include "model/machine/untimed.hpp"
#include "model/truth/area_light.hpp"

namespace raycell {
namespace {

using property::Random;

Source rectangle(const dvec3& corner, const dvec3& u, const dvec3& v) {
    Source source{corner, dvec3(1)};
    source.kind = SourceKind::rectangle;
    source.edge_u = u;
    source.edge_v = v;
    source.axis = -glm::normalize(glm::cross(u, v));
    return source;
}

Source sphere(const dvec3& centre, double radius) {
    Source source{centre, dvec3(1)};
    source.kind = SourceKind::sphere;
    source.radius = radius;
    return source;
}

TEST(Lights, APatternHasASampleInEveryRowAndColumn) {
    for (int n = 1; n <= int(max_sources); ++n) {
        const Lights lights({rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, n, exact_arithmetic());
        ASSERT_EQ(lights.rays.size(), std::size_t(n));
        std::set<int> rows, columns;
        for (const Light& light : lights.rays) {
            // The steps are rounded to 16 bits.
            columns.insert(int(std::lround(light.place.u / 65536.0 * n)) % n);
            rows.insert(int(std::lround(light.place.v / 65536.0 * n)) % n);
        }
        EXPECT_EQ(int(columns.size()), n);
        EXPECT_EQ(int(rows.size()), n) << n;
        EXPECT_DOUBLE_EQ(lights.share, 1.0 / n);
    }
}

TEST(Lights, ASourceWithoutExtentIsOneAndAnAreaOneForEachSample) {
    std::vector<Source> sources(3);
    sources[1] = sphere({1, 1, 1}, 2);
    const Lights lights(sources, 5, exact_arithmetic());
    ASSERT_EQ(lights.rays.size(), 7u);
    EXPECT_EQ(lights.rays[0].source, 0u);
    EXPECT_EQ(lights.rays[5].source, 1u);
    EXPECT_EQ(lights.rays[6].source, 2u);
    EXPECT_EQ(lights.bits(1), std::uint64_t(0x3e));
    EXPECT_EQ(lights.bits(6), std::uint64_t(0x40));
    EXPECT_EQ(Lights({sphere({0, 0, 0}, 1)}, 64, exact_arithmetic()).bits(0), ~std::uint64_t(0));
}

std::string error_of(std::size_t points, std::size_t areas, int samples) {
    std::vector<Source> sources(points);
    sources.insert(sources.end(), areas, sphere({0, 0, 0}, 1));
    try {
        Lights(sources, samples, exact_arithmetic());
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Lights, MoreThanAWordHasBitsAreRefusedAndTheErrorSaysHowManySamplesFit) {
    EXPECT_EQ(error_of(0, 1, 64), "");
    EXPECT_EQ(error_of(64, 0, 64), "");
    EXPECT_EQ(error_of(4, 6, 10), "");
    for (const auto& [text, part] :
         {std::pair(error_of(1, 1, 64), "--source-samples 63 or less"),
          std::pair(error_of(0, 5, 13), "12 or less"), std::pair(error_of(0, 65, 1), "fewer sources"),
          std::pair(error_of(2, 63, 2), "fewer sources"), std::pair(error_of(0, 5, 13), "65 shadow rays")})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// In words of every length a sample lies on its source, up to last bits of its mantissas and of the disc's
/// words.
TEST(Lights, ASampleLiesOnItsSource) {
    for (const std::uint64_t seed : property::seeds(1, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        NumberSettings numbers;
        numbers.word_bits = random.whole(8, 32);
        const Arithmetic arithmetic =
            random.chance(0.3) ? Arithmetic() : Arithmetic(numbers, {64, 64, 50, 0.1});
        const double size = std::exp2(random.uniform(-2, 8));
        const auto vector = [&] { return size * hand_made::random_direction(random.engine()); };
        Source source = rectangle(vector() + dvec3(20), vector(), vector());
        source.kind = SourceKind(random.whole(int(SourceKind::rectangle), int(SourceKind::sphere)));
        source.radius = size;
        source = hold(source, arithmetic);
        const SamplePlace at{std::uint16_t(random.whole(0, 65535)), std::uint16_t(random.whole(0, 65535))};
        const dvec3 from(random.uniform(0, 64), random.uniform(0, 64), random.uniform(0, 50));
        const dvec3 place = sample_of(source, at, from, arithmetic).position;
        const double word = arithmetic.exact() ? 1e-9 : std::exp2(-numbers.word_bits);
        const double room = 1e-9 + 40 * size * word + (arithmetic.exact() ? 0 : size * 1e-3);
        const dvec3 way = place - source.position;
        if (source.kind == SourceKind::sphere) {
            EXPECT_LE(glm::length(way), source.radius * (1 + 8 * word) + room);
            const double across = glm::dot(way, glm::normalize(source.position - from));
            EXPECT_NEAR(across, 0, room);
            continue;
        }
        const double u = at.u / 65536.0, v = at.v / 65536.0;
        const bool folded = source.kind == SourceKind::triangle && at.u + at.v > 65535;
        const dvec3 expected =
            folded ? (65535 - at.u) / 65536.0 * source.edge_u + (65535 - at.v) / 65536.0 * source.edge_v
                   : u * source.edge_u + v * source.edge_v;
        EXPECT_LT(glm::length(way - expected), 1e-9 + 600 * word * size);
    }
}

/// A wall that faces the viewer, a rectangle parallel to it, between them a half-plane whose edge is parallel
/// to one of the rectangle's: what is visible of the rectangle from every voxel's point.
double worst_visibility(int samples, bool along_x, Numbers arithmetic, Shadows shadows, int& seen) {
    constexpr int size = 24;
    constexpr double wall = 30, blocker = 12, lamp = 3;
    CellScene scene = shapes::empty_cube(size, size, 40, 64);
    hand_made::add_rectangle(scene, 0, {0, 0, wall}, {0, size, 0}, {size, 0, 0});
    const double edge = 11.3;
    const dvec3 across = along_x ? dvec3(0, size, 0) : dvec3(size, 0, 0);
    const dvec3 inside = along_x ? dvec3(edge, 0, 0) : dvec3(0, edge, 0);
    hand_made::add_rectangle(scene, 0, {0, 0, blocker}, across, inside);
    const dvec3 corner(7, 8, lamp);
    const dvec3 u(9, 0, 0), v(0, 7, 0);  // u x v points to the wall
    scene.sources.push_back(rectangle(corner, u, v));
    PictureSettings settings = shapes::settings_for(scene, HitTest::edge, arithmetic);
    settings.shadows = shadows;
    settings.source_samples = samples;
    settings.exterior = ExteriorMode::none;
    UntimedMachine machine(scene, settings, nullptr);
    machine.render();
    const int axis = along_x ? 0 : 1;
    double worst = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const CellStore& cell = machine.cells()[std::size_t(y * size + x)];
            for (std::size_t i = 0; i < cell.voxels.size(); ++i) {
                if (cell.voxels[i].polygon != 0) continue;
                if (shadows == Shadows::memo && cell.known[i] == 0) continue;  // it was not hit
                const dvec3 point = cell.voxels[i].point + dvec3(x, y, 0);
                // Where the line from the point past the edge meets the rectangle's plane.
                const double past = point[axis] + (edge - point[axis]) * (wall - lamp) / (wall - blocker);
                const double length = along_x ? u.x : v.y;
                const double visible = std::clamp((corner[axis] + length - past) / length, 0.0, 1.0);
                const std::uint64_t bits =
                    samples == 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << samples) - 1;
                const double found = double(std::bitset<64>(cell.lit[i] & bits).count()) / samples;
                worst = std::max(worst, std::abs(found - visible));
                seen += visible > 0 && visible < 1;
            }
        }
    }
    return worst;
}

TEST(Lights, AHalfPlaneBeforeARectangleLeavesVisibleWhatItShouldUpToASample) {
    for (const int samples : {1, 2, 3, 8, 16, 37, 64}) {
        for (const bool along_x : {true, false}) {
            for (const Numbers arithmetic : {Numbers::exact, Numbers::fixed}) {
                for (const Shadows shadows : {Shadows::precast, Shadows::memo}) {
                    int seen = 0;
                    const double worst = worst_visibility(samples, along_x, arithmetic, shadows, seen);
                    EXPECT_LE(worst, 1.0 / samples + 1e-3) << samples << " samples";
                    if (shadows == Shadows::precast) {
                        EXPECT_GT(seen, 50) << "points in the half shadow";
                    }
                }
            }
        }
    }
}

/// The machine's samples and the truth's are other points of the same source.
TEST(Lights, ManySamplesGiveWhatTheTruthsGive) {
    Material material;
    material.colour = {0.2, 0.5, 1};
    material.diffuse = 0.7;
    material.specular = 0.4;
    material.shine = 5;
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const auto vector = [&] { return 4.0 * hand_made::random_direction(random.engine()); };
        Source source = rectangle(dvec3(0, 0, -9) + vector(), vector(), vector());
        source.kind = SourceKind(random.whole(int(SourceKind::rectangle), int(SourceKind::sphere)));
        source.radius = random.uniform(0.5, 4);
        ShadePoint point = shade_point(dvec3(0), {0.3, 0.1, 1}, {0, 0.2, -1}, {0, 0, -1});
        point.direction = glm::normalize(point.direction);
        dvec3 mean(0);
        constexpr int shifts = 40;
        const Lights lights({source}, 64, exact_arithmetic());
        const dvec3 ambient = local_intensity(point, material, lights, 0);
        for (int i = 0; i < shifts; ++i) {
            point.shift = shift_of(std::uint32_t(i), 3 * i, 5);
            mean += (local_intensity(point, material, lights, ~std::uint64_t(0)) - ambient) / double(shifts);
        }
        const auto all = [](const dvec3&, double) { return true; };
        const dvec3 truth = area_light(point, material, source, 1 << 14, all);
        EXPECT_LT(glm::length(mean - truth), 2e-3 + 4e-3 * glm::length(truth));
        const dvec3 converged = area_light(point, material, source, 256, all);
        EXPECT_LT(glm::length(converged - truth), 4e-3 + 6e-3 * glm::length(truth));
    }
}

}  // namespace
}  // namespace raycell
