// Trapezes tile the polygon that they were cut from.
#include "model/trapeze.hpp"

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

bool inside(const Trapeze& t, const dvec2& uv) {
    for (int i = 0; i < t.edge_count; ++i) {
        if (t.edges[std::size_t(i)].at(uv) < 0) return false;
    }
    return true;
}

/// Points of the polygon's plane are in a trapeze exactly when they are in the polygon, and the areas add up.
void expect_tiled(const Polygon& polygon, Random& random) {
    const std::vector<Trapeze> trapezes = precompute(polygon, exact_arithmetic());
    double area = 0;
    dvec2 low(1e300), high(-1e300);
    const auto outline = shapes::projected(polygon.vertices, polygon.drop);
    for (const dvec2& p : outline) low = glm::min(low, p), high = glm::max(high, p);
    for (const Trapeze& t : trapezes) {
        ASSERT_GE(t.corner_count, 3);
        ASSERT_LE(t.corner_count, 4);
        EXPECT_EQ(t.polygon, polygon.id);
        EXPECT_EQ(t.object, polygon.object);
        EXPECT_EQ(t.drop, polygon.drop);
        EXPECT_LE(t.top, t.bottom);
        std::vector<dvec3> corners(t.corners.begin(), t.corners.begin() + t.corner_count);
        area += shapes::area_of(corners);
        for (const dvec3& p : corners) {
            EXPECT_NEAR(glm::dot(t.plane.n, p), t.plane.c, 1e-9);
            EXPECT_GE(p.y, t.top);
            EXPECT_LE(p.y, t.bottom);
            // Every corner lies on or inside every edge.
            for (int i = 0; i < t.edge_count; ++i)
                EXPECT_GT(t.edges[std::size_t(i)].at(project(p, t.drop)), -1e-8);
        }
    }
    EXPECT_NEAR(area, shapes::area_of(polygon.vertices),
                1e-7 * std::max(1.0, shapes::area_of(polygon.vertices)));
    for (int i = 0; i < 200; ++i) {
        const dvec2 margin = 0.1 * (high - low);
        const dvec2 p{random.uniform(low.x - margin.x, high.x + margin.x),
                      random.uniform(low.y - margin.y, high.y + margin.y)};
        const shapes::Place place = shapes::place_of(outline, p);
        if (place.distance < 1e-6) continue;
        int holders = 0;
        for (const Trapeze& t : trapezes) holders += inside(t, p);
        // Two trapezes may share a point of the cut between them, at most.
        if (place.inside) {
            EXPECT_GE(holders, 1) << "inside at " << p.x << ", " << p.y;
            EXPECT_LE(holders, 2);
        } else {
            EXPECT_EQ(holders, 0) << "outside at " << p.x << ", " << p.y;
        }
    }
}

TEST(Trapezes, TileAnyPolygonInAnyAttitude) {
    for (const std::uint64_t seed : property::seeds(1, 600)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::attitude(random, int(seed % 6));
        const int corners = random.chance(0.2) ? 150 : random.whole(3, 40);
        const auto outline = shapes::star(random, corners, std::pow(10, random.uniform(-1, 1.3)));
        expect_tiled(make_polygon(3, 4, shapes::lift(outline, axes, {20, 20, 25})), random);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(Trapezes, TileCombsWhoseCornersLineUpInRows) {
    for (const std::uint64_t seed : property::seeds(2000, 120)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        shapes::Axes axes = shapes::attitude(random, int(seed % 6));
        if (random.chance(0.5)) {  // along the axes exactly
            const dvec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            const int first = random.whole(0, 2);
            const int second = (first + random.whole(1, 2)) % 3;
            axes = {unit[first], (random.chance(0.5) ? 1.0 : -1.0) * unit[second],
                    glm::cross(unit[first], unit[second])};
        }
        expect_tiled(
            make_polygon(3, 4, shapes::lift(shapes::comb(random.whole(2, 30), 7.5), axes, {16, 16, 16})),
            random);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(Trapezes, OfAPolygonWithItsVerticesTurnedRoundCoverTheSame) {
    for (const std::uint64_t seed : property::seeds(3000, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        auto outline = shapes::lift(shapes::star(random, 12, 8), shapes::turned(random), dvec3(10));
        const std::size_t count = precompute(make_polygon(0, 0, outline), exact_arithmetic()).size();
        std::rotate(outline.begin(), outline.begin() + random.whole(1, 11), outline.end());
        EXPECT_EQ(precompute(make_polygon(0, 0, outline), exact_arithmetic()).size(), count);
    }
}

TEST(Trapezes, ARectangleIsOneAndATriangleAtMostTwo) {
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 1, 5}, {4, 3, 6}, {1, 3, 6}}), exact_arithmetic())
                  .size(),
              1u);
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 2, 5}, {2, 4, 6}}), exact_arithmetic()).size(),
              2u);
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 1, 5}, {2, 4, 6}}), exact_arithmetic()).size(),
              1u);
    // Corners on straight sides cost cuts, no area.
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {2, 1, 5}, {4, 1, 5}, {4, 3, 5}, {1, 3, 5}}),
                         exact_arithmetic())
                  .size(),
              1u);
}

}  // namespace
}  // namespace raycell
