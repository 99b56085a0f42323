#include "scenes/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace raycell {

namespace {

constexpr double no_area = 1e-9;             ///< least doubled area of an outline scaled to size 1
constexpr double planar = 1e-4;              ///< of the outline's size
constexpr double printed_digits = 1e-5;      ///< of the largest coordinate: six significant digits
constexpr double most_printed_error = 1e-2;  ///< of the outline's size
constexpr double straight_back = -0.9;  ///< cosine to the winding normal; a normal below it must be an error
constexpr std::size_t most_compared_vertices = 256;  ///< finding crossings takes time with its square
constexpr std::size_t most_clipped_vertices = 1000;  ///< ear clipping takes time with its cube at worst

double largest_component(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// An outline relative to its first vertex and scaled to size 1, so that thresholds have no units and
/// products neither overflow nor underflow.
struct Scaled {
    std::vector<dvec3> points;
    double size = 0;      ///< largest extent from the first vertex, world units
    double farthest = 0;  ///< largest coordinate, world units
    dvec3 area{0, 0, 0};  ///< Newell: twice the area, along the normal
    dvec3 normal{0, 0, 0};
    bool flat() const { return size > 0 && glm::length(area) > no_area; }
};

Scaled scale(const std::vector<dvec3>& vertices) {
    Scaled out;
    for (const dvec3& v : vertices) {
        out.size = std::max(out.size, largest_component(v - vertices[0]));
        out.farthest = std::max(out.farthest, largest_component(v));
    }
    // Below this the extent is rounding, or the division would overflow.
    if (out.size < 1e-100 || out.size < 1e-14 * out.farthest) out.size = 0;
    if (out.size == 0) return out;
    out.points.reserve(vertices.size());
    for (const dvec3& v : vertices) out.points.push_back((v - vertices[0]) / out.size);
    for (std::size_t i = 0, before = out.points.size() - 1; i < out.points.size(); before = i++) {
        out.area += glm::cross(out.points[before], out.points[i]);
    }
    if (out.flat()) out.normal = glm::normalize(out.area);
    return out;
}

bool is_planar(const Scaled& outline) {
    dvec3 centre{0, 0, 0};
    for (const dvec3& p : outline.points) centre += p;
    centre /= static_cast<double>(outline.points.size());
    const double printed = std::min(printed_digits * outline.farthest / outline.size, most_printed_error);
    for (const dvec3& p : outline.points) {
        if (std::abs(glm::dot(p - centre, outline.normal)) > planar + printed) return false;
    }
    return true;
}

void remove_repeated(std::vector<dvec3>& vertices, std::vector<dvec3>& normals, const Place& place,
                     Diagnostics& diagnostics) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (kept > 0 && vertices[i] == vertices[kept - 1]) continue;
        vertices[kept] = vertices[i];
        if (!normals.empty()) normals[kept] = normals[i];
        ++kept;
    }
    while (kept > 1 && vertices[kept - 1] == vertices[0]) --kept;
    if (kept == vertices.size()) return;
    vertices.resize(kept);
    if (!normals.empty()) normals.resize(kept);
    diagnostics.warn(place.file, place.line, "repeated vertex", "the outline repeats a vertex; removed");
}

void repair_normals(std::vector<dvec3>& normals, const dvec3& winding, const Place& place,
                    Diagnostics& diagnostics) {
    if (normals.empty()) return;
    bool vanishing = false;
    std::size_t opposed = 0;
    for (dvec3& n : normals) {
        const double largest = largest_component(n);
        if (largest > 0) {
            n /= largest;  // first, so that the length neither overflows nor underflows
            n = glm::normalize(n);
        }
        if (!(largest > 0) || !std::isfinite(n.x + n.y + n.z)) {
            n = dvec3(0);
            vanishing = true;
        } else if (glm::dot(n, winding) < 0) {
            ++opposed;
        }
    }
    const auto vanished = static_cast<std::size_t>(std::count(normals.begin(), normals.end(), dvec3(0)));
    const bool flip_all = opposed > 0 && opposed + vanished == normals.size();
    bool flipped_one = false;
    for (dvec3& n : normals) {
        if (n == dvec3(0)) {
            n = winding;
        } else if (flip_all) {
            n = -n;
        } else if (glm::dot(n, winding) < straight_back) {
            n = -n;
            flipped_one = true;
        }
    }
    if (vanishing) {
        diagnostics.warn(place.file, place.line, "zero normal",
                         "a vertex normal has no length; replaced by the polygon's own");
    }
    // Some modellers do this in every patch: one warning is enough.
    if (flip_all || flipped_one) {
        diagnostics.warn(place.file, place.line, "opposed normals",
                         "vertex normals point against the winding; flipped", 1);
    }
}

