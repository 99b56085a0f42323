// name.cells.csv: what each cell held, did and waited for; docs/use/results.md describes the columns.
#pragma once

#include <string>
#include <vector>

#include "model/machine/untimed.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

/// What stands above the cells' lines.
std::string cells_csv_header();
/// A line per cell, of each row that the machine has, from the top down. A link's buffers stand at the cell
/// that it leads to.
std::vector<std::string> cells_csv_rows(Machine& machine, const RunResult& result);
/// What the untimed machine knows: voxels and edges.
std::string cells_csv(const UntimedMachine& machine);

}  // namespace raycell
