// Tessellation of curved objects: facets are closed, face outwards and keep the chord error.
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

TEST(Tessellation, FacetsOfASphereStayWithinTheChordErrorAndFaceOutwards) {
    for (const std::uint64_t seed : property::seeds(100, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Frame frame = frame_of(random);
        SpherePrimitive sphere{dvec3(0.5), random.uniform(0.1, 3), random.chance(0.5)};
        const double radius = sphere.radius / frame.cell_width;
        const double chord = std::max(radius * std::pow(10, random.uniform(-3, -0.4)), radius * 1e-4);
        const dvec3 centre = frame.to_cells(sphere.centre);
        const double side = sphere.inward ? -1 : 1;
        for (const Polygon& facet : tessellate({0, sphere}, 0, frame, chord)) {
            // The gap is largest where the facet's plane is nearest to the centre, if the facet contains that
            // point.
            const double gap = radius - std::abs(facet.plane.c - glm::dot(facet.plane.n, centre));
            EXPECT_LE(gap, chord * (1 + 1e-9)) << "radius " << radius;
            const dvec3 middle = (facet.vertices[0] + facet.vertices[1] + facet.vertices[2]) / 3.0 - centre;
            EXPECT_GT(side * glm::dot(facet.plane.n, middle), 0);
            for (const dvec3& v : facet.vertices) {
                EXPECT_NEAR(glm::length(v - centre), radius, radius * 1e-12);
                const dvec3 normal = facet.normal.at(project(v, facet.drop));
                EXPECT_NEAR(glm::dot(normal, side * (v - centre)) / radius, 1, 1e-7);
            }
        }
    }
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
        ASSERT_EQ(facets.size(), std::size_t(round * rims));
        int open = 0;
        const auto edges = edges_of(facets);
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            open += edges.count({edge.second, edge.first}) == 0;
        }
        EXPECT_EQ(open, round * rims);
        const dvec3 base = frame.to_cells(cone.base);
        const dvec3 axis = glm::normalize(frame.to_cells(cone.apex) - base);
        const double side = cone.inward ? -1 : 1;
        for (const Polygon& facet : facets) {
            const dvec3 middle = (facet.vertices[0] + facet.vertices[1] + facet.vertices[2]) / 3.0;
            const dvec3 out = middle - base - glm::dot(middle - base, axis) * axis;
            EXPECT_GT(side * glm::dot(facet.plane.n, out), 0);
            // The vertex normals are those of the cone: at right angles to its generating lines.
            for (const dvec3& v : facet.vertices) {
                const dvec3 normal = facet.normal.at(project(v, facet.drop));
                EXPECT_GT(glm::dot(normal, facet.plane.n), 0.5);
            }
        }
    }
}

TEST(Tessellation, IsNeverCoarserThanAskedAndNotMuchFiner) {
    for (double radius = 0.01; radius < 3000; radius *= 1.37) {
        for (const double chord : {0.01, 0.1, 0.5}) {
            const int round = cone_facets(radius, chord);
            if (round < max_cone_facets) {
                EXPECT_LE(radius * (1 - std::cos(hand_made::pi / round)), chord * (1 + 1e-12)) << radius;
            }
            if (round > 4) {
                EXPECT_GT(radius * (1 - std::cos(hand_made::pi / (round - 1))), chord) << radius;
            }
            const int n = sphere_subdivision(radius, chord);
            if (n > 1 && n < max_sphere_subdivision) {
                EXPECT_LE(radius * (1 - 1 / std::sqrt(1 + 2.0 / (n * n))), chord * (1 + 1e-12)) << radius;
            }
            if (n == 1) {
                EXPECT_LE(radius * (1 - 0.58), chord) << radius;
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
