// Depth range of the visible part of a scene: it decides where the cube begins and ends (design, section 3).
#pragma once

#include <limits>
#include <vector>

#include "model/geometry/scene.hpp"

namespace raycell {

/// The half-space n·p >= c.
struct HalfSpace {
    dvec3 n{0, 0, 1};
    double c = 0;
};

/// A range of depth; empty if near > far.
struct Extent {
    double near = std::numeric_limits<double>::infinity();
    double far = -std::numeric_limits<double>::infinity();
    void add(double z);
    void add(const Extent& other);
};

/// The viewer's right-handed coordinates, in world units; the third axis is the view direction.
struct ViewAxes {
    dvec3 from{0, 0, 0};
    dvec3 right{1, 0, 0};
    dvec3 down{0, 1, 0};
    dvec3 forward{0, 0, 1};
    dvec3 direction(const dvec3& d) const;
    dvec3 point(const dvec3& p) const { return direction(p - from); }
};

/// Depth range of the part of a primitive's surface inside a field of view, in coordinates of the axes. Uses
/// closed forms, so the time depends neither on the primitive's size nor on its tessellation.
Extent visible_extent(const Primitive& primitive, const ViewAxes& axes, const std::vector<HalfSpace>& field);

}  // namespace raycell
