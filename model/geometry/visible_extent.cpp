#include "model/geometry/visible_extent.hpp"

#include <algorithm>
#include <cmath>

#include "model/geometry/polygon.hpp"

namespace raycell {

void Extent::add(double z) {
    near = std::min(near, z);
    far = std::max(far, z);
}

void Extent::add(const Extent& other) {
    near = std::min(near, other.near);
    far = std::max(far, other.far);
}

dvec3 ViewAxes::direction(const dvec3& d) const {
    return {glm::dot(d, right), glm::dot(d, down), glm::dot(d, forward)};
}

namespace {

const dvec3 depth_axis{0, 0, 1};

/// Collects points among which the nearest and the farthest of a surface are found, if they lie in the field.
/// z is extreme on the surface itself, on a curve where one side of the field cuts it, or on a line where two
/// sides meet; each case has a closed form.
class Candidates {
  public:
    /// `room`: tolerance for points on a side, in world units.
    Candidates(const std::vector<HalfSpace>& field, double room) : room_(room) {
        for (const HalfSpace& side : field) {
            const double length = glm::length(side.n);
            field_.push_back({side.n / length, side.c / length});
        }
    }

    const std::vector<HalfSpace>& field() const { return field_; }
    const Extent& extent() const { return extent_; }

    void add(const dvec3& p) {
        for (const HalfSpace& side : field_) {
            if (glm::dot(side.n, p) - side.c < -room_) return;
        }
        extent_.add(p.z);
    }

    /// Adds a circle round `axis` (unit): its own extremes, and the points where the sides cut it.
    void add_circle(const dvec3& centre, const dvec3& axis, double radius) {
        const dvec3 along = depth_axis - axis.z * axis;
        const dvec3 helper = std::abs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const double steep = glm::length(along);
        const dvec3 u = steep > 1e-9 ? along / steep : glm::normalize(glm::cross(axis, helper));
        const dvec3 v = glm::cross(axis, u);
        add(centre - radius * u);
        add(centre + radius * u);
        for (const HalfSpace& side : field_) {
            const double a = radius * glm::dot(side.n, u);
            const double b = radius * glm::dot(side.n, v);
            const double share = (side.c - glm::dot(side.n, centre)) / std::hypot(a, b);
            if (!(std::abs(share) <= 1)) continue;
            for (const double sign : {-1.0, 1.0}) {
                const double angle = std::atan2(b, a) + sign * std::acos(share);
                add(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
            }
        }
    }

  private:
    std::vector<HalfSpace> field_;
    double room_;
    Extent extent_;
};

/// Real solutions of a·x² + b·x + c = 0; none if every x is a solution.
std::vector<double> roots(double a, double b, double c) {
    if (a == 0) return b == 0 ? std::vector<double>() : std::vector<double>{-c / b};
    const double squared = b * b - 4 * a * c;
    if (squared < 0) return {};
    const double q = -0.5 * (b + std::copysign(std::sqrt(squared), b));
    if (q == 0) return {0};
    return {q / a, c / q};
}

Extent of_polygon(const PolygonPrimitive& shape, const ViewAxes& axes, const std::vector<HalfSpace>& field) {
    std::vector<dvec3> part;
    for (const dvec3& v : shape.vertices) part.push_back(axes.point(v));
    for (const HalfSpace& side : field) part = clip_plane(part, side.n, side.c);
    Extent extent;
    for (const dvec3& p : part) extent.add(p.z);
    return extent;
}

Extent of_sphere(const SpherePrimitive& shape, const ViewAxes& axes, const std::vector<HalfSpace>& field) {
    const dvec3 centre = axes.point(shape.centre);
    const double radius = shape.radius;
    Candidates candidates(field, 1e-9 * (radius + glm::length(centre)));
    candidates.add(centre - radius * depth_axis);
    candidates.add(centre + radius * depth_axis);
    bool cut = false;
    for (const HalfSpace& side : candidates.field()) {
        const double distance = glm::dot(side.n, centre) - side.c;
        if (std::abs(distance) > radius) continue;
        cut = true;
        candidates.add_circle(centre - distance * side.n, side.n,
                              std::sqrt(radius * radius - distance * distance));
    }
    Extent extent = candidates.extent();
    // Facets lie inside the sphere, by at most this much where their number is limited. Only a cut sphere
    // needs the margin: a whole sphere encloses its facets.
    if (cut && extent.near <= extent.far) extent = {extent.near - 1e-4 * radius, extent.far + 1e-4 * radius};
    return extent;
}

/// A cone's lateral surface: all p with |q|² − h² = (r + k·h)², where q = p − base and h = q·axis, for h from
/// 0 to the height.
class ConeExtent {
  public:
    ConeExtent(const ConePrimitive& shape, const ViewAxes& axes, const std::vector<HalfSpace>& field)
        : base_(axes.point(shape.base)),
          radius_(shape.base_radius),
          candidates_(field, 1e-9 * (glm::length(base_) + radius_ + shape.apex_radius)) {
        const dvec3 apex = axes.point(shape.apex);
        height_ = glm::length(apex - base_);
        if (!(height_ > 0)) return;
        axis_ = (apex - base_) / height_;
        slope_ = (shape.apex_radius - shape.base_radius) / height_;
        candidates_.add_circle(base_, axis_, shape.base_radius);
        candidates_.add_circle(apex, axis_, shape.apex_radius);
        const std::vector<HalfSpace>& sides = candidates_.field();
        for (std::size_t i = 0; i < sides.size(); ++i) {
            add_section(sides[i]);
            for (std::size_t j = i + 1; j < sides.size(); ++j) add_line(sides[i], sides[j]);
        }
    }

