// The cost table's cycles of microprograms.
#pragma once

#include <map>

#include "model/settings/costs.hpp"
#include "testbench/microcode/trials.hpp"

namespace raycell {

/// Cycles of a program by a cost table, operators included; 0 for an entry that the table does not have.
std::uint32_t table_cycles(const CostTable& costs, const MicroTrial& trial);

/// The entries of CostTable::counted(), counted at words of 20 bits on a datapath ("word", "wide", "two"). An
/// entry is the mean over `runs` inputs of each of its programs, less the entries of the operators that are
/// added to it, rounded to the nearest cycle, at least 1.
std::map<std::string, std::uint32_t> count_costs(const std::string& datapath, std::uint64_t runs,
                                                 std::uint64_t seed);

}  // namespace raycell
