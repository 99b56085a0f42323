// Spheres and cones as such: what the truth of the scene meets in place of their polygons.
#pragma once

#include <cstdint>
#include <optional>

#include "model/geometry/polygon.hpp"

namespace raycell {

/// A sphere, or a cone or cylinder without caps, in cell coordinates.
struct CurvedSurface {
    enum class Kind : std::uint8_t { sphere, cone };
    Kind kind = Kind::sphere;
    dvec3 base{0, 0, 0};     ///< sphere: its centre
    double base_radius = 1;  ///< sphere: its radius
    dvec3 apex{0, 0, 0};     ///< cone: the other end of its axis
    double apex_radius = 0;
    bool inward = false;  ///< its normals point inwards
    std::uint32_t object = 0;
    std::uint32_t first_polygon = 0;  ///< id of the first of its polygons: its own id
    std::uint32_t polygons = 0;       ///< how many there are, with ids that follow each other

    bool owns(std::uint32_t polygon) const { return polygon - first_polygon < polygons; }
};

Box bounds_of(const CurvedSurface& surface);

/// Distance at which a ray meets the surface: the nearest with t_min < t <= t_max, and inside `within` if
/// that is given; either side counts. `left`: the distance at which the ray left this surface, if it did; the
/// root nearest to it is where it started and does not count. `direction` is unit, to some 1e-5.
std::optional<double> meet(const CurvedSurface& surface, const dvec3& origin, const dvec3& direction,
                           double t_min, double t_max, std::optional<double> left,
                           const Box* within = nullptr);

/// Unit normal at a point of the surface.
dvec3 normal_at(const CurvedSurface& surface, const dvec3& point);

}  // namespace raycell
