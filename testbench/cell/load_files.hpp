// Loading's programs, calls and script as files for hardware.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "testbench/cell/load_calls.hpp"

namespace raycell {

/// How many words the unit's memories hold (voxels, edges, the index table), and how many it writes out over
/// each port (the traversal's store, voxels, objects, sources).
struct LoadSizes {
    std::array<std::size_t, 3> memories{1, 1, 1};
    std::array<std::size_t, 4> ports{1, 1, 1, 1};
};

/// The package `load` and the lists for $readmemh: names and texts. The image is of loading's programs alone.
std::vector<std::pair<std::string, std::string>> load_files(const LoadCalls& calls, const MicroImage& image,
                                                            const LoadSizes& sizes);

}  // namespace raycell
