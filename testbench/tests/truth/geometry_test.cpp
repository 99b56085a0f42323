// Which polygon a ray hits: concave outlines, no cracks, Embree against a search through all polygons.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "model/truth/clip.hpp"
#include "model/truth/truth.hpp"
#include "testbench/tests/truth/hand_made.hpp"

namespace raycell {
namespace {

using namespace hand_made;

constexpr std::uint64_t seed = 20240607;

/// Winding number from the angles that the edges subtend: independent of the renderer's crossing number.
bool winds_round(const std::vector<dvec2>& outline, const dvec2& p) {
    double turn = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const dvec2 a = outline[i] - p;
        const dvec2 b = outline[(i + 1) % outline.size()] - p;
        turn += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    }
    return std::abs(turn) > pi;
}

/// A gear or star with `teeth` teeth of four vertices each, irregular but never crossing itself.
std::vector<dvec2> gear(int teeth, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<dvec2> outline;
    for (int i = 0; i < 4 * teeth; ++i) {
        const double angle = 2 * pi * (i + 0.5 * uniform(random)) / (4 * teeth);
        const double radius = (i % 4 < 2 ? 10 : 4) + 2 * uniform(random);
        outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return outline;
}

TEST(TruthGeometry, AConcavePolygonIsHitExactlyWhereItsOutlineWindsRoundThePoint) {
    std::mt19937_64 random(seed);
    for (int round = 0; round < 20; ++round) {
        const std::vector<dvec2> outline = gear(3 + 2 * round, random);  // up to 164 vertices
        const dvec3 axis = random_direction(random);
        const dvec3 u =
            glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
        const dvec3 v = glm::cross(axis, u);
        const dvec3 centre = random_point(random, -50, 50);
        const auto in_space = [&](const dvec2& p) { return centre + p.x * u + p.y * v; };
        CellScene scene = cube(1, 1, 1);
        std::vector<dvec3> vertices;
        for (const dvec2& p : outline) vertices.push_back(in_space(p));
        add_polygon(scene, add_object(scene, matt(1)), vertices);
        const TruthRenderer truth(scene);
        std::uniform_real_distribution<double> place(-13, 13);
        for (int i = 0; i < 1000; ++i) {
            const dvec2 p{place(random), place(random)};
            dvec3 way = random_direction(random);
            if (std::abs(glm::dot(way, axis)) < 0.05) way = axis;
            const auto hit = truth.intersect(in_space(p) - 30.0 * way, way, no_polygon);
            ASSERT_EQ(hit.has_value(), winds_round(outline, p))
                << "seed " << seed << ", round " << round << ", " << i;
            if (hit) {
                ASSERT_NEAR(hit->t, 30, 1e-9);
            }
        }
    }
}

/// A closed, dented ball far from the origin, where single precision is coarse.
CellScene dented_ball(const dvec3& centre, int slices) {
    CellScene scene = cube(1, 1, 1);
    add_ball(scene, add_object(scene, matt(1)), centre, slices, slices / 2, [](const dvec3& way) {
        return 20 + 6 * std::sin(7 * way.x) * std::cos(5 * way.y) + 3 * std::sin(11 * way.z);
    });
    return scene;
}

TEST(TruthGeometry, NoRayLeavesAClosedSurfaceThroughItsEdgesOrVertices) {
    std::mt19937_64 random(seed);
    for (const dvec3& centre : {dvec3(0), dvec3(64, 64, 500), dvec3(3e4, -2e4, 5e4)}) {
        const CellScene scene = dented_ball(centre, 40);
        const TruthRenderer truth(scene);
        for (int i = 0; i < 60000; ++i) {
            const dvec3 from = centre + 5.0 * random_direction(random);
            const Polygon& polygon = scene.polygons[random() % scene.polygons.size()];
            const std::size_t corner = random() % 3;
            const dvec3& a = polygon.vertices[corner];
            const dvec3& b = polygon.vertices[(corner + 1) % 3];
            dvec3 target = a;  // a third each: at a vertex, at an edge, anywhere
            if (i % 3 == 1) target = a + (b - a) * std::generate_canonical<double, 53>(random);
            if (i % 3 == 2) target = from + random_direction(random);
            const dvec3 way = glm::normalize(target - from);
            ASSERT_TRUE(truth.intersect(from, way, no_polygon)) << "seed " << seed << ", ray " << i;
            ASSERT_TRUE(truth.occluded(from, way, no_polygon, 1000)) << "seed " << seed << ", ray " << i;
        }
    }
}

TEST(TruthGeometry, NoRayFromFarOutsideEntersAClosedSurfaceUnseen) {
    std::mt19937_64 random(seed);
    const dvec3 centre(200, 300, 400);
    const CellScene scene = dented_ball(centre, 40);
    const TruthRenderer truth(scene);
    for (int i = 0; i < 60000; ++i) {
        const Polygon& polygon = scene.polygons[random() % scene.polygons.size()];
        const dvec3& vertex = polygon.vertices[random() % 3];
        const dvec3 way = glm::normalize(centre - vertex);  // through the vertex towards the centre
        const double distance = std::pow(10.0, double(i % 7));
        const auto hit = truth.intersect(vertex - distance * way, way, no_polygon);
        ASSERT_TRUE(hit) << "seed " << seed << ", ray " << i;
        ASSERT_LT(glm::distance(hit->position, vertex), 30) << "seed " << seed << ", ray " << i;
    }
}

/// Polygons of all sizes, some concave, some equal except for the id, and two floors that reach the horizon.
CellScene litter(std::mt19937_64& random) {
    CellScene scene = cube(1, 1, 1);
    const std::uint32_t object = add_object(scene, matt(1));
    for (int i = 0; i < 600; ++i) {
        const double size = std::pow(10.0, double(i % 6) - 2);
        const dvec3 centre = random_point(random, -2000, 2000) * (i % 2 ? 1.0 : 0.02);
        const dvec3 u = size * random_direction(random);
        const dvec3 v = size * random_direction(random);
        const double dent = i % 3 == 0 ? -0.3 : 1;  // the last of four corners is pushed in
        add_polygon(scene, object, {centre, centre + u, centre + dent * (u + v), centre + v});
        if (i % 5 == 0) add_polygon(scene, object, scene.polygons.back().vertices);
    }
    for (const double y : {1500.0, 1900.0})
        add_rectangle(scene, object, {-1e8, y, -1e8}, {2e8, 0, 0}, {0, 0, 2e8});
    return scene;
}

std::optional<std::pair<double, std::uint32_t>> by_trying_all(const CellScene& scene, const dvec3& from,
                                                              const dvec3& way, std::uint32_t exclude) {
    const ProbeRay ray(from, way);
    std::optional<std::pair<double, std::uint32_t>> best;
    for (const Polygon& polygon : scene.polygons) {
        if (polygon.id == exclude) continue;
        const auto t = ray.meet(polygon, nearest_hit, std::numeric_limits<double>::infinity());
        if (t && (!best || std::make_pair(*t, polygon.id) < *best)) best = std::make_pair(*t, polygon.id);
    }
    return best;
}

TEST(TruthGeometry, EmbreeFindsTheHitThatTryingEveryPolygonFinds) {
    std::mt19937_64 random(seed);
    const CellScene scene = litter(random);
    const TruthRenderer truth(scene);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Polygon& aim = scene.polygons[random() % scene.polygons.size()];
        const Polygon& start = scene.polygons[random() % scene.polygons.size()];
        dvec3 from = random_point(random, -3000, 3000);
        std::uint32_t exclude = no_polygon;
        if (i % 3 == 1) from *= 1e4;
        if (i % 3 == 2) {  // like a secondary ray, which can't hit the polygon that it leaves
            from = 0.5 * (start.vertices[0] + start.vertices[1]);
            exclude = start.id;
        }
        const dvec3 target =
            glm::mix(aim.vertices[1], aim.vertices[3], 0.5 * std::generate_canonical<double, 53>(random));
        if (target == from) continue;
        const dvec3 way = glm::normalize(target - from);
        const auto expected = by_trying_all(scene, from, way, exclude);
        const auto hit = truth.intersect(from, way, exclude);
        ASSERT_EQ(hit.has_value(), expected.has_value()) << "seed " << seed << ", ray " << i;
        ASSERT_EQ(truth.occluded(from, way, exclude, 1e9), expected.has_value());
        if (!hit) continue;
        ++hits;
        ASSERT_EQ(hit->t, expected->first) << "seed " << seed << ", ray " << i;
        ASSERT_EQ(hit->polygon, expected->second) << "seed " << seed << ", ray " << i;
        ASSERT_EQ(scene.polygons[hit->index].id, hit->polygon);
    }
    EXPECT_GT(hits, 5000);
}

TEST(TruthGeometry, AFloorToTheHorizonLeavesThePrecisionOfTheOthersAlone) {
    std::mt19937_64 random(seed);
    CellScene scene = dented_ball({0, 0, 0}, 400);
    const dvec3 low{-1e12, 40, -1e12};
    add_rectangle(scene, 0, low, {2e12, 0, 0}, {0, 0, 2e12});
    const TruthRenderer truth(scene);
    // Testing all 160,000 polygons for each ray, as a poor tree would, takes minutes.
    for (int i = 0; i < 100000; ++i) {
        const dvec3 floor(1e6 * random_direction(random).x, 40, 1e6 * random_direction(random).z);
        const dvec3 way = glm::normalize(random_point(random, -5, 5) - floor);
        const auto hit = truth.intersect(floor, way, scene.polygons.back().id);
        ASSERT_TRUE(hit) << "seed " << seed << ", ray " << i;
        ASSERT_LT(glm::length(hit->position), 31) << "seed " << seed << ", ray " << i;
    }
}

TEST(TruthGeometry, ThePolygonThatIsLeftIsNotHitAgainButTheOneBehindItIs) {
    CellScene scene = cube(4, 4, 10);
    const std::uint32_t object = add_object(scene, matt(1));
    add_rectangle(scene, object, {0, 0, 2}, {4, 0, 0}, {0, 4, 0});
    add_rectangle(scene, object, {0, 0, 7}, {4, 0, 0}, {0, 4, 0});
    const TruthRenderer truth(scene);
    const auto hit = truth.intersect({1, 1, 0}, {0, 0, 1}, 0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->polygon, 1u);
    EXPECT_EQ(hit->t, 7);
    EXPECT_FALSE(truth.intersect({1, 1, 7}, {0, 0, 1}, 1));
    EXPECT_FALSE(truth.occluded({1, 1, 2}, {0, 0, 1}, 0, 4.9));
    EXPECT_TRUE(truth.occluded({1, 1, 2}, {0, 0, 1}, 0, 5.1));
    EXPECT_FALSE(truth.intersect({1, 1, 0}, {0, 0, 1}, no_polygon, 1.9));
}

TEST(TruthGeometry, ASceneWithoutPolygonsIsBackgroundEverywhere) {
    CellScene scene = cube(3, 2, 1);
    scene.background = {0.1, 0.2, 0.3};
    const Picture picture = TruthRenderer(scene).render();
    for (const Pixel& pixel : picture.pixels) {
        EXPECT_EQ(pixel.colour, scene.background);
        EXPECT_EQ(pixel.polygon, no_polygon);
        EXPECT_TRUE(std::isinf(pixel.depth));
        EXPECT_EQ(pixel.normal, dvec3(0));
    }
}

TEST(TruthGeometry, ClippingKeepsIdsAndDropsWhatLiesOutsideTheCube) {
    CellScene scene = cube(8, 8, 8);
    const std::uint32_t object = add_object(scene, matt(1));
    add_rectangle(scene, object, {20, 0, 1}, {4, 0, 0}, {0, 4, 0});           // beside the cube
    add_rectangle(scene, object, {-100, -100, 5}, {200, 0, 0}, {0, 200, 0});  // through it
    add_rectangle(scene, object, {1, 1, 3}, {2, 0, 0}, {0, 2, 0});            // inside
    scene.beyond[face_left] = true;
    const CellScene clipped = clip_scene(scene);
    ASSERT_EQ(clipped.polygons.size(), 2u);
    EXPECT_EQ(clipped.polygons[0].id, 1u);
    EXPECT_EQ(clipped.polygons[1].id, 2u);
    EXPECT_NEAR(glm::length(newell(clipped.polygons[0].vertices)), 2 * 64, 1e-9);
    EXPECT_EQ(clipped.polygons[1].vertices, scene.polygons[2].vertices);
    EXPECT_FALSE(clipped.beyond[face_left]);
    const auto hit = TruthRenderer(clipped).intersect({4.5, 4.5, 0}, {0, 0, 1}, no_polygon);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->polygon, 1u);
    EXPECT_FALSE(TruthRenderer(clipped).intersect({9, 4, 0}, {0, 0, 1}, no_polygon));
}

TEST(TruthGeometry, AMalformedSceneIsRejectedByNameOfThePolygon) {
    CellScene scene = cube(1, 1, 1);
    add_rectangle(scene, add_object(scene, matt(1)), {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    CellScene broken = scene;
    broken.polygons[0].vertices[2].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(TruthRenderer{broken}, std::invalid_argument);
    broken = scene;
    broken.polygons[0].object = 1;
    EXPECT_THROW(TruthRenderer{broken}, std::invalid_argument);
    broken = scene;
    broken.sources.resize(max_sources + 1);
    EXPECT_THROW(TruthRenderer{broken}, std::invalid_argument);
    EXPECT_THROW(TruthRenderer(scene, {-1, 0}), std::invalid_argument);
    EXPECT_THROW(TruthRenderer(scene).count(1), std::invalid_argument);
}

}  // namespace
}  // namespace raycell
