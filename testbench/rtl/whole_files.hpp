// Everything that the whole cell in SystemVerilog has to know of a machine beside raycell_pkg: microprograms,
// the calls of them, the sizes of its memories.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/settings/settings.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// How much a cell holds. One that needs more says so while it is loaded.
struct WholeSizes {
    int voxels = 128;
    int edges = 512;
};

/// Names and texts of the packages `microcode`, `visit`, `shade`, `load` and of the lists for $readmemh.
/// Throws std::invalid_argument, naming the setting and what is allowed, for what the cell has not.
std::vector<std::pair<std::string, std::string>> whole_files(const Context& context,
                                                             const MachineSettings& machine,
                                                             const WholeSizes& sizes);

/// Writes them into a folder, all together.
void write_units(const std::string& folder, const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace raycell
