// Radiance of a ray, against formulas: silhouettes, mirrors, glass, shadows, limits of a tree.
#include <gtest/gtest.h>

#include "model/truth/truth.hpp"
#include "testbench/tests/truth/hand_made.hpp"

namespace raycell {
namespace {

using namespace hand_made;

constexpr std::uint64_t seed = 19900601;

TEST(TruthOptics, ASphereCoversAsManyPixelsAsItsSilhouetteHasArea) {
    CellScene scene = cube(200, 200, 200);
    constexpr double radius = 80;
    add_ball(scene, add_object(scene, matt(1)), {100, 100, 100}, 256, 128,
             [](const dvec3&) { return radius; });
    const Picture picture = TruthRenderer(scene).render();
    double covered = 0;
    for (const Pixel& pixel : picture.pixels) covered += pixel.polygon != no_polygon;
    // Within 0.1 %: the area of the 256-gon is 0.01 % short, and the pixel centres in a circle of this size
    // count its area to within a few tens of 20,106.
    EXPECT_NEAR(covered / (pi * radius * radius), 1, 1e-3);
    EXPECT_NEAR(picture.at(100, 100).depth, 20, 0.02);
    EXPECT_LT(picture.at(100, 100).normal.z, -0.999);
}

/// Glowing triangles of many colours between x = -120 and x = -20, left of what the viewer sees directly.
CellScene confetti(int count) {
    std::mt19937_64 random(seed);
    CellScene scene = cube(60, 60, 60);
    scene.background = {0.25, 0.5, 0.75};
    for (int i = 0; i < count; ++i) {
        const dvec3 centre = random_point(random, 0, 60) + dvec3(-100, 0, 0);
        const dvec3 a = centre + 10.0 * random_direction(random);
        const dvec3 b = centre + 10.0 * random_direction(random);
        const dvec3 c = centre + 10.0 * random_direction(random);
        add_polygon(scene, add_object(scene, glowing(random_point(random, 0, 1))), {a, b, c});
    }
    return scene;
}

TEST(TruthOptics, AMirrorShowsWhatTheMirroredObjectsWouldShow) {
    CellScene mirrored = confetti(60);
    // The mirror is the plane x + z = 60: it maps (x, y, z) to (60 - z, y, 60 - x).
    for (Polygon& polygon : mirrored.polygons) {
        std::vector<dvec3> vertices;
        for (const dvec3& p : polygon.vertices) vertices.push_back({60 - p.z, p.y, 60 - p.x});
        polygon = make_polygon(polygon.id, polygon.object, vertices);
    }
    CellScene reflecting = confetti(60);
    add_polygon(reflecting, add_object(reflecting, mirror(1)),
                {{-5, -5, 65}, {65, -5, -5}, {65, 65, -5}, {-5, 65, 65}});
    const Picture seen = TruthRenderer(reflecting).render();
    const Picture direct = TruthRenderer(mirrored).render();
    int objects = 0;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        EXPECT_EQ(seen.pixels[i].polygon, 60u);
        EXPECT_LT(glm::distance(seen.pixels[i].colour, direct.pixels[i].colour), 1e-12) << "pixel " << i;
        objects += direct.pixels[i].polygon != no_polygon;
    }
    EXPECT_GT(objects, 1000);
    EXPECT_LT(objects, 3600);
}

/// A slab of glass between z = 10 and z = 22, and a wall behind it at z = 30, black for x < 0 and white for x
/// > 0.
CellScene slab(double ior) {
    CellScene scene = cube(1, 1, 40);
    const std::uint32_t pane = add_object(scene, glass(1, ior));
    add_rectangle(scene, pane, {-500, -500, 10}, {0, 1000, 0}, {1000, 0, 0});
    add_rectangle(scene, pane, {-500, -500, 22}, {1000, 0, 0}, {0, 1000, 0});
    add_rectangle(scene, add_object(scene, glowing(dvec3(0))), {-500, -500, 30}, {500, 0, 0}, {0, 1000, 0});
    add_rectangle(scene, add_object(scene, glowing(dvec3(1))), {0, -500, 30}, {500, 0, 0}, {0, 1000, 0});
    return scene;
}

TEST(TruthOptics, ASlabOfGlassShiftsARayAsSnellsLawSays) {
    for (const double ior : {1.1, 1.5, 2.4}) {
        const CellScene scene = slab(ior);
        ASSERT_LT(scene.polygons[0].plane.n.z, 0);  // both faces point outwards
        const TruthRenderer truth(scene);
        for (const double degrees : {0.0, 10.0, 30.0, 60.0, 80.0}) {
            const double outside = degrees * pi / 180;
            const double inside = std::asin(std::sin(outside) / ior);
            const dvec3 way{std::sin(outside), 0, std::cos(outside)};
            const double edge = edge_between(-400, 400, [&](double x) {
                return truth.radiance({x, 0, 0}, way, no_polygon, 0, 1).r > 0.5;
            });
            const double without = -30 * std::tan(outside);
            const double shift = 12 * (std::tan(outside) - std::tan(inside));
            EXPECT_NEAR(edge, without + shift, 1e-6) << ior << ", " << degrees << " degrees";
        }
    }
}

TEST(TruthOptics, BeyondTheCriticalAngleTheShareTGoesOnAsAReflection) {
    CellScene scene = cube(1, 1, 40);
    scene.background = dvec3(1);
    add_rectangle(scene, add_object(scene, glass(1, 1.5)), {-500, -500, 22}, {1000, 0, 0}, {0, 1000, 0});
    const TruthRenderer truth(scene);
    const double critical = std::asin(1 / 1.5);
    for (const double beyond : {-0.3, -1e-6, 1e-6, 0.3}) {
        TruthCounts counts;
        const double angle = critical + beyond;
        const dvec3 brought =
            truth.radiance({0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}, no_polygon, 0, 1, &counts);
        EXPECT_EQ(counts.refracted, beyond < 0 ? 1u : 0u) << beyond;
        EXPECT_EQ(counts.reflected, beyond < 0 ? 0u : 1u) << beyond;
        EXPECT_EQ(brought.r, 1.0) << beyond;
    }
}

/// A source at (0, 0, 0), a screen at z = 100, and a plate at z = 40 that covers x > 5.
CellScene plate(const Material& material) {
    CellScene scene = cube(1, 1, 100);
    add_rectangle(scene, add_object(scene, matt(1)), {-500, -500, 100}, {0, 1000, 0}, {1000, 0, 0});
    add_rectangle(scene, add_object(scene, material), {5, -500, 40}, {0, 1000, 0}, {500, 0, 0});
    scene.sources.push_back({{0, 0, 0}, dvec3(1)});
    return scene;
}

TEST(TruthOptics, AShadowsEdgeLiesWhereTheLineFromTheSourcePastTheBlockerMeetsTheWall) {
    const CellScene scene = plate(matt(1));
    const TruthRenderer truth(scene);
    const auto lit = [&](double x) {
        return truth.radiance({x, 0, 90}, {0, 0, 1}, no_polygon, 0, 1).r > 0.11;
    };
    EXPECT_TRUE(lit(0));
    EXPECT_FALSE(lit(50));
    EXPECT_NEAR(edge_between(0, 50, lit), 5 * 100 / 40.0, 1e-6);
}

TEST(TruthOptics, AShadowedPointKeepsItsAmbientLightAndALitOneFollowsTheCosine) {
    const CellScene scene = plate(matt(1));
    const TruthRenderer truth(scene);
    TruthCounts counts;
    EXPECT_NEAR(truth.radiance({50, 0, 90}, {0, 0, 1}, no_polygon, 0, 1, &counts).r, 0.1, 1e-15);
    const double cosine = 100 / std::hypot(100, 30);
    EXPECT_NEAR(truth.radiance({-30, 0, 90}, {0, 0, 1}, no_polygon, 0, 1, &counts).r, 0.1 + cosine, 1e-12);
    EXPECT_EQ(counts.shadow, 2u);
}

TEST(TruthOptics, GlassBlocksAShadowRayAsAnyOtherPolygonDoes) {
    const CellScene scene = plate(glass(1, 1));
    EXPECT_NEAR(TruthRenderer(scene).radiance({50, 0, 90}, {0, 0, 1}, no_polygon, 0, 1).r, 0.1, 1e-15);
}

TEST(TruthOptics, APolygonThroughTheSourceItselfDoesNotDarkenIt) {
    CellScene scene = plate(matt(1));
    add_rectangle(scene, 0, {-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0});
    EXPECT_GT(TruthRenderer(scene).radiance({-30, 0, 90}, {0, 0, 1}, no_polygon, 0, 1).r, 0.5);
}

TEST(TruthOptics, NoShadowRayIsSentToASourceThatTheNormalTurnsAwayFrom) {
    CellScene scene = plate(matt(1));
    scene.sources[0].position.z = 150;  // behind the wall
    TruthCounts counts;
    EXPECT_NEAR(TruthRenderer(scene).radiance({0, 0, 90}, {0, 0, 1}, no_polygon, 0, 1, &counts).r, 0.1,
                1e-15);
    EXPECT_EQ(counts.shadow, 0u);
}

/// Two mirrors face to face.
CellScene hall(double share) {
    CellScene scene = cube(1, 1, 20);
    const std::uint32_t object = add_object(scene, mirror(share));
    add_rectangle(scene, object, {-5, -5, 10}, {10, 0, 0}, {0, 10, 0});
    add_rectangle(scene, object, {-5, -5, 20}, {10, 0, 0}, {0, 10, 0});
    return scene;
}

std::uint64_t reflections(const CellScene& scene, const TruthSettings& settings, int generation,
                          double weight) {
    TruthCounts counts;
    TruthRenderer(scene, settings).radiance({0, 0, 15}, {0, 0, 1}, no_polygon, generation, weight, &counts);
    return counts.reflected;
}

TEST(TruthOptics, ATreeEndsAtTheLimitOfItsDepth) {
    const CellScene scene = hall(1);
    EXPECT_EQ(reflections(scene, {0, 0}, 0, 1), 0u);
    EXPECT_EQ(reflections(scene, {4, 0}, 0, 1), 4u);
    EXPECT_EQ(reflections(scene, {62, 1.0 / 256}, 0, 1), 62u);
    EXPECT_EQ(reflections(scene, {4, 0}, 3, 1), 1u);  // a ray that is already of the third generation
}

TEST(TruthOptics, ATreeEndsWhereARayWouldWeighLessThanTheThreshold) {
    const CellScene scene = hall(0.5);
    EXPECT_EQ(reflections(scene, {62, 1.0 / 256}, 0, 1), 8u);  // 0.5^8 is just enough
    EXPECT_EQ(reflections(scene, {62, 1.0 / 255}, 0, 1), 7u);
    EXPECT_EQ(reflections(scene, {62, 1.0 / 256}, 0, 0.25), 6u);
}

TEST(TruthOptics, AMaterialWhoseSpecularShareIsOnlyAHighlightSendsNoReflectedRay) {
    CellScene scene = hall(1);
    scene.objects[0].mirror = false;
    EXPECT_EQ(reflections(scene, {4, 0}, 0, 1), 0u);
}

TEST(TruthOptics, ThePictureDoesNotDependOnTheNumberOfThreads) {
    CellScene scene = confetti(40);
    add_polygon(scene, add_object(scene, mirror(0.9)),
                {{-5, -5, 65}, {65, -5, -5}, {65, 65, -5}, {-5, 65, 65}});
    scene.sources.push_back({{30, 30, -40}, dvec3(1)});
    const TruthRenderer truth(scene);
    const std::uint64_t alone = image_hash(truth.render(1));
    EXPECT_EQ(image_hash(truth.render(2)), alone);
    EXPECT_EQ(image_hash(truth.render(7)), alone);
}

TEST(TruthOptics, ProgressCountsEveryRowOnceAndItsExceptionStopsTheWork) {
    CellScene scene = cube(4, 50, 1);
    const TruthRenderer truth(scene);
    std::vector<int> seen;
    truth.render(3, [&](int done, int rows) {
        EXPECT_EQ(rows, 50);
        seen.push_back(done);
    });
    ASSERT_EQ(seen.size(), 50u);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(seen[std::size_t(i)], i + 1);
    EXPECT_THROW(truth.render(3, [](int, int) { throw std::runtime_error("enough"); }), std::runtime_error);
}

TEST(TruthOptics, CountingSpansTheFieldOfViewFromTheFirstToTheLastPixelCentre) {
    CellScene scene = cube(16, 16, 10);
    // Covers the left half of the field of view, which is [0.5, 15.5], up to exactly 8.0.
    add_rectangle(scene, add_object(scene, mirror(0.5)), {0.5 - 1e-6, 0, 5}, {7.5, 0, 0}, {0, 16, 0});
    scene.sources.push_back({{8, 8, -50}, dvec3(1)});
    scene.sources.push_back({{8, 8, 50}, dvec3(1)});
    const TruthCounts counts = TruthRenderer(scene).count(101);
    EXPECT_EQ(counts.eye, 101u * 101u);
    EXPECT_EQ(counts.eye_hits, 101u * 50u);
    EXPECT_EQ(counts.reflected, 101u * 50u);
    EXPECT_EQ(counts.shadow, 101u * 50u);  // to the source in front; the one behind casts none
    EXPECT_EQ(counts.refracted, 0u);
}

}  // namespace
}  // namespace raycell
