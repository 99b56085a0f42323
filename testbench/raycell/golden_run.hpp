// render's --golden: the golden vectors of one run, a file for each cell.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/golden/recorder.hpp"
#include "testbench/golden/traversal_recorder.hpp"

namespace raycell {

/// Throws UsageError for cells outside the array, for too many of them, and with the untimed engine.
void check_golden(const RenderOptions& options);

/// The suffixes of the files that it writes.
std::vector<std::string> golden_suffixes(const RenderOptions& options);

class GoldenRun {
  public:
    /// Begins the files of each cell. `configuration`: the run's, TOML. Machine and outputs must outlive
    /// this.
    GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine,
              OutputSet& outputs);
    CellObserver& observer();
    /// Call when the run is over.
    void finish();

  private:
    void record_cells(const RenderOptions& options, const std::string& configuration, Machine& machine,
                      OutputSet& outputs);

    GoldenRecorder* recorder_ = nullptr;            ///< never destroyed, like the machine that it watches
    std::unique_ptr<TraversalRecorder> traversal_;  ///< instead, with --golden-part traversal
};

}  // namespace raycell
