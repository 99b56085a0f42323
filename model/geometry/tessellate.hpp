// Geometry: turns objects into planar polygons no finer than the array can see (design, section 2).
#pragma once

#include <vector>

#include "model/geometry/placement.hpp"

namespace raycell {

/// Turns a primitive into polygons in cell coordinates. Ids run from first_id; the chord error, in cells, is
/// how far below its corners the middle of a facet may lie: half of it is outside of the surface, half
/// inside. Adds a warning for a curved object that would need more than the largest subdivision.
std::vector<Polygon> tessellate(const Primitive& primitive, std::uint32_t first_id, const Frame& frame,
                                double chord_error, std::vector<std::string>* warnings = nullptr);

/// Number of subdivisions of an octahedron's edge that keeps the chord error of a sphere of this radius (same
/// unit).
int sphere_subdivision(double radius, double chord_error);

/// Number of facets round a cone or cylinder that keeps the chord error of a circle of this radius (same
/// unit).
int cone_facets(double radius, double chord_error);

constexpr int max_sphere_subdivision = 128;
constexpr int max_cone_facets = 1024;

}  // namespace raycell
