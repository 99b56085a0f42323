// render's --golden: the golden vectors of one run, a file for each cell.
#pragma once

#include <memory>
#include <vector>

#include "testbench/golden/recorder.hpp"
#include "testbench/raycell/new_file.hpp"
#include "testbench/raycell/options.hpp"

namespace raycell {

/// Throws UsageError for cells outside the array or too many of them, and without a timed engine.
void check_golden(const RenderOptions& options);

class GoldenRun {
  public:
    /// Begins PREFIX.golden_X_Y.txt under names of their own. `configuration` is the run's, TOML; the machine
    /// must outlive this.
    GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine);
    CellObserver& observer() { return *recorder_; }
    /// The run is over.
    void finish() { recorder_->finish(); }
    /// Gives the files their names.
    void write(OutputSet& outputs);

  private:
    struct File {
        std::string suffix;
        std::unique_ptr<NewFile> file;
    };
    std::vector<File> files_;
    GoldenRecorder* recorder_;  ///< never destroyed, like the machine that it watches
};

}  // namespace raycell
