// What render and truth do first: read the scene, place it, say what was odd about it.
#pragma once

#include "model/placement.hpp"
#include "testbench/raycell/options.hpp"

namespace raycell {

/// Reads and places the scene of the options; warnings go to standard error. Throws InputError, UsageError.
CellScene read_and_place(const RenderOptions& options);

/// Throws UsageError unless files can be made at the prefix. Leaves nothing behind.
void check_output(const std::string& prefix);

/// Whether progress belongs on standard error: it is a terminal and --quiet was not given.
bool shows_progress(const RenderOptions& options);

/// Wipes the line of progress.
void end_progress();

}  // namespace raycell
