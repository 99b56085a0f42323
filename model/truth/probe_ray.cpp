#include "model/truth/probe_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raycell {

namespace {
/// Below this |n·d| the quotient that gives t loses too many digits to be trusted outside the polygon's
/// extent.
constexpr double grazing = 1e-6;
}  // namespace

ProbeRay::ProbeRay(const dvec3& origin, const dvec3& direction, double started)
    : origin_(origin),
      direction_(direction),
      started_(started),
      along_(dominant_axis(direction)),
      across_(projection(along_)),
      shear_(direction[across_.u] / direction[along_], direction[across_.v] / direction[along_]) {}

/// Place of a point as seen along the ray; (0, 0) if the point is on the ray's line.
dvec2 ProbeRay::flatten(const dvec3& point) const {
    const dvec3 p = point - origin_;
    return {p[across_.u] - shear_.x * p[along_], p[across_.v] - shear_.y * p[along_]};
}

bool ProbeRay::pierces(const std::vector<dvec3>& outline) const {
    bool odd = false;
    dvec2 a = flatten(outline.back());
    for (const dvec3& vertex : outline) {
        const dvec2 b = flatten(vertex);
        if ((a.y > 0) != (b.y > 0)) {
            // Ordered by side, so that both polygons of an edge compute the same number.
            const dvec2& low = a.y > 0 ? b : a;
            const dvec2& high = a.y > 0 ? a : b;
            if (low.x * high.y - high.x * low.y > 0) odd = !odd;
        }
        a = b;
    }
    return odd;
}

/// Whether the point at distance t lies within the tolerance of the polygon's outline.
bool ProbeRay::touches(const Polygon& polygon, double t) const {
    const double room = outline_room(polygon);
    const dvec2 p = project(at(t), polygon.drop);
    dvec2 a = project(polygon.vertices.back(), polygon.drop);
    for (const dvec3& vertex : polygon.vertices) {
        const dvec2 b = project(vertex, polygon.drop);
        const dvec2 side = b - a;
        const double squared = glm::dot(side, side);
        const double share = squared > 0 ? std::clamp(glm::dot(p - a, side) / squared, 0.0, 1.0) : 0;
        const dvec2 off = p - (a + share * side);
        if (glm::dot(off, off) <= room * room) return true;
        a = b;
    }
    return false;
}

/// Keeps the hit of an almost edge-on polygon within that polygon; also settles 0/0.
double ProbeRay::clamp_to_extent(double t, const std::vector<dvec3>& outline) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const dvec3& vertex : outline) {
        const double v = glm::dot(vertex - origin_, direction_);
        low = std::min(low, v);
        high = std::max(high, v);
    }
    return std::isnan(t) ? low : std::clamp(t, low, high);
}

std::optional<double> ProbeRay::meet(const Polygon& polygon, double t_min, double t_max) const {
    const double slope = glm::dot(polygon.plane.n, direction_);
    double t = (polygon.plane.c - glm::dot(polygon.plane.n, origin_)) / slope;
    const bool steep = std::abs(slope) > grazing;
    if (steep && !(t > t_min && t <= t_max)) return std::nullopt;
    if (!pierces(polygon.vertices) && !(steep && touches(polygon, t))) return std::nullopt;
    if (!steep) t = clamp_to_extent(t, polygon.vertices);
    if (!(t > t_min && t <= t_max)) return std::nullopt;
    return t;
}

}  // namespace raycell
