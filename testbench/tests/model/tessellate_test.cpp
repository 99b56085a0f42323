// Tessellation of curved objects: facets are closed, face outwards, keep the chord error and the normals.
#include "model/geometry/tessellate.hpp"

#include <map>

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

Frame frame_of(Random& random) {
    Frame frame;
    const shapes::Axes axes = shapes::turned(random);
    frame.right = axes.u;
    frame.down = axes.v;
    frame.forward = axes.w;
    frame.corner = hand_made::random_point(random.engine(), -10, 10);
    frame.cell_width = std::pow(10, random.uniform(-2, 1));
    return frame;
}

/// How many facets have each directed edge; ends are compared bit for bit.
using Corner = std::array<double, 3>;
std::map<std::pair<Corner, Corner>, int> edges_of(const std::vector<Polygon>& facets) {
    std::map<std::pair<Corner, Corner>, int> edges;
    const auto corner = [](const dvec3& p) { return Corner{p.x, p.y, p.z}; };
    for (const Polygon& facet : facets) {
        for (std::size_t i = 0; i < facet.vertices.size(); ++i) {
            ++edges[{corner(facet.vertices[i]), corner(facet.vertices[(i + 1) % facet.vertices.size()])}];
        }
    }
    return edges;
}

TEST(Tessellation, EveryEdgeOfASphereIsSharedByTwoFacetsBitForBit) {
    for (const std::uint64_t seed : property::seeds(1, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Frame frame = frame_of(random);
        SpherePrimitive sphere{hand_made::random_point(random.engine(), -5, 5), random.uniform(0.1, 3),
                               random.chance(0.5)};
        const auto facets = tessellate({0, sphere}, 7, frame, random.uniform(0.02, 2));
        ASSERT_FALSE(facets.empty());
        EXPECT_EQ(facets.front().id, 7u);
        EXPECT_EQ(facets.back().id, 7u + facets.size() - 1);
        const auto edges = edges_of(facets);
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << "an edge without a neighbour";
        }
    }
}

