// A planar polygon in cell coordinates, its plane and its field of normals.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/geometry/scene.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {

constexpr std::uint32_t no_polygon = std::numeric_limits<std::uint32_t>::max();

/// The plane n·p = c; n is unit, or scaled by hold_plane().
struct Plane {
    dvec3 n{0, 0, 1};
    double c = 0;
};

/// Index of the largest component of n: the axis to drop so that the projection keeps most area.
int dominant_axis(const dvec3& n);

/// The two axes kept when `drop` is dropped: x: (y, z), y: (x, z), z: (x, y).
struct Projection {
    int u;
    int v;
};
constexpr Projection projection(int drop) {
    return drop == 0 ? Projection{1, 2} : drop == 1 ? Projection{0, 2} : Projection{0, 1};
}
inline dvec2 project(const dvec3& p, int drop) {
    const Projection axes = projection(drop);
    return {p[axes.u], p[axes.v]};
}

/// N(u, v) = base + u·du + v·dv over the projection of the polygon's plane; not normalised.
struct NormalField {
    dvec3 base{0, 0, 1};
    dvec3 du{0, 0, 0};
    dvec3 dv{0, 0, 0};
    dvec3 at(const dvec2& uv) const { return base + uv.x * du + uv.y * dv; }
};

/// One polygon of the tessellated scene. Ids are dense, in order of the scene file.
struct Polygon {
    std::uint32_t id = 0;
    std::uint32_t object = 0;  ///< index of its features (Material)
    Plane plane;
    int drop = 2;  ///< dominant axis of plane.n
    /// Largest distance of a vertex from the plane along the dropped axis, in cells; files round their
    /// coordinates. Touched cells and edges are computed with this tolerance, so that a plane and its outline
    /// can't disagree.
    double slack = 0;
    NormalField normal;
    std::vector<dvec3> vertices;  ///< cell coordinates, in order round the polygon, possibly concave
};

/// Rounds a plane to words. It is scaled so that n[drop] is 1 or -1, and the other two slopes are rounded to
/// `slope`. The offset is computed from the rounded slopes at `anchor`, a point of the plane, and rounded to
/// `offset`. If slopes and offset were rounded independently, the plane would shift by the tilt's error times
/// the distance from the origin.
Plane hold_plane(const Plane& plane, int drop, const dvec3& anchor, const Format& slope,
                 const Format& offset);

/// Rounds a field of normals to words in the same way: it is right at `anchor`, whatever the gradients lose.
NormalField hold_field(const NormalField& field, const dvec2& anchor, const Format& gradient,
                       const Format& base);

/// Scales a field for words that hold less than `most`, a power of two. Only the field's direction counts, so
/// it is scaled by a power of two until its largest component lies in [most / 2, most). If the field turns so
/// fast that of `middle`, its value in the middle of its polygon, less than `least` would be left in every
/// component, words can't tell the polygon from a point: the result is `middle` without gradients, and
/// `single` is set. `elsewhere`: the largest component that the field has at other places where words must
/// hold it.
NormalField fill_words(const NormalField& field, const dvec3& middle, double most, double least,
                       bool* single = nullptr, double elsewhere = 0);

/// Smallest length of a normal in words of this format: a shorter normal has a direction that is off by more
/// than 1/64.
inline double least_normal(const Format& format) { return 64 * format.step(); }

/// Sum of the edges' cross products (Newell): twice the area, along the normal; sound for concave outlines.
dvec3 newell(const std::vector<dvec3>& vertices);

/// Makes a flat polygon; the normal field is the plane's normal.
/// Throws std::invalid_argument if the outline has no area.
Polygon make_polygon(std::uint32_t id, std::uint32_t object, std::vector<dvec3> vertices);

/// Makes a polygon whose field of normals, linear over its plane, has these values at its first three
/// vertices; they are not on one line.
Polygon make_smooth_polygon(std::uint32_t id, std::uint32_t object, std::vector<dvec3> vertices,
                            const std::array<dvec3, 3>& normals);

/// Makes a triangle whose normals are interpolated linearly between those of its vertices.
Polygon make_triangle(std::uint32_t id, std::uint32_t object, const std::array<dvec3, 3>& vertices,
                      const std::array<dvec3, 3>& normals);

/// Axis-aligned box of cell coordinates.
struct Box {
    dvec3 low{0, 0, 0};
    dvec3 high{0, 0, 0};
};

/// The part of an outline on the side sign·(p[axis] − at) ≥ 0 (Sutherland & Hodgman 1974). Cut points lie
/// exactly on the plane and do not depend on the direction of the outline.
std::vector<dvec3> clip_half_space(const std::vector<dvec3>& outline, int axis, double at, double sign);

/// The part of an outline where n·p ≥ c.
std::vector<dvec3> clip_plane(const std::vector<dvec3>& outline, const dvec3& n, double c);

/// Cuts a simple polygon, possibly concave, into triangles of its vertices' indices (ear clipping).
std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<dvec3>& outline, const dvec3& normal);

/// The part of an outline inside a box; empty if nothing but a point or line is left.
std::vector<dvec3> clip_to_box(std::vector<dvec3> outline, const Box& box);

}  // namespace raycell
