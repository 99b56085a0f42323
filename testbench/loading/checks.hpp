// Checks at the end of loading: what the cells hold, how long it took.
#pragma once

#include <utility>

#include "model/loading/voxel.hpp"
#include "testbench/loading/watch.hpp"

namespace raycell::loading {

/// Compares two arrays of cells, row-major, voxel for voxel and bit for bit.
Faults compare_stores(const std::vector<const CellStore*>& timed, const std::vector<CellStore>& untimed,
                      int width);

/// A fault if loading was over before its bound.
Faults check_bound(Cycle cycles, const LoadPlan::Bound& bound);

/// Checks by name, in the order of the reports.
using NamedFaults = std::vector<std::pair<std::string, Faults>>;

/// Sum of all faults.
std::uint64_t count_of(const NamedFaults& checks);

}  // namespace raycell::loading
