// Spheres and cones as such: where a ray meets them.
#include "model/geometry/curved.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace raycell {
namespace {

constexpr double far = std::numeric_limits<double>::infinity();

CurvedSurface sphere() {
    CurvedSurface s;
    s.base = {1, 2, 3};
    s.base_radius = 2;
    s.first_polygon = 7;
    s.polygons = 8;
    return s;
}

CurvedSurface cone() {
    CurvedSurface c;
    c.kind = CurvedSurface::Kind::cone;
    c.base = {0, 0, 0};
    c.base_radius = 2;
    c.apex = {0, 0, 4};
    c.apex_radius = 0;
    return c;
}

TEST(CurvedSurface, OwnsItsPolygonsAndNoOthers) {
    EXPECT_FALSE(sphere().owns(6));
    EXPECT_TRUE(sphere().owns(7));
    EXPECT_TRUE(sphere().owns(14));
    EXPECT_FALSE(sphere().owns(15));
}

TEST(CurvedSurface, IsMetWhereARayEntersItAndThenWhereItLeaves) {
    EXPECT_DOUBLE_EQ(*meet(sphere(), {-9, 2, 3}, {1, 0, 0}, 0, far, std::nullopt), 8);
    EXPECT_DOUBLE_EQ(*meet(sphere(), {-9, 2, 3}, {1, 0, 0}, 8.5, far, std::nullopt), 12);
    EXPECT_FALSE(meet(sphere(), {-9, 2, 3}, {1, 0, 0}, 0, 7, std::nullopt));
    EXPECT_FALSE(meet(sphere(), {-9, 4.001, 3}, {1, 0, 0}, 0, far, std::nullopt));
}

TEST(CurvedSurface, IsNotMetByARayThatLeavesItWhereItLeavesThoughRoundingPutTheOriginAside) {
    for (const double aside : {-1e-5, 0.0, 1e-5}) {
        const dvec3 origin(3 + aside, 2, 3);
        EXPECT_FALSE(meet(sphere(), origin, {1, 0, 0}, 1e-7, far, 0.0)) << aside;
        EXPECT_NEAR(*meet(sphere(), origin, {-1, 0, 0}, 1e-7, far, 0.0), 4, 2e-5) << "through the inside";
    }
}

TEST(CurvedSurface, OfAConeEndsAtItsBaseAndAtItsTip) {
    EXPECT_NEAR(*meet(cone(), {-9, 0, 1}, {1, 0, 0}, 0, far, std::nullopt), 9 - 1.5, 1e-12);
    EXPECT_FALSE(meet(cone(), {-9, 0, 4.001}, {1, 0, 0}, 0, far, std::nullopt));
    EXPECT_FALSE(meet(cone(), {-9, 0, -0.001}, {1, 0, 0}, 0, far, std::nullopt));
    EXPECT_FALSE(meet(cone(), {1, 0, -9}, {0, 0, -1}, 0, far, std::nullopt)) << "it lies behind";
    EXPECT_NEAR(*meet(cone(), {1, 0, -9}, {0, 0, 1}, 0, far, std::nullopt), 11, 1e-12)
        << "no cap at the base";
}

TEST(CurvedSurface, CountsInsideABoxAloneIfThereIsOne) {
    const Box box{{0, 0, 0}, {9, 9, 9}};
    EXPECT_DOUBLE_EQ(*meet(sphere(), {-9, 2, 3}, {1, 0, 0}, 0, far, std::nullopt, &box), 12)
        << "it enters outside";
}

TEST(CurvedSurface, HasUnitNormalsThatPointOutwardsUnlessItIsInward) {
    CurvedSurface s = sphere();
    EXPECT_EQ(normal_at(s, {3, 2, 3}), dvec3(1, 0, 0));
    s.inward = true;
    EXPECT_EQ(normal_at(s, {3, 2, 3}), dvec3(-1, 0, 0));
    const dvec3 n = normal_at(cone(), {1, 0, 2});
    EXPECT_NEAR(glm::length(n), 1, 1e-12);
    EXPECT_NEAR(n.z / n.x, 0.5, 1e-12) << "across the side, which falls by 2 over 4";
}

TEST(CurvedSurface, LiesInItsBounds) {
    const Box box = bounds_of(cone());
    EXPECT_EQ(box.low, dvec3(-2, -2, 0));
    EXPECT_EQ(box.high, dvec3(2, 2, 4));
}

}  // namespace
}  // namespace raycell
