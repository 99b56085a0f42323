// Records of cells as files for hardware that makes voxels: microprograms, the script, load messages.
#pragma once

#include <string>
#include <vector>

#include "testbench/golden/file.hpp"

namespace raycell {

struct LoadRecord {
    std::string name;
    const CellSetup* setup;
    const std::vector<GoldenEvent>* events;
};

/// Writes the load messages of cells of one run into a folder, all files together. Each is also taken by the
/// script and its microprograms, as the hardware runs them. Throws GoldenError if they make anything else
/// than the model or the record. Returns a line that says what was written.
std::string export_loading(const std::vector<LoadRecord>& records, const std::string& folder);

}  // namespace raycell
