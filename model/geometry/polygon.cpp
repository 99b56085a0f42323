#include "model/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace raycell {

int dominant_axis(const dvec3& n) {
    const dvec3 a = glm::abs(n);
    // Axis z wins ties, so that a 45 degree plane is stored as the cells see it.
    if (a.z >= a.x && a.z >= a.y) return 2;
    return a.x >= a.y ? 0 : 1;
}

namespace {

dvec3 hold_each(const Format& f, const dvec3& v) { return {f.hold(v.x), f.hold(v.y), f.hold(v.z)}; }

}  // namespace

Plane hold_plane(const Plane& plane, int drop, const dvec3& anchor, const Format& slope,
                 const Format& offset) {
    const double scale = 1 / std::abs(plane.n[drop]);
    Plane held;
    held.n = hold_each(slope, plane.n * scale);
    held.n[drop] = plane.n[drop] < 0 ? -1 : 1;
    // The anchor may lie slightly off the plane, so only its two kept coordinates are used.
    const Projection axes = projection(drop);
    dvec3 on_plane = anchor;
    on_plane[drop] =
        (plane.c - plane.n[axes.u] * anchor[axes.u] - plane.n[axes.v] * anchor[axes.v]) / plane.n[drop];
    held.c = offset.hold(glm::dot(held.n, on_plane));
    return held;
}

NormalField hold_field(const NormalField& field, const dvec2& anchor, const Format& gradient,
                       const Format& base) {
    NormalField held;
    held.du = hold_each(gradient, field.du);
    held.dv = hold_each(gradient, field.dv);
    held.base = hold_each(base, field.at(anchor) - anchor.x * held.du - anchor.y * held.dv);
    return held;
}

NormalField fill_words(const NormalField& field, const dvec3& middle, double most, double least, bool* single,
                       double elsewhere) {
    const auto size_of = [](const dvec3& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    const auto scale_of = [&](double size) {
        return size > 0 && std::isfinite(size) ? scale_by(1, exponent_of(most) - 1 - exponent_of(size)) : 1;
    };
    const bool flat = field.du == dvec3(0) && field.dv == dvec3(0);
    const double scale =
        scale_of(std::max({size_of(field.base), size_of(field.du), size_of(field.dv), elsewhere}));
    if (flat || scale * size_of(middle) >= least)
        return {scale * field.base, scale * field.du, scale * field.dv};
    if (single) *single = true;
    return {scale_of(size_of(middle)) * middle, dvec3(0), dvec3(0)};
}

dvec3 newell(const std::vector<dvec3>& vertices) {
    dvec3 sum{0, 0, 0};
    const dvec3& anchor = vertices.front();  // relative to a vertex: no cancellation far from the origin
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        sum += glm::cross(vertices[i] - anchor, vertices[(i + 1) % vertices.size()] - anchor);
    }
    return sum;
}

Polygon make_polygon(std::uint32_t id, std::uint32_t object, std::vector<dvec3> vertices) {
    if (vertices.size() < 3) throw std::invalid_argument("a polygon needs at least 3 vertices");
    const dvec3 area = newell(vertices);
    const double length = glm::length(area);
    if (!(length > 0) || !std::isfinite(length)) throw std::invalid_argument("a polygon without area");
    Polygon polygon;
    polygon.id = id;
    polygon.object = object;
    polygon.plane.n = area / length;
    dvec3 centre{0, 0, 0};
    for (const dvec3& v : vertices) centre += v;
    polygon.plane.c = glm::dot(polygon.plane.n, centre / double(vertices.size()));
    polygon.drop = dominant_axis(polygon.plane.n);
    constexpr double rounding = 1e-9;
    for (const dvec3& v : vertices) {
        polygon.slack = std::max(polygon.slack, std::abs(glm::dot(polygon.plane.n, v) - polygon.plane.c));
    }
    polygon.slack = polygon.slack / std::abs(polygon.plane.n[polygon.drop]) + rounding;
    polygon.normal = {polygon.plane.n, {0, 0, 0}, {0, 0, 0}};
    polygon.vertices = std::move(vertices);
    return polygon;
}

Polygon make_smooth_polygon(std::uint32_t id, std::uint32_t object, std::vector<dvec3> vertices,
                            const std::array<dvec3, 3>& normals) {
    Polygon polygon = make_polygon(id, object, std::move(vertices));
    const dvec2 p0 = project(polygon.vertices[0], polygon.drop);
    const dvec2 e1 = project(polygon.vertices[1], polygon.drop) - p0;
    const dvec2 e2 = project(polygon.vertices[2], polygon.drop) - p0;
    const dvec3 n1 = normals[1] - normals[0];
    const dvec3 n2 = normals[2] - normals[0];
    const double determinant = e1.x * e2.y - e1.y * e2.x;  // not 0: the projection keeps most of the area
    polygon.normal.du = (n1 * e2.y - n2 * e1.y) / determinant;
    polygon.normal.dv = (n2 * e1.x - n1 * e2.x) / determinant;
    polygon.normal.base = normals[0] - p0.x * polygon.normal.du - p0.y * polygon.normal.dv;
    return polygon;
}

