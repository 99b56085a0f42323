// What a run records for its page: --film and --rays.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cells/meters/observer_list.hpp"
#include "testbench/common/film.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/ray_table.hpp"

namespace raycell {

/// Throws UsageError for options that can't be followed.
void check_recording(const RenderOptions& options);

/// The suffixes of the files that the options ask for.
std::vector<std::string> recording_suffixes(const RenderOptions& options);

class Recording {
  public:
    /// `machine` and `observers` must outlive the run, and this object the machine's run.
    Recording(const RenderOptions& options, Machine& machine, CellObserverList& observers);
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    /// Call when the run is over.
    void finish();
    void write(OutputSet& outputs) const;

  private:
    Machine& machine_;
    std::optional<Film> film_;
    std::optional<RayTable> rays_;
};

}  // namespace raycell
