// The shading unit's programs, calls and script as files for hardware.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "testbench/cell/shading_calls.hpp"

namespace raycell {

/// Of a ray that hit: registers of `setup`, written from outside.
const std::vector<std::string>& shading_ray_words();
/// Of a child: output words, in the order of the unit's ports.
const std::vector<std::string>& shading_child_words();
/// Output words of a job.
const std::vector<std::string>& shading_result_words();

/// How much the unit's memories hold.
struct ShadingSizes {
    std::size_t slots = 1;  ///< the ray store's, and one for hits that wait for nothing
    std::size_t voxels = 1, objects = 1, sources = 1;
    std::size_t cells = 1;  ///< columns or rows of the array, whichever are more
};

/// The package `shade` and the lists for $readmemh: names and texts.
std::vector<std::pair<std::string, std::string>> shading_files(const ShadingCalls& calls,
                                                               const ShadingSizes& sizes);

}  // namespace raycell
