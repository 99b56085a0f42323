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
/// or the record. `shading`: with jobs of the shading unit for the hits among them; throws
/// std::invalid_argument for a machine whose shading that unit does not have. Returns lines that say what was
/// written.
std::string export_traversal(const std::vector<TraversalRecord>& records, const std::string& folder,
                             bool shading);

}  // namespace raycell
