// A loaded machine, given to others or taken from them (model/files/array_file.hpp).
#pragma once

#include <functional>

#include "model/files/array_file.hpp"
#include "pipeline/machine_parts.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

/// Throws std::invalid_argument for an array of another scene, size or voxels.
void expect_loaded_for(const MachineParts& parts, const LoadedArray& array);

/// Hands the loaded array out. Its voxels are lent, not copied: they are most of what a loaded machine takes.
void hand_over_loaded(MachineParts& parts, RunResult& result,
                      const std::function<void(const LoadedArray&)>& to);

/// Goes on where the machine that the array is from had loaded it. Throws std::runtime_error for counts that
/// can't be those of a loaded machine.
void start_loaded(MachineParts& parts, LoadedArray& array, RunResult& result);

}  // namespace raycell
