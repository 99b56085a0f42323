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

ProbeRay::ProbeRay(const dvec3& origin, const dvec3& direction)
    : origin_(origin),
      direction_(direction),
      along_(dominant_axis(direction)),
      across_(projection(along_)),
      shear_(direction[across_.u] / direction[along_], direction[across_.v] / direction[along_]) {}

/// Where the ray sees a point: (0, 0) if the point is on the ray's line.
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
    if (!pierces(polygon.vertices)) return std::nullopt;
    if (!steep) t = clamp_to_extent(t, polygon.vertices);
    if (!(t > t_min && t <= t_max)) return std::nullopt;
    return t;
}

}  // namespace raycell
