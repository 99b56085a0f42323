// Where the cube stands in the scene, and the primary rays.
#include "model/geometry/placement.hpp"

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

Scene scene_of(Random& random) {
    Scene scene;
    View view;
    view.from = hand_made::random_point(random.engine(), -20, 20);
    view.at = view.from + random.uniform(5, 30) * hand_made::random_direction(random.engine());
    view.up = hand_made::random_direction(random.engine());
    view.angle = random.uniform(5, 120);
    view.hither = random.chance(0.5) ? 0 : random.uniform(0.01, 2);
    scene.view = view;
    scene.materials.push_back(Material());
    for (int i = 0; i < 12; ++i) {
        const dvec3 centre = view.at + hand_made::random_point(random.engine(), -4, 4);
        if (i % 3 == 0) {
            scene.primitives.push_back({0, SpherePrimitive{centre, random.uniform(0.05, 2), false}});
        } else if (i % 3 == 1) {
            scene.primitives.push_back(
                {0, ConePrimitive{centre, random.uniform(0.05, 2), centre + dvec3(0.3, 1, 0.2), 0.1, false}});
        } else {
            scene.primitives.push_back(
                {0, PolygonPrimitive{{centre, centre + dvec3(1, 0.2, 0), centre + dvec3(0, 1, 0.7)}, {}}});
        }
    }
    return scene;
}

PictureSettings settings_of(Random& random) {
    PictureSettings settings;
    settings.width = random.whole(1, 60);
    settings.height = random.whole(1, 60);
    return settings;
}

TEST(Placement, CentresOfTheFirstAndLastRowSpanTheAngleExactly) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = scene_of(random);
        PictureSettings settings = settings_of(random);
        settings.height = random.whole(2, 80);
        const Frame frame = place_frame(scene, settings);
        const double x = 0.5 * settings.width;
        const dvec3 first = frame.primary_ray(x, 0.5).direction;
        const dvec3 last = frame.primary_ray(x, settings.height - 0.5).direction;
        EXPECT_NEAR(std::acos(std::clamp(glm::dot(first, last), -1.0, 1.0)) * 180 / hand_made::pi,
                    scene.view->angle, 1e-6);
        EXPECT_LT(first.y, last.y);  // row 0 on top
        // The view axis goes straight through the middle.
        const dvec3 middle = frame.primary_ray(x, 0.5 * settings.height).direction;
        EXPECT_LT(glm::length(middle - dvec3(0, 0, 1)), 1e-12);
    }
}

