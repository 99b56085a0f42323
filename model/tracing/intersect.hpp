// The ladder of hit tests (design, section 4): pure functions, one voxel or one cell at a time.
#pragma once

#include <optional>

#include "model/loading/voxel.hpp"
#include "model/tracing/ray.hpp"

namespace raycell {

/// Distance along the ray at which it hits the voxel within the cell, if it does before t_end. A fresh ray
/// that leaves a polygon may not hit behind its origin. Other rays may, within the tolerance, so that no hit
/// falls between two cells.
std::optional<double> hit_voxel(const CellStore& store, const Voxel& voxel, const Ray& ray, double t_end,
                                HitTest test, const Arithmetic& arithmetic);

struct CellHit {
    double t = 0;
    std::uint32_t voxel = 0;
    bool tied = false;  ///< another was met at the same distance
};

/// Comparisons made in a cell; they determine the traversal unit's cycles.
struct Comparisons {
    std::uint32_t runs = 0;   ///< voxels whose depth run was compared with the ray's
    std::uint32_t tests = 0;  ///< of these, voxels that the rung's own test was made on
    std::uint32_t edges = 0;  ///< edge functions of these (rung `edge`)
};

/// The nearest hit in a cell; within Arithmetic::tie(), the one with the lowest polygon id. Any hit would do
/// for a shadow ray, but the cell has one comparison unit for all rays. Voxels are looked at in order of
/// depth, in the ray's direction, up to the first that lies beyond its end or its nearest hit, and all after
/// it. `index`: the store's index table, where it is kept elsewhere; the voxels are read only
/// where the ray's own run meets one of its lines.
std::optional<CellHit> nearest_in_cell(const CellStore& store, const Ray& ray, double t_end, HitTest test,
                                       const Arithmetic& arithmetic, Comparisons* comparisons = nullptr,
                                       const IndexTable& index = {});

}  // namespace raycell