    Extent extent() const { return candidates_.extent(); }

  private:
    /// The surface's quadratic form between two vectors.
    double form(const dvec3& a, const dvec3& b) const {
        const double along = glm::dot(a, axis_) * glm::dot(b, axis_);
        return glm::dot(a, b) - (1 + slope_ * slope_) * along;
    }
    /// Half of the form's linear part along a vector.
    double linear(const dvec3& a) const { return -radius_ * slope_ * glm::dot(a, axis_); }

    void add_if_on(const dvec3& q) {
        const double h = glm::dot(q, axis_);
        if (h >= 0 && h <= height_ && radius_ + slope_ * h >= 0) candidates_.add(base_ + q);
    }

    /// Adds the nearest and the farthest point of the curve in which a side cuts the surface.
    void add_section(const HalfSpace& side) {
        const dvec3 origin = side.n * (side.c - glm::dot(side.n, base_));
        const dvec3 along = depth_axis - side.n.z * side.n;
        if (glm::length(along) < 1e-9) return;  // one depth, which add_line() finds
        const dvec3 e1 = glm::normalize(along);
        const dvec3 e2 = glm::cross(side.n, e1);  // depth is constant along it
        // c·b² + 2(m·a + e)·b + (A·a² + 2D·a + F) = 0 with q = origin + a·e1 + b·e2. a is extreme where b is
        // a double root.
        const double c = form(e2, e2);
        if (c == 0) return;
        const double m = form(e1, e2);
        const double e = form(origin, e2) + linear(e2);
        const double square = form(e1, e1);
        const double d = form(origin, e1) + linear(e1);
        const double f = form(origin, origin) + 2 * linear(origin) - radius_ * radius_;
        for (const double a : roots(m * m - c * square, 2 * (m * e - c * d), e * e - c * f)) {
            add_if_on(origin + a * e1 - (m * a + e) / c * e2);
        }
    }

    void add_line(const HalfSpace& a, const HalfSpace& b) {
        const dvec3 direction = glm::cross(a.n, b.n);
        const double squared = glm::dot(direction, direction);
        if (!(squared > 0)) return;
        const double at_a = a.c - glm::dot(a.n, base_);
        const double at_b = b.c - glm::dot(b.n, base_);
        const dvec3 on_both = glm::cross(at_a * b.n - at_b * a.n, direction) / squared;
        const double f = form(on_both, on_both) + 2 * linear(on_both) - radius_ * radius_;
        for (const double t :
             roots(form(direction, direction), 2 * (form(on_both, direction) + linear(direction)), f)) {
            add_if_on(on_both + t * direction);
        }
    }

    dvec3 base_;
    double radius_;
    Candidates candidates_;
    double height_ = 0;
    dvec3 axis_{0, 0, 1};
    double slope_ = 0;
};

}  // namespace

Extent visible_extent(const Primitive& primitive, const ViewAxes& axes, const std::vector<HalfSpace>& field) {
    if (const auto* polygon = std::get_if<PolygonPrimitive>(&primitive.shape)) {
        return of_polygon(*polygon, axes, field);
    }
    if (const auto* sphere = std::get_if<SpherePrimitive>(&primitive.shape)) {
        return of_sphere(*sphere, axes, field);
    }
    return ConeExtent(std::get<ConePrimitive>(primitive.shape), axes, field).extent();
}

}  // namespace raycell
