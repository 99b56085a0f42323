// The one place where the truth decides whether a ray meets a polygon.
#pragma once

#include <optional>
#include <vector>

#include "model/geometry/polygon.hpp"
#include "model/numbers/tolerance.hpp"

namespace raycell {

/// A ray that passes the polygon's outline by no more than this, in its projection, meets it.
inline double outline_room(const Polygon& polygon) { return exact_hair + 2 * polygon.slack; }

/// A ray prepared for the test against many polygons, in double precision.
///
/// A point of a polygon is found by its crossing number (even-odd rule, so concave outlines need no special
/// care), counted not on the polygon's plane but on the plane that the ray sees: the vertices are sheared
/// along the ray, as Woop, Benthin and Wald do for triangles (Watertight Ray/Triangle Intersection, 2013).
/// An edge's crossing then depends on the ray and the edge's two ends alone, bit for bit, not on the polygon
/// that asks: where polygons share an edge or a vertex, an odd number of those round the ray hold it, so no
/// ray slips between them. A ray that passes an outline by no more than exact_hair meets it too, so that
/// where edges lie on rays the choice is not left to rounding.
class ProbeRay {
  public:
    /// Cell coordinates; `direction` is unit (an error of a few 1e-5, as fixed-point words have, does no
    /// harm).
    ProbeRay(const dvec3& origin, const dvec3& direction);

    /// Distance along the ray, t_min < t <= t_max, at which it meets the polygon; either side counts.
    std::optional<double> meet(const Polygon& polygon, double t_min, double t_max) const;

    dvec3 at(double t) const { return origin_ + t * direction_; }
    const dvec3& origin() const { return origin_; }
    const dvec3& direction() const { return direction_; }

  private:
    dvec2 flatten(const dvec3& point) const;
    bool pierces(const std::vector<dvec3>& outline) const;
    bool touches(const Polygon& polygon, double t) const;
    double clamp_to_extent(double t, const std::vector<dvec3>& outline) const;

    dvec3 origin_;
    dvec3 direction_;
    int along_;          ///< axis of the direction's largest component
    Projection across_;  ///< the other two
    dvec2 shear_;
};

}  // namespace raycell
