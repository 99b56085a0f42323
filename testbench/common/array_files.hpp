// render's --save-array and --load-array.
#pragma once

#include <optional>
#include <string>

#include "pipeline/machine.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Throws UsageError where loaded arrays can't be kept or used.
void check_arrays(const RenderOptions& options);

/// The array to start with is read before the machine is built: what is refused is refused at once.
class ArrayFiles {
  public:
    /// Throws UsageError for a file of another scene, size or other settings that voxels depend on, and
    /// std::runtime_error for one that is damaged.
    ArrayFiles(const RenderOptions& options, const CellScene& scene);

    /// Has a machine start with the array that was read, or write the one that it loads. Call once.
    void attach(Machine& machine, OutputSet& outputs);

  private:
    std::optional<LoadedArray> loaded_;
    std::string save_;  ///< empty: nothing is kept
};

}  // namespace raycell
