#include "model/geometry/curved.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raycell {
namespace {

/// The roots of a·t² + 2·b·t + c, the smaller first; `disc` is b² − a·c, which the caller may know better.
/// NaN for a root that there is not.
std::array<double, 2> roots(double a, double b, double c, double disc) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!(disc >= 0)) return {none, none};
    const double q = -(b + std::copysign(std::sqrt(disc), b));
    const double one = q / a;
    const double other = c / q;
    if (!std::isfinite(one)) return {other, none};
    if (!std::isfinite(other)) return {one, none};
    return {std::min(one, other), std::max(one, other)};
}

std::array<double, 2> sphere_roots(const CurvedSurface& s, const dvec3& origin, const dvec3& direction) {
    const dvec3 from = origin - s.base;
    const double a = glm::dot(direction, direction);
    const double b = glm::dot(from, direction);
    const double radius = s.base_radius;
    const dvec3 nearest = from - b / a * direction;  // from the centre: no difference of large squares
    const double disc = a * (radius * radius - glm::dot(nearest, nearest));
    const double length = glm::length(from);
    return roots(a, b, (length - radius) * (length + radius), disc);
}

struct Axis {
    dvec3 unit;
    double length;
    double slope;  ///< of the radius along it
};

Axis axis_of(const CurvedSurface& s) {
    const dvec3 way = s.apex - s.base;
    const double length = glm::length(way);
    return {way / length, length, (s.apex_radius - s.base_radius) / length};
}

std::array<double, 2> cone_roots(const CurvedSurface& s, const Axis& axis, const dvec3& origin,
                                 const dvec3& direction) {
    const dvec3 from = origin - s.base;
    const double along = glm::dot(from, axis.unit);
    const double step = glm::dot(direction, axis.unit);
    const dvec3 off = from - along * axis.unit;
    const dvec3 across = direction - step * axis.unit;
    const double radius = s.base_radius + axis.slope * along;
    const double grows = axis.slope * step;
    const double a = glm::dot(across, across) - grows * grows;
    const double b = glm::dot(off, across) - grows * radius;
    const double distance = glm::length(off);
    const double c = (distance - radius) * (distance + radius);
    return roots(a, b, c, b * b - a * c);
}

}  // namespace

Box bounds_of(const CurvedSurface& s) {
    if (s.kind == CurvedSurface::Kind::sphere) return {s.base - s.base_radius, s.base + s.base_radius};
    const dvec3 axis = axis_of(s).unit;
    // How far a disc across the axis reaches along x, y, z.
    const dvec3 reach = glm::sqrt(glm::max(1.0 - axis * axis, dvec3(0)));
    return {glm::min(s.base - s.base_radius * reach, s.apex - s.apex_radius * reach),
            glm::max(s.base + s.base_radius * reach, s.apex + s.apex_radius * reach)};
}

std::optional<double> meet(const CurvedSurface& s, const dvec3& origin, const dvec3& direction, double t_min,
                           double t_max, std::optional<double> left, const Box* within) {
    const bool sphere = s.kind == CurvedSurface::Kind::sphere;
    const Axis axis = sphere ? Axis{} : axis_of(s);
    std::array<double, 2> at =
        sphere ? sphere_roots(s, origin, direction) : cone_roots(s, axis, origin, direction);
    if (left) {
        const std::size_t own =
            std::isnan(at[1]) || std::abs(at[0] - *left) < std::abs(at[1] - *left) ? 0 : 1;
        at[own] = std::numeric_limits<double>::quiet_NaN();
    }
    for (const double t : at) {
        if (!(t > t_min && t <= t_max)) continue;
        const dvec3 point = origin + t * direction;
        if (!sphere) {
            const double along = glm::dot(point - s.base, axis.unit);
            if (along < 0 || along > axis.length) continue;
        }
        if (within &&
            (glm::any(glm::lessThan(point, within->low)) || glm::any(glm::greaterThan(point, within->high))))
            continue;
        return t;
    }
    return std::nullopt;
}

dvec3 normal_at(const CurvedSurface& s, const dvec3& point) {
    const double side = s.inward ? -1 : 1;
    const dvec3 from = point - s.base;
    if (s.kind == CurvedSurface::Kind::sphere) return side * glm::normalize(from);
    const Axis axis = axis_of(s);
    const dvec3 off = from - glm::dot(from, axis.unit) * axis.unit;
    const double distance = glm::length(off);
    if (!(distance > 0)) return axis.slope < 0 ? side * axis.unit : -side * axis.unit;  // the tip
    return side * glm::normalize(off / distance - axis.slope * axis.unit);
}

}  // namespace raycell
