// The index table of a cell: its voxels in order of depth (paper, section 4.2, has the table).
#pragma once

#include <cstdint>
#include <vector>

namespace raycell {

/// A line of the table. Hardware keeps the number and `most`, and reads the run from the voxel; the model
/// keeps all that a search reads beside each other. Depths in cells.
struct IndexEntry {
    double near = 0;
    double far = 0;
    double most = 0;          ///< the largest far of this voxel and all before it in the table
    std::uint32_t voxel = 0;  ///< number in CellStore::voxels
};

/// A table as the traversal unit sees it, wherever it lies.
struct IndexTable {
    const IndexEntry* first = nullptr;
    std::uint32_t count = 0;
};

/// Puts a voxel where its `near` belongs, behind those that are as near; moves it if the table has it
/// already, in which case its run may only have grown. One pass from the table's end: returns how many lines
/// it read, the voxel's own included.
std::uint32_t put_in_order(std::vector<IndexEntry>& table, std::uint32_t voxel, double near, double far);

}  // namespace raycell
