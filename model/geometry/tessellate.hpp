// Geometry: objects into planar polygons no finer than the array can see (design, section 2).
#pragma once

#include <vector>

#include "model/geometry/placement.hpp"

namespace raycell {

/// A primitive's polygons in cell coordinates. Ids run from first_id; the chord error is in cells. Warnings
/// name what was limited (a curved object that would need more than the largest subdivision).
std::vector<Polygon> tessellate(const Primitive& primitive, std::uint32_t first_id, const Frame& frame,
                                double chord_error, std::vector<std::string>* warnings = nullptr);

/// Subdivisions of an octahedron's edge so that its facets stay within chord_error of a sphere (same unit).
int sphere_subdivision(double radius, double chord_error);

/// Facets round a cone or cylinder so that they stay within chord_error of a circle of this radius.
int cone_facets(double radius, double chord_error);

constexpr int max_sphere_subdivision = 128;
constexpr int max_cone_facets = 1024;

}  // namespace raycell
