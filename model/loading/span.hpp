// Distribution: the span that a row cuts from a trapeze and sends through its pipeline of cells (paper,
// section 3.1).
#pragma once

#include <array>
#include <optional>

#include "model/geometry/placement.hpp"
#include "model/loading/trapeze.hpp"

namespace raycell {

/// A row's part of a trapeze, seen from one cell. All functions are relative to that cell's corner (x and y
/// fractions of the cell, z absolute); advancing to the next cell costs one addition each. What a message
/// carries of it, docs/reference/messages.md says.
struct Span {
    std::uint32_t polygon = 0;
    std::uint32_t object = 0;  ///< whose features the cell has latched
    int x = 0;                 ///< current cell, which all functions are relative to: X1 at first
    int last = 0;              ///< Xr, the last cell that it touches (rung `depth`: whose centre it covers)
    Plane plane;
    int drop = 2;
    NormalField normal;
    std::array<EdgeFunction, 4> edges;  ///< those that cross the row's part
    int edge_count = 0;
    dvec3 slack{0, 0, 0};  ///< Surface::slack
    /// Rung `depth`: depth Z and normal N at the pixel's centre, and their increments.
    double z = 0;
    double dz = 0;
    dvec3 n{0, 0, 0};
    dvec3 dn{0, 0, 0};
    dvec3 intensity{0, 0, 0};  ///< Gouraud: intensity at the cell's centre (only --display gouraud)
    dvec3 d_intensity{0, 0, 0};
};

/// Intensities of a trapeze's corners, in the order of its corners (Gouraud).
using CornerIntensities = std::array<dvec3, 4>;

/// Returns the part of a trapeze in row `row` of an array `depth` cells deep; empty if there is none.
std::optional<Span> cut_span(const Trapeze& trapeze, int row, double depth, HitTest hit,
                             const Arithmetic& arithmetic, const CornerIntensities* intensities = nullptr);

/// Moves a span one cell to the east.
void advance(Span& span, const Arithmetic& arithmetic);

/// Shades the corners of a trapeze for Gouraud interpolation: seen along z, without shadows.
CornerIntensities shade_corners(const Trapeze& trapeze, const CellScene& scene, const Arithmetic& arithmetic);

}  // namespace raycell
