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

/// What the trapezes of a polygon share. It travels once, before them, and each row keeps it.
struct Surface {
    std::uint32_t polygon = 0;
    std::uint32_t object = 0;
    Plane plane;
    int drop = 2;
    NormalField normal;
    dvec3 slack{0, 0, 0};  ///< Polygon::slack on the dropped axis; exact arithmetic: plus what cells share
    int last_row = 0;      ///< last row with a part of a trapeze
};

constexpr int most_cells = 4096;  ///< of a row or a column

/// Rows or columns that follow each other, from the first to the last one.
struct Stretch {
    int first = 0;
    int last = 0;
};

/// A convex part of a polygon between two lines parallel to the rows. Polygons without height on the screen
/// (seen edge-on along a row) are cut along z instead, those without height and depth along x.
struct Trapeze : Surface {
    std::array<EdgeFunction, 4> edges;
    int edge_count = 0;
    Stretch rows;  ///< that it touches
    Stretch columns;
    std::array<dvec3, 4> corners{};  ///< in order round it; only Gouraud's interpolation needs them
    int corner_count = 0;            ///< a triangle repeats none
    /// True if a row below `row` still has a part of the trapeze.
    bool reaches_below(int row) const { return rows.last > row; }
};

/// Cuts a polygon that lies inside the cube into trapezes; in fixed arithmetic they consist of loading words.
/// Their rows and columns are those of an array of `width` x `height` cells.
std::vector<Trapeze> precompute(const Polygon& polygon, const Arithmetic& arithmetic, int width = most_cells,
                                int height = most_cells);

}  // namespace raycell