TEST(Tessellation, FacetsOfASphereStayWithinHalfTheChordErrorOnEitherSideAndFaceOutwards) {
    for (const std::uint64_t seed : property::seeds(100, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Frame frame = frame_of(random);
        SpherePrimitive sphere{dvec3(0.5), random.uniform(0.1, 3), random.chance(0.5)};
        const double radius = sphere.radius / frame.cell_width;
        const double chord = std::max(radius * std::pow(10, random.uniform(-3, -0.4)), radius * 1e-4);
        const double most = 0.5 * chord * (1 + 1e-9);
        const dvec3 centre = frame.to_cells(sphere.centre);
        const double side = sphere.inward ? -1 : 1;
        double inside = 0;
        double outside = 0;
        for (const Polygon& facet : tessellate({0, sphere}, 0, frame, chord)) {
            // A facet is nowhere nearer to the centre than its plane.
            const double gap = radius - std::abs(facet.plane.c - glm::dot(facet.plane.n, centre));
            EXPECT_LE(gap, most) << "radius " << radius;
            inside = std::max(inside, gap);
            const dvec3 middle = (facet.vertices[0] + facet.vertices[1] + facet.vertices[2]) / 3.0 - centre;
            EXPECT_GT(side * glm::dot(facet.plane.n, middle), 0);
            for (const dvec3& v : facet.vertices) {
                outside = std::max(outside, glm::length(v - centre) - radius);
                const dvec3 normal = facet.normal.at(project(v, facet.drop));
                EXPECT_NEAR(glm::dot(normal, side * (v - centre)) / glm::length(v - centre), 1, 1e-7);
            }
        }
        EXPECT_LE(outside, most);
        EXPECT_GT(inside, 0.75 * outside) << "balanced";
    }
}

/// How far the point's distance from the axis is from the cone's radius beside it, in cells.
double off_cone(const dvec3& p, const dvec3& base, const dvec3& axis, double height, double r0, double r1) {
    const double along = glm::dot(p - base, axis);
    const double radius = r0 + (r1 - r0) * along / height;
    return glm::length(p - base - along * axis) - radius;
}

TEST(Tessellation, EveryEdgeOfAConeButThoseOfItsRimsIsSharedByTwoFacetsBitForBit) {
    for (const std::uint64_t seed : property::seeds(200, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Frame frame = frame_of(random);
        ConePrimitive cone;
        cone.base = hand_made::random_point(random.engine(), -5, 5);
        cone.apex = cone.base + random.uniform(0.1, 4) * hand_made::random_direction(random.engine());
        const int kind = random.whole(0, 3);  // pointed either way, cylinder, frustum
        cone.base_radius = kind == 1 ? 0 : random.uniform(0.1, 2);
        cone.apex_radius = kind == 0 ? 0 : kind == 2 ? cone.base_radius : random.uniform(0.1, 2);
        cone.inward = random.chance(0.5);
        const double chord = random.uniform(0.01, 1);
        const auto facets = tessellate({0, cone}, 0, frame, chord);
        const double radius = std::max(cone.base_radius, cone.apex_radius) / frame.cell_width;
        const int round = cone_facets(radius, chord);
        const int rims = (cone.base_radius > 0) + (cone.apex_radius > 0);
        ASSERT_EQ(facets.size(), std::size_t(round));
        int open = 0;
        const auto edges = edges_of(facets);
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            open += edges.count({edge.second, edge.first}) == 0;
        }
        EXPECT_EQ(open, round * rims);
        const dvec3 base = frame.to_cells(cone.base);
        const dvec3 way = frame.to_cells(cone.apex) - base;
        const double height = glm::length(way);
        const dvec3 axis = way / height;
        const double side = cone.inward ? -1 : 1;
        const double r0 = cone.base_radius / frame.cell_width;
        const double r1 = cone.apex_radius / frame.cell_width;
        // Between the corners a facet is nearer to the axis by this factor, and its normals tilt by no more.
        const double nearer = std::cos(hand_made::pi / round);
        const double least = std::cos(std::asin((1 - nearer) / (1 + nearer)));
        for (const Polygon& facet : facets) {
            dvec3 middle{0, 0, 0};
            for (const dvec3& v : facet.vertices) middle += v / double(facet.vertices.size());
            const auto out = [&](const dvec3& p) { return p - base - glm::dot(p - base, axis) * axis; };
            EXPECT_GT(side * glm::dot(facet.plane.n, out(middle)), 0);
            for (std::size_t i = 0; i < facet.vertices.size(); ++i) {
                const dvec3& v = facet.vertices[i];
                const dvec3 edge = 0.5 * (v + facet.vertices[(i + 1) % facet.vertices.size()]);
                if (round > 4) {
                    EXPECT_LE(off_cone(v, base, axis, height, r0, r1), 0.5 * chord * (1 + 1e-9));
                    EXPECT_GE(off_cone(edge, base, axis, height, r0, r1), -0.5 * chord * (1 + 1e-9));
                }
                // The normals are those of the cone: at right angles to its generating lines, also between
                // the corners, and near a tip.
                const dvec3 near = 0.999 * v + 0.0007 * middle + 0.0003 * edge;
                const dvec3 normal = facet.normal.at(project(near, facet.drop));
                const dvec3 radial = glm::normalize(out(near));
                const dvec3 exact = side * glm::normalize(height * radial + (r0 - r1) * axis);
                EXPECT_GT(glm::dot(glm::normalize(normal), exact), least - 1e-6);
            }
        }
    }
}

/// How far on either side of a radius facets lie that come as near as `nearest`, for corners at 1.
double half_gap(double radius, double nearest) { return radius * (1 - nearest) / (1 + nearest); }

TEST(Tessellation, IsNeverCoarserThanAskedAndNotMuchFiner) {
    for (double radius = 0.01; radius < 3000; radius *= 1.37) {
        for (const double chord : {0.01, 0.1, 0.5}) {
            const int round = cone_facets(radius, chord);
            if (round < max_cone_facets) {
                EXPECT_LE(half_gap(radius, std::cos(hand_made::pi / round)), 0.5 * chord * (1 + 1e-12))
                    << radius;
            }
            if (round > 4) {
                EXPECT_GT(half_gap(radius, std::cos(hand_made::pi / (round - 1))), 0.5 * chord) << radius;
            }
            const int n = sphere_subdivision(radius, chord);
            if (n > 1 && n < max_sphere_subdivision) {
                EXPECT_LE(half_gap(radius, 1 / std::sqrt(1 + (n == 2 ? 2 : 1.77) / (n * n))),
                          0.5 * chord * (1 + 1e-12))
                    << radius;
            }
            if (n == 1) {
                EXPECT_LE(half_gap(radius, 0.578), 0.5 * chord) << radius;
            }
            EXPECT_GE(cone_facets(2 * radius, chord), round);
            EXPECT_GE(sphere_subdivision(2 * radius, chord), n);
        }
    }
}

TEST(Tessellation, TheLimitOfSubdivisionIsWarnedOf) {
    Frame frame;
    std::vector<std::string> warnings;
    tessellate({0, SpherePrimitive{dvec3(0), 1e5, false}}, 0, frame, 0.1, &warnings);
    EXPECT_EQ(warnings.size(), 1u);
    tessellate({0, SpherePrimitive{dvec3(0), 10, false}}, 0, frame, 0.1, &warnings);
    EXPECT_EQ(warnings.size(), 1u);
}

TEST(Tessellation, PatchBecomesTrianglesThatKeepTheNormalsOfItsVertices) {
    Frame frame;
    PolygonPrimitive patch;
    patch.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};  // concave
    for (int i = 0; i < 5; ++i) patch.normals.push_back(glm::normalize(dvec3(0.1 * i, 0.2, 1)));
    const auto facets = tessellate({3, patch}, 10, frame, 0.1);
    ASSERT_EQ(facets.size(), 3u);
    double area = 0;
    for (const Polygon& facet : facets) {
        area += shapes::area_of(facet.vertices);
        EXPECT_EQ(facet.object, 3u);
        for (const dvec3& v : facet.vertices) {
            const auto at =
                std::find(patch.vertices.begin(), patch.vertices.end(), v) - patch.vertices.begin();
            EXPECT_LT(glm::length(facet.normal.at({v.x, v.y}) - patch.normals[std::size_t(at)]), 1e-12);
        }
    }
    EXPECT_NEAR(area, shapes::area_of(patch.vertices), 1e-12);
}

}  // namespace
}  // namespace raycell
