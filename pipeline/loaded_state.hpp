// Saving and restoring a loaded machine (model/files/array_file.hpp).
#pragma once

#include <functional>

#include "model/files/array_file.hpp"
#include "pipeline/machine_parts.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

/// Throws std::invalid_argument for an array of another scene, size or voxels.
void expect_loaded_for(const MachineParts& parts, const LoadedArray& array);

/// Passes the loaded array to `to`. The voxels are lent during the call, not copied: they are most of a
/// loaded machine's memory.
void hand_over_loaded(MachineParts& parts, RunResult& result,
                      const std::function<void(const LoadedArray&)>& to);

/// Puts the machine into the state after the loading of `array`. Throws std::runtime_error for counts that no
/// loaded machine can have.
void start_loaded(MachineParts& parts, LoadedArray& array, RunResult& result);

}  // namespace raycell
