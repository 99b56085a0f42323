// Loaded arrays as files: loading a large scene takes longer than tracing it, and is the same every time.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "model/geometry/placement.hpp"
#include "model/loading/voxel.hpp"

namespace raycell {

struct LoadedArray {
    std::uint64_t key = 0;              ///< of what its voxels depend on: loading_key()
    std::uint64_t timing = 0;           ///< of what its cycles depend on beside that: loading_timing()
    std::vector<CellStore> cells;       ///< row-major
    std::vector<std::uint64_t> counts;  ///< what else the machine wants to know again, in its own order
};

/// A hash of everything that the voxels of an array depend on: the placed scene and the settings that are not
/// of tracing alone. An array of another key is of no use.
std::uint64_t loading_key(const CellScene& scene, const PictureSettings& picture);

/// A hash of what else the cycles of loading depend on: buffers, links and costs. An array of another timing
/// has the right voxels; only what it tells of its loading is another machine's.
std::uint64_t loading_timing(const MachineSettings& machine);

/// Writes the array, its bytes least significant first, a checksum at the end. Errors of the stream are the
/// caller's to look for.
void write_array(std::FILE* file, const LoadedArray& array);

/// Throws std::runtime_error "NAME: what" for what is no such file, is damaged or cut off. What its fields
/// say is check_array()'s to look at.
LoadedArray read_array(std::FILE* file, const std::string& name);

}  // namespace raycell
