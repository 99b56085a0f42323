// How far the visible part of a scene reaches in depth: where the cube begins and ends (design, section 3).
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

/// Right-handed axes of the viewer: where a scene's points lie, in world units, the third along the view.
struct ViewAxes {
    dvec3 from{0, 0, 0};
    dvec3 right{1, 0, 0};
    dvec3 down{0, 1, 0};
    dvec3 forward{0, 0, 1};
    dvec3 direction(const dvec3& d) const;
    dvec3 point(const dvec3& p) const { return direction(p - from); }
};

/// Depth range of the part of a primitive's surface inside a field of view, in coordinates of the axes:
/// closed forms, whose time depends neither on the primitive's size nor on how it will be tessellated.
Extent visible_extent(const Primitive& primitive, const ViewAxes& axes, const std::vector<HalfSpace>& field);

}  // namespace raycell
