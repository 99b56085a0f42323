// Loaded arrays as files: loading a large scene takes longer than tracing it and always gives the same array.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "model/geometry/placement.hpp"
#include "model/loading/voxel.hpp"

namespace raycell {

struct LoadedArray {
    std::uint64_t key = 0;              ///< loading_key(): hash of what the voxels depend on
    std::uint64_t timing = 0;           ///< loading_timing(): hash of what else the cycles depend on
    std::vector<CellStore> cells;       ///< row-major
    std::vector<std::uint64_t> counts;  ///< further counts of the machine's loading, in its own order
};

/// Hash of everything that the voxels of an array depend on: the placed scene, and the settings except those
/// of tracing alone. An array with another key is of no use.
std::uint64_t loading_key(const CellScene& scene, const PictureSettings& picture);

/// Hash of what else the cycles of loading depend on: buffers, links and costs. An array with another timing
/// has the right voxels, but its figures of loading are those of another machine.
std::uint64_t loading_timing(const MachineSettings& machine);

/// Writes the array, least significant bytes first, with a checksum at the end. The caller checks the stream
/// for errors.
void write_array(std::FILE* file, const LoadedArray& array);

/// Reads an array. Throws std::runtime_error "NAME: what" if the file is not a loaded array, is damaged or is
/// cut off. Does not check the values of its fields: see check_array().
LoadedArray read_array(std::FILE* file, const std::string& name);

}  // namespace raycell