Polygon make_triangle(std::uint32_t id, std::uint32_t object, const std::array<dvec3, 3>& vertices,
                      const std::array<dvec3, 3>& normals) {
    return make_smooth_polygon(id, object, {vertices.begin(), vertices.end()}, normals);
}

namespace {

template <typename Distance, typename Snap>
std::vector<dvec3> clip_where(const std::vector<dvec3>& outline, Distance distance, Snap snap) {
    std::vector<dvec3> kept;
    kept.reserve(outline.size() + 2);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const dvec3& a = outline[i];
        const dvec3& b = outline[(i + 1) % outline.size()];
        const double da = distance(a);
        const double db = distance(b);
        if (da >= 0) kept.push_back(a);
        if ((da >= 0) != (db >= 0)) {
            // Always cut from the inner to the outer end, so that neighbours that share the edge get the same
            // point.
            const dvec3& in = da >= 0 ? a : b;
            const dvec3& out = da >= 0 ? b : a;
            const double d_in = da >= 0 ? da : db;
            const double d_out = da >= 0 ? db : da;
            if (d_in > 0) kept.push_back(snap(in + (out - in) * (d_in / (d_in - d_out))));
        }
    }
    if (kept.size() < 3) kept.clear();
    return kept;
}

}  // namespace

std::vector<dvec3> clip_half_space(const std::vector<dvec3>& outline, int axis, double at, double sign) {
    return clip_where(
        outline, [=](const dvec3& p) { return sign * (p[axis] - at); },
        [=](dvec3 p) {
            p[axis] = at;
            return p;
        });
}

std::vector<dvec3> clip_plane(const std::vector<dvec3>& outline, const dvec3& n, double c) {
    return clip_where(
        outline, [&](const dvec3& p) { return glm::dot(n, p) - c; }, [](const dvec3& p) { return p; });
}

std::vector<dvec3> clip_to_box(std::vector<dvec3> outline, const Box& box) {
    for (int axis = 0; axis < 3 && !outline.empty(); ++axis) {
        bool low = false;
        bool high = false;
        for (const dvec3& p : outline) {
            low = low || p[axis] < box.low[axis];
            high = high || p[axis] > box.high[axis];
        }
        if (low) outline = clip_half_space(outline, axis, box.low[axis], 1);
        if (high && !outline.empty()) outline = clip_half_space(outline, axis, box.high[axis], -1);
    }
    return outline;
}

std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<dvec3>& outline, const dvec3& normal) {
    const std::size_t n = outline.size();
    const int drop = dominant_axis(normal);
    std::vector<dvec2> flat;
    for (const dvec3& p : outline) flat.push_back(project(p, drop));
    // Sign of areas: positive where the outline turns counter-clockwise, seen from the normal's side.
    const double turn = (drop == 1 ? -normal[drop] : normal[drop]) > 0 ? 1 : -1;
    const auto area = [&](std::size_t a, std::size_t b, std::size_t c) {
        const dvec2 q = flat[b] - flat[a];
        const dvec2 r = flat[c] - flat[a];
        return (q.x * r.y - q.y * r.x) * turn;
    };
    std::vector<std::size_t> rest(n);
    for (std::size_t i = 0; i < n; ++i) rest[i] = i;
    std::vector<bool> cut(n, false);
    // Per corner: all vertices before this one are known to lie outside the corner's triangle. Vertices only
    // disappear, so a search continues where the previous one stopped.
    std::vector<std::size_t> outside_before(n, 0);
    std::vector<std::array<std::size_t, 3>> triangles;
    const auto corner = [&](std::size_t k) {
        const std::size_t before = k > 0 ? k - 1 : rest.size() - 1;
        const std::size_t after = k + 1 < rest.size() ? k + 1 : 0;
        return std::array<std::size_t, 3>{rest[before], rest[k], rest[after]};
    };
    const auto is_ear = [&](std::size_t k) {
        const auto [a, b, c] = corner(k);
        if (!(area(a, b, c) > 0)) return false;
        for (std::size_t& p = outside_before[b]; p < n; ++p) {
            if (cut[p] || area(a, b, p) < 0 || area(b, c, p) < 0 || area(c, a, p) < 0) continue;
            if (outline[p] == outline[a] || outline[p] == outline[b] || outline[p] == outline[c]) continue;
            return false;
        }
        return true;
    };
    while (rest.size() > 3) {
        std::size_t ear = 0;
        while (ear < rest.size() && !is_ear(ear)) ++ear;
        if (ear == rest.size()) ear = 0;  // the outline crosses itself: cut any corner, so that the loop ends
        triangles.push_back(corner(ear));
        const auto [a, b, c] = triangles.back();
        cut[b] = true;
        outside_before[a] = outside_before[c] = 0;
        rest.erase(rest.begin() + std::ptrdiff_t(ear));
    }
    if (rest.size() == 3) triangles.push_back({rest[0], rest[1], rest[2]});
    return triangles;
}

}  // namespace raycell
