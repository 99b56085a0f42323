// name.cells.csv: what each cell held, did and waited for; docs/results.md describes the columns.
#pragma once

#include <string>

#include "model/untimed.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

/// A line per cell, row by row. A link's buffers stand at the cell that it leads to.
std::string cells_csv(Machine& machine, const RunResult& result);
/// What the untimed machine knows: voxels and edges.
std::string cells_csv(const UntimedMachine& machine);

}  // namespace raycell
