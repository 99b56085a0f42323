// Precomputation: cuts polygons into trapezes (paper, section 2.2).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "model/geometry/polygon.hpp"
#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// An edge of a trapeze: a·u + b·v + c >= 0 inside, in the projection of the polygon's plane. (a, b) is unit,
/// so the value is a distance in cells. `piece` tells which convex piece of a voxel the edge belongs to.
struct EdgeFunction {
    double a = 0;
    double b = 0;
    double c = 0;
    std::uint32_t piece = 0;
    double at(const dvec2& uv) const { return a * uv.x + b * uv.y + c; }
};

/// Rounds an edge to words: (a, b) to `slope`; then c, computed from the rounded (a, b) at `anchor`, a point
/// near the edge, to `offset`.
EdgeFunction hold_edge(const EdgeFunction& edge, const dvec2& anchor, const Format& slope,
                       const Format& offset);

/// A convex part of a polygon between two lines parallel to the rows. Polygons without height on the screen
/// (seen edge-on along a row) are cut along z instead, those without height and depth along x.
struct Trapeze {
    std::uint32_t polygon = 0;
    std::uint32_t object = 0;
    Plane plane;
    int drop = 2;
    NormalField normal;
    std::array<dvec3, 4> corners;  ///< in order round the trapeze; a triangle repeats none
    int corner_count = 0;
    std::array<EdgeFunction, 4> edges;
    int edge_count = 0;
    double top = 0;        ///< smallest y, cells
    double bottom = 0;     ///< largest y, cells
    dvec3 slack{0, 0, 0};  ///< Polygon::slack on the dropped axis; exact arithmetic: plus what cells share
    /// First row of an array of `height` rows that it touches.
    int first_row(int height) const { return std::clamp(int(top - slack.y), 0, height - 1); }
    /// True if a row below `row` still has a part of the trapeze.
    bool reaches_below(int row) const { return bottom + slack.y > row + 1; }
};

/// Cuts a polygon that lies inside the cube into trapezes; in fixed arithmetic they consist of loading words.
std::vector<Trapeze> precompute(const Polygon& polygon, const Arithmetic& arithmetic);

}  // namespace raycell
