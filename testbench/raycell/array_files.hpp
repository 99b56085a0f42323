// render's --save-array and --load-array.
#pragma once

#include "pipeline/machine.hpp"
#include "testbench/raycell/options.hpp"

namespace raycell {

/// Throws UsageError where loaded arrays can't be kept or used.
void check_arrays(const RenderOptions& options);

/// Has a machine start with the array of a file, and keep the one that it loads. Throws UsageError for a file
/// of another scene, size or other settings that loading depends on, and std::runtime_error for one that is
/// damaged.
class ArrayFiles {
  public:
    ArrayFiles(const RenderOptions& options, const CellScene& scene, Machine& machine);
};

}  // namespace raycell
