// render's --save-array and --load-array.
#pragma once

#include <optional>
#include <string>

#include "pipeline/machine.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Throws UsageError if the options don't allow loaded arrays to be saved or used.
void check_arrays(const RenderOptions& options);

/// The loaded arrays of one run; --load-array is read, and refused, before the machine is built.
class ArrayFiles {
  public:
    /// Reads --load-array, if given. Throws UsageError for a file of another scene, size or other settings
    /// that voxels depend on, and std::runtime_error for a damaged one.
    ArrayFiles(const RenderOptions& options, const CellScene& scene);

    /// Makes a machine start with the array that was read, or write the one that it loads. Call once.
    void attach(Machine& machine, OutputSet& outputs);

  private:
    std::optional<LoadedArray> loaded_;
    std::string save_;  ///< empty: nothing is kept
};

}  // namespace raycell
