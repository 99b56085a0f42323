// Property: what faces the viewer is seen, at every word length and every rung.
#include "../facing_quad.hpp"
#include "model/geometry/tessellate.hpp"
#include "model/geometry/visible_extent.hpp"
#include "model/machine/untimed.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

/// Pixels well inside the quad must show it, and pixels well outside must not. Near its border, within `room`
/// cells, either is allowed: an outline in short words is inexact, and the lower rungs hit a voxel anywhere
/// in its cell.
void expect_seen(const facing::Quad& quad, const Frame& frame, const Picture& picture, double room) {
    int inside = 0;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            const double depth = facing::depth_inside(quad, frame, x, y);
            if (std::abs(depth) < room) continue;
            inside += depth > 0;
            ASSERT_EQ(picture.at(x, y).polygon == no_polygon, depth < 0)
                << "pixel (" << x << ", " << y << "), " << depth << " cells inside";
        }
    }
    EXPECT_GT(inside, 0);
}

TEST(FacingQuads, AreSeenAtEveryWordLengthAndRung) {
    for (const std::uint64_t seed : property::seeds(1, 8)) {
        SCOPED_TRACE(property::rerun(seed));
        for (int word_bits = 8; word_bits <= 33; ++word_bits) {  // 33: exact
            for (const HitTest hit :
                 {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask, HitTest::edge}) {
                Random random(seed);
                const facing::Quad quad(random);
                PictureSettings settings;
                settings.width = random.whole(14, 40);
                settings.height = random.whole(14, 40);
                settings.depth_levels = random.chance(0.3) ? 1 : 1 << random.whole(1, 12);
                settings.viewer = random.chance(0.3) ? ViewerMode::infinity : ViewerMode::scene;
                settings.exterior = ExteriorMode::none;
                settings.hit = hit;
                settings.numbers.word_bits = std::min(word_bits, 32);
                settings.numbers.arithmetic = word_bits > 32 ? Numbers::exact : Numbers::fixed;
                SCOPED_TRACE(std::to_string(word_bits) + " bits, rung " + std::to_string(int(hit)));
                const Frame frame = place_frame(quad.scene, settings);
                const CellScene scene = place_scene(quad.scene, frame, settings);
                UntimedMachine machine(scene, settings, nullptr);
                expect_seen(quad, frame, machine.render(), 2.0);
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(FacingQuads, LieHalfACellFromTheCubesFaces) {
    for (const std::uint64_t seed : property::seeds(100, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const facing::Quad quad(random);
        PictureSettings settings;
        settings.height = random.whole(1, 60);
        settings.width = random.whole(settings.height, 60);  // wide enough to see all of the quad
        settings.viewer = random.chance(0.3) ? ViewerMode::infinity : ViewerMode::scene;
        const Frame frame = place_frame(quad.scene, settings);
        EXPECT_GE(frame.depth, 1);
        for (const dvec3& corner : quad.corners) {
            EXPECT_GE(frame.to_cells(corner).z, 0.5 - 1e-6);
            EXPECT_LE(frame.to_cells(corner).z, frame.depth - 0.5 + 1e-6);
        }
    }
}

/// Depth range of random points of a primitive that lie inside the field of view.
Extent sampled(const Primitive& primitive, const ViewAxes& axes, const std::vector<HalfSpace>& field,
               Random& random) {
    Extent extent;
    for (int i = 0; i < 20000; ++i) {
        dvec3 p;
        if (const auto* sphere = std::get_if<SpherePrimitive>(&primitive.shape)) {
            p = sphere->centre + sphere->radius * hand_made::random_direction(random.engine());
        } else {
            const auto& cone = std::get<ConePrimitive>(primitive.shape);
            const dvec3 axis = glm::normalize(cone.apex - cone.base);
            dvec3 way = hand_made::random_direction(random.engine());
            way = glm::normalize(way - glm::dot(way, axis) * axis);
            const double s = random.uniform(0, 1);
            p = cone.base + s * (cone.apex - cone.base) +
                (cone.base_radius + s * (cone.apex_radius - cone.base_radius)) * way;
        }
        p = axes.point(p);
        const bool seen = std::all_of(field.begin(), field.end(),
                                      [&](const HalfSpace& side) { return glm::dot(side.n, p) >= side.c; });
        if (seen) extent.add(p.z);
    }
    return extent;
}

TEST(VisibleExtents, OfSpheresAndConesHoldWhatIsSeenAndLittleMore) {
    int seen = 0;
    for (const std::uint64_t seed : property::seeds(500, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        ViewAxes axes;
        axes.from = hand_made::random_point(random.engine(), -3, 3);
        const double tangent = random.uniform(0.1, 1.5);
        const std::vector<HalfSpace> field = {{{0, 0, 1}, random.uniform(0.1, 2)},
                                              {{1, 0, tangent}, 0},
                                              {{-1, 0, tangent}, 0},
                                              {{0, 1, tangent}, 0},
                                              {{0, -1, tangent}, 0}};
        const dvec3 centre = axes.from + hand_made::random_point(random.engine(), -4, 8);
        const double radius = std::pow(10.0, random.uniform(-1, 1));
        const Primitive sphere{0, SpherePrimitive{centre, radius, false}};
        const Primitive cone{0,
                             ConePrimitive{centre, radius, centre + dvec3(0.3, random.uniform(0.1, 4), 0.8),
                                           random.chance(0.5) ? 0.0 : 0.4 * radius, false}};
        for (const Primitive& primitive : {sphere, cone}) {
            const Extent points = sampled(primitive, axes, field, random);
            const Extent found = visible_extent(primitive, axes, field);
            if (points.near > points.far) continue;
            ++seen;
            EXPECT_LE(found.near, points.near + 1e-9);
            EXPECT_GE(found.far, points.far - 1e-9);
            // The random points are sparse where little of the surface is visible.
            EXPECT_GE(found.near, points.near - 0.3 * radius - 0.05);
            EXPECT_LE(found.far, points.far + 0.3 * radius + 0.05);
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(seen, 100);
    }
}

TEST(VisibleExtents, OfAWholeSphereAreItsPolesWhateverItsSize) {
    const ViewAxes axes;
    const std::vector<HalfSpace> field = {{{0, 0, 1}, 0.1}, {{1, 0, 1}, 0}, {{-1, 0, 1}, 0}};
    for (const double radius : {1e-6, 1.0, 30.0}) {
        const Extent extent = visible_extent({0, SpherePrimitive{{0, 5, 100}, radius, false}}, axes, field);
        EXPECT_DOUBLE_EQ(extent.near, 100 - radius);
        EXPECT_DOUBLE_EQ(extent.far, 100 + radius);
    }
    EXPECT_GT(visible_extent({0, SpherePrimitive{{0, 0, -5}, 1, false}}, axes, field).near, 1e300)
        << "behind";
}

}  // namespace
}  // namespace raycell
