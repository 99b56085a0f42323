// raycell render --frames: every frame of a list, and the machine's schedule when they are made in a row.
#pragma once

#include "testbench/common/options.hpp"

namespace raycell {

/// Runs the frames as processes of their own, `jobs` at a time, and publishes the files of all of them
/// together: PREFIX.0001 and each of `suffixes`, PREFIX.0002 ..., PREFIX.json, PREFIX.toml. Returns the exit
/// code of the worst verdict. Throws UsageError, InputError, and std::runtime_error for a frame that ends
/// without results.
int run_frames(const RenderOptions& options, const OptionTable& table,
               const std::vector<std::string>& suffixes, int jobs);

}  // namespace raycell
