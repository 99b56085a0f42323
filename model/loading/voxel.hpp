// Voxels: what a cell makes from a span and keeps (design, section 4).
#pragma once

#include <array>
#include <vector>

#include "model/loading/coverage.hpp"
#include "model/loading/index_table.hpp"
#include "model/loading/span.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// The run of depth levels that a polygon takes up in one cell, and what the rungs above `interval` add to
/// it. Lengths are in cell widths; plane, edges and normal field are relative to the cell's corner and to
/// `base`.
struct Voxel {
    std::uint32_t polygon = 0;
    std::uint32_t object = 0;
    std::int32_t near_level = 0;  ///< first depth level
    std::int32_t far_level = 0;   ///< one past the last
    double near = 0;              ///< depth of the run's beginning, from near_level
    double far = 0;               ///< depth of the run's end, from far_level
    double base = 0;              ///< z origin of the functions: 0 in exact arithmetic, `near` in words
    Plane plane;
    NormalField normal;
    std::uint8_t drop = 2;
    std::uint32_t pieces = 0;  ///< convex pieces told apart by edges; 0: the polygon covers the whole cell
    std::uint32_t edge_count = 0;
    std::uint32_t first_edge = 0;  ///< index into CellStore::edges
    std::uint64_t mask = 0;        ///< bit 8·row + column, over the window
    /// The mask's window: u from, u to, v from, v to, in 32nds of the cell (of the run where an axis is z).
    /// It frames the polygon's part, so that all 64 bits describe that part.
    std::array<std::uint8_t, 4> window{0, 32, 0, 32};
    dvec3 point{0, 0, 0};  ///< the voxel's own point (z absolute): precast and memo shadows, `voxel` normals
    double area = 0;       ///< of the largest piece, in the projection; only while loading
};

/// What one cell holds after loading.
struct CellStore {
    std::vector<Voxel> voxels;                   ///< in the order in which they came
    std::vector<IndexEntry> index;               ///< all of them, in order of depth
    std::vector<EdgeFunction> edges;             ///< only at rung `edge`
    std::vector<dvec3> intensities;              ///< per voxel, only for --display gouraud
    std::vector<std::uint64_t> lit;              ///< per voxel, a bit per source (precast, memo)
    std::vector<std::uint64_t> known;            ///< per voxel, a bit per source already asked for (memo)
    std::uint32_t overflowed = 0;                ///< voxels that did not fit
    std::uint32_t last_overflowed = no_polygon;  ///< polygon of the last voxel that did not fit
};

/// Makes the voxel of the span's current cell and stores it, or (except at rung `mask`) adds it to the voxel
/// that the same polygon already has there; puts it in the index table, and returns how many of its lines
/// that read (put_in_order()). 0 if the polygon does not touch the cell (at rung `depth`: does not cover its
/// centre), or if the store is full; then `overflowed` counts it.
std::uint32_t store_voxel(CellStore& store, const Span& span, const PictureSettings& settings, double level,
                          const Arithmetic& arithmetic);

/// Makes the index table of voxels that are stored already.
void make_index(CellStore& store);

/// Bits of one voxel without its edges, and bits of one edge; docs/reference/cell.md has the table.
struct VoxelBits {
    int base = 0;
    int per_edge = 0;
};
VoxelBits voxel_bits(const PictureSettings& settings, const Formats& formats, std::size_t sources);

/// Storage totals over an array of cells.
struct StorageCounts {
    std::uint64_t voxels = 0;
    std::uint64_t edges = 0;
    std::uint64_t overflowed = 0;
    std::uint64_t occupied_cells = 0;
    std::uint64_t max_voxels = 0;     ///< of one cell
    std::uint64_t max_needed = 0;     ///< of one cell, with those that did not fit
    std::uint64_t bits = 0;           ///< of all cells' voxels and edges
    std::uint64_t max_cell_bits = 0;  ///< of one cell's
    void add(const CellStore& store, const VoxelBits& each);
    void add(const StorageCounts& other);  ///< of other cells
};

/// Bits of an object's features: colour, Kd, Ks, T, Shine, index of refraction, mirror or not.
int feature_bits(const Formats& formats);

}  // namespace raycell
