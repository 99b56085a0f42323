// Outlines: area, clipping, triangulation, the field of normals.
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

TEST(Polygon, NewellIsTwiceTheAreaOfAnyOutlineWhereverItLies) {
    for (const std::uint64_t seed : property::seeds(100, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::turned(random);
        const std::vector<dvec2> flat = shapes::star(random, random.whole(3, 60), 5);
        double twice = 0;  // shoelace, in the plane
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const dvec2& a = flat[i];
            const dvec2& b = flat[(i + 1) % flat.size()];
            twice += a.x * b.y - a.y * b.x;
        }
        const dvec3 far = random.uniform(0, 1e6) * hand_made::random_direction(random.engine());
        const dvec3 sum = newell(shapes::lift(flat, axes, far));
        EXPECT_NEAR(glm::dot(sum, axes.w), twice, 1e-7);
        EXPECT_NEAR(glm::length(sum), std::abs(twice), 1e-7);
    }
}

TEST(Polygon, WithoutAreaIsRefused) {
    EXPECT_THROW(make_polygon(0, 0, {{0, 0, 0}, {1, 1, 1}}), std::invalid_argument);
    EXPECT_THROW(make_polygon(0, 0, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), std::invalid_argument);
    EXPECT_THROW(make_polygon(0, 0, {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}), std::invalid_argument);
}