TEST(Placement, ToCellsIsASimilarity) {
    for (const std::uint64_t seed : property::seeds(100, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = scene_of(random);
        const Frame frame = place_frame(scene, settings_of(random));
        const dvec3 a = hand_made::random_point(random.engine(), -10, 10);
        const dvec3 b = hand_made::random_point(random.engine(), -10, 10);
        const double cells = glm::length(frame.to_cells(a) - frame.to_cells(b));
        EXPECT_NEAR(cells * frame.cell_width, glm::length(a - b), 1e-9);
        EXPECT_NEAR(glm::dot(frame.right, frame.down), 0, 1e-12);
        // Not mirrored: x right, y down, z away.
        EXPECT_NEAR(glm::dot(glm::cross(frame.right, frame.down), frame.forward), 1, 1e-12);
        EXPECT_LT(glm::dot(frame.down, scene.view->up), 0);
        EXPECT_LT(glm::length(frame.to_cells(frame.corner)), 1e-9);
        EXPECT_LT(glm::length(frame.to_cells(scene.view->from) - frame.eye),
                  1e-6 * (1 + glm::length(frame.eye)));
    }
}

TEST(Placement, PrimaryRaysPassThroughTheEyeAndTheirPixelCentre) {
    for (const std::uint64_t seed : property::seeds(200, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Frame frame = place_frame(scene_of(random), settings_of(random));
        for (int i = 0; i < 20; ++i) {
            const double x = random.whole(0, frame.width - 1) + 0.5;
            const double y = random.whole(0, frame.height - 1) + 0.5;
            const auto ray = frame.primary_ray(x, y);
            EXPECT_EQ(ray.origin, dvec3(x, y, 0));
            EXPECT_NEAR(glm::length(ray.direction), 1, 1e-14);
            const dvec3 back = frame.eye - ray.origin;
            EXPECT_LT(glm::length(back - glm::dot(back, ray.direction) * ray.direction),
                      1e-9 * glm::length(back));
        }
    }
}

TEST(Placement, WhatTheViewerSeesLiesBetweenTheScreenAndTheBack) {
    int tried = 0;
    for (const std::uint64_t seed : property::seeds(300, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = scene_of(random);
        const PictureSettings settings = settings_of(random);
        const Frame frame = place_frame(scene, settings);
        const CellScene placed = place_scene(scene, frame, settings);
        const double hither = (scene.view->hither) / frame.cell_width + frame.eye.z;  // its z in cells
        for (const Polygon& polygon : placed.polygons) {
            for (int i = 0; i < 10; ++i) {  // points of the polygon
                double a = random.uniform(0, 1), b = random.uniform(0, 1);
                if (a + b > 1) a = 1 - a, b = 1 - b;
                const auto& v = polygon.vertices;
                const dvec3 p = v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0]);
                if (p.z <= frame.eye.z || p.z <= hither) continue;
                const double scale = -frame.eye.z / (p.z - frame.eye.z);
                const dvec2 screen = dvec2(frame.eye) + scale * dvec2(p - frame.eye);
                if (screen.x < 0 || screen.y < 0 || screen.x > frame.width || screen.y > frame.height)
                    continue;
                ++tried;
                EXPECT_GT(p.z, 0);
                EXPECT_LT(p.z, frame.depth);
            }
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(tried, 10000);
    }
}

TEST(Placement, BeyondTellsOfEachFaceWhetherAnythingPasses) {
    for (const std::uint64_t seed : property::seeds(400, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = scene_of(random);
        const PictureSettings settings = settings_of(random);
        const Frame frame = place_frame(scene, settings);
        const CellScene placed = place_scene(scene, frame, settings);
        dvec3 low(1e300), high(-1e300);
        for (const Polygon& polygon : placed.polygons) {
            for (const dvec3& p : polygon.vertices) low = glm::min(low, p), high = glm::max(high, p);
        }
        EXPECT_EQ(placed.beyond[face_left], low.x < -1e-6);
        EXPECT_EQ(placed.beyond[face_right], high.x > frame.width + 1e-6);
        EXPECT_EQ(placed.beyond[face_top], low.y < -1e-6);
        EXPECT_EQ(placed.beyond[face_bottom], high.y > frame.height + 1e-6);
        EXPECT_EQ(placed.beyond[face_front], low.z < -1e-6);
        EXPECT_EQ(placed.beyond[face_back], high.z > frame.depth + 1e-6);
    }
}

TEST(Placement, ViewerAtInfinitySeesAlongZWithTheScaleOfItsTarget) {
    for (const std::uint64_t seed : property::seeds(500, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = scene_of(random);
        PictureSettings settings = settings_of(random);
        settings.height = random.whole(2, 60);
        settings.viewer = ViewerMode::infinity;
        const Frame frame = place_frame(scene, settings);
        const auto ray = frame.primary_ray(0.5, 0.5);
        EXPECT_EQ(ray.direction, dvec3(0, 0, 1));
        EXPECT_EQ(ray.origin, dvec3(0.5, 0.5, 0));
        const double tall = 2 * std::tan(scene.view->angle * hand_made::pi / 360) *
                            glm::length(scene.view->at - scene.view->from);
        EXPECT_NEAR(frame.cell_width * (settings.height - 1), tall, 1e-9 * tall);
        const dvec3 target = frame.to_cells(scene.view->at);
        EXPECT_NEAR(target.x, 0.5 * settings.width, 1e-6);
        EXPECT_NEAR(target.y, 0.5 * settings.height, 1e-6);
        // The depth of the array holds all of the scene that is in front of it.
        const CellScene placed = place_scene(scene, frame, settings);
        for (const Polygon& polygon : placed.polygons) {
            for (const dvec3& p : polygon.vertices) {
                if (p.x < 0 || p.y < 0 || p.x > frame.width || p.y > frame.height) continue;
                EXPECT_GT(p.z, 0);
                EXPECT_LT(p.z, frame.depth);
            }
        }
    }
}

TEST(Placement, AnEmptySceneStillGetsACube) {
    Scene scene;
    scene.view = View();
    PictureSettings settings;
    settings.width = settings.height = 1;
    const Frame frame = place_frame(scene, settings);
    EXPECT_GT(frame.cell_width, 0);
    EXPECT_GE(frame.depth, 1);
    scene.view.reset();
    EXPECT_THROW(place_frame(scene, settings), std::invalid_argument);
}

TEST(Placement, SourcesWithoutColourShareTheirIntensityByTheRootOfTheirNumber) {
    Scene scene;
    scene.view = View();
    scene.sources = {{dvec3(1), std::nullopt}, {dvec3(2), dvec3(0.25)}, {dvec3(3), std::nullopt}};
    const PictureSettings settings;
    const CellScene placed = place_scene(scene, place_frame(scene, settings), settings);
    EXPECT_EQ(placed.sources[0].intensity, dvec3(1 / std::sqrt(3.0)));
    EXPECT_EQ(placed.sources[1].intensity, dvec3(0.25));
}

}  // namespace
}  // namespace raycell
