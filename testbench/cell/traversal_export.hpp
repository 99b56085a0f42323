// Records of traversal units as files for hardware: microprograms, voxels, rays.
#pragma once

#include <string>
#include <vector>

#include "testbench/golden/traversal.hpp"

namespace raycell {

struct TraversalRecord {
    const GoldenFile* file;
    const CellSetup* setup;
};

/// Writes the records of cells of one run into a folder, all files together. Each ray is also visited by the
/// microprograms, as the hardware calls them. Throws GoldenError if they decide anything else than the model
/// or the record. Returns a line that says what was written.
std::string export_traversal(const std::vector<TraversalRecord>& records, const std::string& folder);

}  // namespace raycell