TEST(Polygon, PlaneHoldsItsVerticesAlsoSeenEdgeOn) {
    for (const std::uint64_t seed : property::seeds(500, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::attitude(random, random.whole(0, 5));
        const dvec3 centre = hand_made::random_point(random.engine(), -100, 100);
        const Polygon polygon = make_polygon(1, 2, shapes::lift(shapes::star(random, 7, 10), axes, centre));
        EXPECT_NEAR(glm::length(polygon.plane.n), 1, 1e-14);
        EXPECT_GT(glm::dot(polygon.plane.n, axes.w), 0.999999);
        for (const dvec3& v : polygon.vertices)
            EXPECT_NEAR(glm::dot(polygon.plane.n, v), polygon.plane.c, 1e-11);
        // The projection along the dominant axis keeps at least 1/sqrt(3) of the area.
        EXPECT_GE(std::abs(polygon.plane.n[polygon.drop]), 0.577);
    }
}

TEST(Polygon, TriangleNormalFieldGivesBackTheNormalsOfItsVertices) {
    for (const std::uint64_t seed : property::seeds(900, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::attitude(random, random.whole(0, 5));
        const dvec3 centre = hand_made::random_point(random.engine(), 0, 50);
        const auto outline = shapes::lift(shapes::star(random, 3, random.uniform(0.1, 20)), axes, centre);
        if (shapes::area_of(outline) < 1e-2) continue;
        std::array<dvec3, 3> normals;
        for (dvec3& n : normals) n = hand_made::random_direction(random.engine());
        const Polygon t = make_triangle(0, 0, {outline[0], outline[1], outline[2]}, normals);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_LT(glm::length(t.normal.at(project(outline[i], t.drop)) - normals[i]), 1e-9);
        }
        const dvec3 middle = (outline[0] + outline[1]) * 0.5;
        EXPECT_LT(glm::length(t.normal.at(project(middle, t.drop)) - 0.5 * (normals[0] + normals[1])), 1e-9);
    }
}

TEST(Clipping, NeighboursGetTheSameCutPointOnTheirSharedEdgeBitForBit) {
    for (const std::uint64_t seed : property::seeds(1300, 500)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 a = hand_made::random_point(random.engine(), -30, 30);
        const dvec3 b = hand_made::random_point(random.engine(), -30, 30);
        const dvec3 c = hand_made::random_point(random.engine(), -30, 30);
        const dvec3 d = hand_made::random_point(random.engine(), -30, 30);
        const Box box{dvec3(-10), dvec3(10)};
        // The ends of what is left of the shared edge: points on the line through a and b, sorted.
        const auto on_edge = [&](const std::vector<dvec3>& outline) {
            std::vector<dvec3> points;
            for (const dvec3& p : outline) {
                const dvec3 along = glm::normalize(b - a);
                const dvec3 off = p - a - glm::dot(p - a, along) * along;
                if (glm::length(off) < 1e-9) points.push_back(p);
            }
            std::sort(points.begin(), points.end(), [](const dvec3& p, const dvec3& q) {
                return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
            });
            return points;
        };
        const auto left = on_edge(clip_to_box({a, b, c}, box));
        const auto right = on_edge(clip_to_box({b, a, d}, box));
        if (left.size() != 2 || right.size() != 2) continue;  // the box took the edge or a neighbour away
        EXPECT_EQ(left, right);
    }
}

TEST(Clipping, HalvesAddUpToTheWholeAndLieOnTheirSides) {
    for (const std::uint64_t seed : property::seeds(1900, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const auto outline =
            shapes::lift(shapes::star(random, random.whole(3, 40), 10), shapes::turned(random), dvec3(5));
        const int axis = random.whole(0, 2);
        const double at = random.uniform(0, 10);
        const auto above = clip_half_space(outline, axis, at, 1);
        const auto below = clip_half_space(outline, axis, at, -1);
        for (const dvec3& p : above) EXPECT_GE(p[axis], at);
        for (const dvec3& p : below) EXPECT_LE(p[axis], at);
        dvec3 sum{0, 0, 0};
        if (!above.empty()) sum += newell(above);
        if (!below.empty()) sum += newell(below);
        EXPECT_LT(glm::length(sum - newell(outline)), 1e-9);
    }
}

TEST(Clipping, WhatOnlyTouchesTheBoxLeavesNothing) {
    const Box box{dvec3(0), dvec3(1)};
    EXPECT_TRUE(clip_to_box({{1, 0.5, 0.5}, {2, 0, 0}, {2, 1, 1}}, box).empty());
    EXPECT_TRUE(clip_to_box({{2, 0.5, 0.5}, {3, 0, 0}, {3, 1, 1}}, box).empty());
    // A polygon that lies in a face of the box stays.
    EXPECT_EQ(clip_to_box({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}, box).size(), 4u);
}

TEST(Triangulation, AreasAddUpAndNoTriangleTurnsTheOtherWay) {
    for (const std::uint64_t seed : property::seeds(2300, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::attitude(random, random.whole(0, 5));
        const auto flat = random.chance(0.3) ? shapes::comb(random.whole(2, 30), 8)
                                             : shapes::star(random, random.whole(3, 150), 8);
        const auto outline = shapes::lift(flat, axes, dvec3(20));
        const dvec3 normal = newell(outline);
        const auto triangles = triangulate(outline, normal);
        ASSERT_EQ(triangles.size(), outline.size() - 2);
        double sum = 0;
        for (const auto& t : triangles) {
            const double twice =
                glm::dot(newell({outline[t[0]], outline[t[1]], outline[t[2]]}), glm::normalize(normal));
            EXPECT_GE(twice, -1e-9);
            sum += twice;
        }
        EXPECT_NEAR(sum, glm::length(normal), 1e-8);
    }
}

/// Plain ear clipping: tests every corner in turn against all others.
std::vector<std::array<std::size_t, 3>> plain_triangles(const std::vector<dvec2>& p) {
    const auto area = [&](std::size_t a, std::size_t b, std::size_t c) {
        const dvec2 q = p[b] - p[a];
        const dvec2 r = p[c] - p[a];
        return q.x * r.y - q.y * r.x;
    };
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < p.size(); ++i) rest.push_back(i);
    std::vector<std::array<std::size_t, 3>> triangles;
    const auto corner = [&](std::size_t k) {
        return std::array<std::size_t, 3>{rest[(k + rest.size() - 1) % rest.size()], rest[k],
                                          rest[(k + 1) % rest.size()]};
    };
    const auto is_ear = [&](std::size_t k) {
        const auto [a, b, c] = corner(k);
        if (!(area(a, b, c) > 0)) return false;
        for (const std::size_t i : rest) {
            if (p[i] == p[a] || p[i] == p[b] || p[i] == p[c]) continue;
            if (area(a, b, i) >= 0 && area(b, c, i) >= 0 && area(c, a, i) >= 0) return false;
        }
        return true;
    };
    while (rest.size() > 3) {
        std::size_t ear = 0;
        while (ear < rest.size() && !is_ear(ear)) ++ear;
        if (ear == rest.size()) ear = 0;
        triangles.push_back(corner(ear));
        rest.erase(rest.begin() + std::ptrdiff_t(ear));
    }
    triangles.push_back({rest[0], rest[1], rest[2]});
    return triangles;
}

TEST(Triangulation, TakesTheFirstEarOfThePlainAlgorithmEveryTime) {
    for (const std::uint64_t seed : property::seeds(6000, 600)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        std::vector<dvec2> outline = random.chance(0.5) ? shapes::star(random, random.whole(3, 80), 5)
                                                        : shapes::comb(random.whole(2, 20), 7.5);
        if (random.chance(0.4)) {  // arbitrary: crosses and repeats itself
            for (dvec2& p : outline) p = glm::round(dvec2(random.uniform(-4, 4), random.uniform(-4, 4)));
        }
        ASSERT_EQ(triangulate(shapes::lift(outline, {}, {0, 0, 0}), {0, 0, 1}), plain_triangles(outline));
    }
}

TEST(Triangulation, AnOutlineThatCrossesItselfEnds) {
    const std::vector<dvec3> bow = {{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {2, 5, 0}};
    EXPECT_EQ(triangulate(bow, {0, 0, 1}).size(), 3u);
}

}  // namespace
}  // namespace raycell
