// What render and truth do first: read the scene, place it, warn of oddities.
#pragma once

#include "model/geometry/placement.hpp"
#include "scenes/frame_list.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Reads the scene of a frame, with its view. Throws InputError and UsageError, the latter also if a file
/// that it is read from would be overwritten.
Scene read_frame(const RenderOptions& options, const FrameLine& frame, const OutputSet& outputs,
                 Diagnostics& diagnostics);

/// Reads and places the scene of the options, or of the frame that they choose; warnings go to standard
/// error. Throws InputError and UsageError, the latter also if an input file would be overwritten
/// (spare_inputs()).
CellScene read_and_place(const RenderOptions& options, const OutputSet& outputs);

/// Throws UsageError if an announced file is one that the options have read: scene, view, array or
/// configuration. PREFIX.toml may be that of --config: repeating a run under its own name is no mistake.
void spare_inputs(const RenderOptions& options, const OutputSet& outputs);

/// Throws UsageError unless files of this name can be made. Leaves nothing behind.
void check_place(const std::string& option, const std::string& path);

/// Whether progress belongs on standard error: it is a terminal and --quiet was not given.
bool shows_progress(const RenderOptions& options);

/// Wipes the line of progress.
void end_progress();

}  // namespace raycell
