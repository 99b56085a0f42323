// Untimed loading: makes the same polygons, trapezes, spans and voxels as the timed stages.
#pragma once

#include <vector>

#include "model/geometry/placement.hpp"
#include "model/loading/voxel.hpp"
#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// Cuts a polygon to the cube; false if nothing is left. Plane and normals stay those of the whole polygon.
/// In fixed arithmetic the result consists of loading words, as the geometry stage sends them. A polygon
/// whose normals turn too fast for these words gets the normal of its middle.
bool clip_to_cube(Polygon& polygon, const Box& cube, const Arithmetic& arithmetic);

/// Numbers of items that loading handled, for the statistics.
struct LoadCounts {
    std::uint64_t polygons = 0;  ///< that reach into the cube
    std::uint64_t trapezes = 0;
    std::uint64_t spans = 0;
    std::uint64_t voxels = 0;
    std::uint64_t overflowed = 0;
};

/// Whether a polygon of the scene, not yet clipped, may have a part in these rows. True for all that have;
/// what lies within some last bits of a border counts as part of both sides.
bool may_touch_rows(const Polygon& polygon, const Stretch& rows, const Arithmetic& arithmetic);

/// Loads the array; cells are row-major. Throws nothing: each cell counts the voxels that do not fit.
std::vector<CellStore> load_array(const CellScene& scene, const PictureSettings& settings,
                                  const Arithmetic& arithmetic, LoadCounts* counts = nullptr);

/// Gives every voxel its shadow bits: lit until proved otherwise, nothing known.
void reset_shadow_bits(CellStore& store);

}  // namespace raycell
