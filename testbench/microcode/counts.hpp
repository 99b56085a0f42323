// The cost table's cycles of microprograms.
#pragma once

#include "model/settings/costs.hpp"
#include "testbench/microcode/trials.hpp"

namespace raycell {

/// Cycles of a program by a cost table, operators included; 0 for an entry that the table does not have.
std::uint32_t table_cycles(const CostTable& costs, const MicroTrial& trial);

}  // namespace raycell
