// Voxels compared field by field.
#pragma once

#include <gtest/gtest.h>

#include "model/loading/voxel.hpp"

namespace raycell {

/// Expects all to be equal but for the object and the plane's offset, which not every message carries.
inline void expect_equal_voxels(const Voxel& a, const Voxel& b) {
    EXPECT_EQ(a.polygon, b.polygon);
    EXPECT_EQ(a.near_level, b.near_level);
    EXPECT_EQ(a.far_level, b.far_level);
    EXPECT_EQ(a.near, b.near);
    EXPECT_EQ(a.far, b.far);
    EXPECT_EQ(a.drop, b.drop);
    EXPECT_EQ(a.plane.n, b.plane.n);
    EXPECT_EQ(a.normal.base, b.normal.base);
    EXPECT_EQ(a.normal.du, b.normal.du);
    EXPECT_EQ(a.normal.dv, b.normal.dv);
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.mask, b.mask);
    EXPECT_EQ(a.window, b.window);
    EXPECT_EQ(a.edge_count, b.edge_count);
    EXPECT_EQ(a.pieces, b.pieces);
}

}  // namespace raycell
