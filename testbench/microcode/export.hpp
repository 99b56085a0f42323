// Microprograms and their trials as files for hardware.
#pragma once

#include <string>

#include "testbench/microcode/trials.hpp"

namespace raycell {

struct MicroExport {
    std::string folder;
    std::string programs;  ///< names with commas between them; empty: all
    std::uint64_t runs = 1;
    std::uint64_t seed = 1;
};

/// Writes the programs' memory, tables, registers and package, and `runs` vectors of each: the registers
/// before, after, and the cycles. All files appear together. Throws MicroDifference if a program gives
/// something else than the model, std::invalid_argument for a name that no program has. Returns a line that
/// says what was written.
std::string export_programs(const MicroSetting& setting, const MicroExport& wanted);

}  // namespace raycell
