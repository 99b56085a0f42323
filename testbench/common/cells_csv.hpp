// name.cells.csv: what each cell held, did and waited for; docs/use/results.md describes the columns.
#pragma once

#include <string>
#include <vector>

#include "model/machine/untimed.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

/// The header line of a timed run's file.
std::string cells_csv_header();
/// A text for each row of cells that the machine has, from the top down, with a line per cell. Buffers are
/// listed at the cell that their link leads to.
std::vector<std::string> cells_csv_rows(Machine& machine, const RunResult& result);
/// The whole file of the untimed machine, which knows only voxels and edges.
std::string cells_csv(const UntimedMachine& machine);

}  // namespace raycell
