// render's --golden: the golden vectors of one run, a file for each cell.
#pragma once

#include <string>
#include <vector>

#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/golden/recorder.hpp"

namespace raycell {

/// Throws UsageError for cells outside the array, for too many of them, and with the untimed engine.
void check_golden(const RenderOptions& options);

/// The suffixes of the files that it writes.
std::vector<std::string> golden_suffixes(const RenderOptions& options);

class GoldenRun {
  public:
    /// Begins PREFIX.golden_X_Y.txt. `configuration`: the run's, TOML. Machine and outputs must outlive this.
    GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine,
              OutputSet& outputs);
    CellObserver& observer() { return *recorder_; }
    /// Call when the run is over.
    void finish() { recorder_->finish(); }

  private:
    GoldenRecorder* recorder_;  ///< never destroyed, like the machine that it watches
};

}  // namespace raycell