double cross2(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Projects the outline into its plane; it is counter-clockwise when seen against the normal.
std::vector<dvec2> flatten(const Scaled& outline) {
    const dvec3 n = outline.normal;
    const dvec3 helper = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(helper, n));
    const dvec3 v = glm::cross(n, u);
    std::vector<dvec2> out;
    out.reserve(outline.points.size());
    for (const dvec3& p : outline.points) out.emplace_back(glm::dot(p, u), glm::dot(p, v));
    return out;
}

using Triangles = std::vector<std::array<std::size_t, 3>>;

bool is_ear(const std::vector<dvec2>& p, const std::vector<std::size_t>& ring, std::size_t at) {
    const std::size_t n = ring.size();
    const std::size_t ia = ring[(at + n - 1) % n], ib = ring[at], ic = ring[(at + 1) % n];
    const dvec2 a = p[ia], b = p[ib], c = p[ic];
    if (cross2(a, b, c) <= 1e-12) return false;
    for (const std::size_t i : ring) {
        if (i == ia || i == ib || i == ic || p[i] == a || p[i] == b || p[i] == c) continue;
        if (cross2(a, b, p[i]) >= 0 && cross2(b, c, p[i]) >= 0 && cross2(c, a, p[i]) >= 0) return false;
    }
    return true;
}

/// Ear clipping of a counter-clockwise outline. If no ear is left (in an outline that crosses itself), the
/// rest becomes a fan.
Triangles clip_ears(const std::vector<dvec2>& p) {
    Triangles out;
    std::vector<std::size_t> ring(p.size());
    std::iota(ring.begin(), ring.end(), std::size_t{0});
    std::size_t at = 0, without_ear = 0;
    while (ring.size() > 3 && without_ear < ring.size()) {
        const std::size_t n = ring.size();
        if (is_ear(p, ring, at)) {
            out.push_back({ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]});
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
            without_ear = 0;
        } else {
            ++at;
            ++without_ear;
        }
        at %= ring.size();
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) out.push_back({ring[0], ring[i], ring[i + 1]});
    return out;
}

bool edges_cross(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
    return cross2(a, b, c) * cross2(a, b, d) < 0 && cross2(c, d, a) * cross2(c, d, b) < 0;
}

/// Whether edges of the outline cross; edges that only touch do not. Takes quadratic time, so outlines of
/// more than most_compared_vertices are not checked: false.
bool crosses_itself(const std::vector<dvec2>& p) {
    const std::size_t n = p.size();
    if (n > most_compared_vertices) return false;
    for (std::size_t i = 0; i + 2 < n; ++i) {
        for (std::size_t j = i + 2; j < n; ++j) {
            if ((j + 1) % n != i && edges_cross(p[i], p[i + 1], p[j], p[(j + 1) % n])) return true;
        }
    }
    return false;
}

void warn_of_odd_outline(const Scaled& outline, const Place& place, Diagnostics& diagnostics) {
    const std::vector<dvec2> p = flatten(outline);
    if (cross2(p[0], p[1], p[2]) < -no_area) {
        diagnostics.warn(
            place.file, place.line, "reflex first corner",
            "the first three vertices make a reflex corner; the normal is taken from all of them");
    }
    if (crosses_itself(p)) {
        diagnostics.warn(place.file, place.line, "crossing outline",
                         "the outline crosses itself; kept as it is");
    }
}

void add(Scene& scene, std::uint32_t material, std::vector<dvec3> vertices, std::vector<dvec3> normals) {
    scene.primitives.push_back({material, PolygonPrimitive{std::move(vertices), std::move(normals)}});
}

}  // namespace

void add_outline(Scene& scene, std::uint32_t material, std::vector<dvec3> vertices,
                 std::vector<dvec3> normals, const Place& place, Diagnostics& diagnostics) {
    remove_repeated(vertices, normals, place, diagnostics);
    const Scaled outline = vertices.size() < 3 ? Scaled{} : scale(vertices);
    if (!outline.flat()) {
        diagnostics.warn(place.file, place.line, "polygon without area", "the polygon has no area; dropped");
        return;
    }
    repair_normals(normals, outline.normal, place, diagnostics);
    if (vertices.size() == 3) return add(scene, material, std::move(vertices), std::move(normals));

    warn_of_odd_outline(outline, place, diagnostics);
    if (is_planar(outline)) return add(scene, material, std::move(vertices), std::move(normals));

    if (vertices.size() > most_clipped_vertices) {
        throw InputError(place.file, place.line, "a non-planar polygon of more than 1000 vertices",
                         "a planar one, or triangles");
    }
    diagnostics.warn(place.file, place.line, "non-planar polygon",
                     "the polygon is not planar; cut into triangles");
    for (const auto& [a, b, c] : clip_ears(flatten(outline))) {
        std::vector<dvec3> corners{vertices[a], vertices[b], vertices[c]};
        if (!scale(corners).flat()) continue;
        std::vector<dvec3> corner_normals;
        if (!normals.empty()) corner_normals = {normals[a], normals[b], normals[c]};
        add(scene, material, std::move(corners), std::move(corner_normals));
    }
}

}  // namespace raycell
