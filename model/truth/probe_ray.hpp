// The one place where the truth decides whether a ray meets a polygon.
#pragma once

#include <optional>
#include <vector>

#include "model/geometry/polygon.hpp"
#include "model/numbers/tolerance.hpp"

namespace raycell {

/// Tolerance in cells: a ray that passes the polygon's outline by no more than this, in the polygon's
/// projection, meets it.
inline double outline_room(const Polygon& polygon) { return exact_hair + 2 * polygon.slack; }

/// A ray prepared for the test against many polygons, in double precision.
///
/// Whether the ray meets a polygon is found by counting crossings of the outline (even-odd rule, so concave
/// outlines need no special care). They are counted not on the polygon's plane but on the plane that the ray
/// sees: the vertices are sheared along the ray, as Woop, Benthin and Wald do for triangles (Watertight
/// Ray/Triangle Intersection, 2013). The crossing of an edge then depends, bit for bit, only on the ray and
/// the edge's two ends, not on the polygon. Where polygons share an edge or a vertex, an odd number of those
/// around the ray contain it, so no ray slips between them. A ray that passes an outline by no more than
/// outline_room() meets the polygon too, so that rounding does not decide where edges lie on rays.
class ProbeRay {
  public:
    /// Cell coordinates; `direction` is unit (an error of a few 1e-5, as fixed-point words have, does no
    /// harm). `started`: the distance at which the ray left its surface, negative if it is a ray's rest.
    ProbeRay(const dvec3& origin, const dvec3& direction, double started = 0);

    /// Distance along the ray, t_min < t <= t_max, at which it meets the polygon; either side counts.
    std::optional<double> meet(const Polygon& polygon, double t_min, double t_max) const;

    dvec3 at(double t) const { return origin_ + t * direction_; }
    const dvec3& origin() const { return origin_; }
    const dvec3& direction() const { return direction_; }
    double started() const { return started_; }

  private:
    dvec2 flatten(const dvec3& point) const;
    bool pierces(const std::vector<dvec3>& outline) const;
    bool touches(const Polygon& polygon, double t) const;
    double clamp_to_extent(double t, const std::vector<dvec3>& outline) const;

    dvec3 origin_;
    dvec3 direction_;
    double started_;
    int along_;          ///< axis of the direction's largest component
    Projection across_;  ///< the other two
    dvec2 shear_;
};

}  // namespace raycell
