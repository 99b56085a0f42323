// render's --probe: the probes of one run, and the files that they write.
#pragma once

#include <memory>

#include "cells/probes/probe.hpp"
#include "pipeline/machine.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Throws UsageError for probes outside the array, with the untimed engine, or that contradict each other.
void check_probes(const RenderOptions& options);

class ProbeRun {
  public:
    /// Begins PREFIX.vcd and puts the probes on the machine. Machine and outputs must outlive it.
    ProbeRun(const RenderOptions& options, Machine& machine, OutputSet& outputs);
    /// Call when the run is over.
    void finish();
    /// Writes PREFIX.gtkw.
    void write(OutputSet& outputs);

  private:
    Machine& machine_;
    std::string name_;
    NewFile& file_;
    Probe probe_;
};

}  // namespace raycell
