// raycell size --frame-cycles: the smallest machine for an accuracy and the cycles of a frame, by timed runs.
#pragma once

#include "model/geometry/scene.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/raycell/size_frame_search.hpp"

namespace raycell {

/// Searches and writes PREFIX.csv, .json, .md, .svg and, if a machine was found, .toml; runs are in
/// PREFIX.runs/ and are not repeated. `least_store`: slots that are guaranteed to end. Returns the exit code.
int size_frames(const RenderOptions& options, const FrameGoal& goal, bool curved, int least_store,
                OutputSet& outputs);

}  // namespace raycell
