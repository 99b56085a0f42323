// What render and size share about running a machine: memory, hosts, progress, the end of the run.
#pragma once

#include "model/machine/bound.hpp"
#include "pipeline/machine.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Throws UsageError for a machine that doesn't fit into memory. Call before it is built.
void check_memory(const RenderOptions& options);

/// Throws UsageError for a --wire-check of a machine that has no wires or no words.
void check_wires(const RenderOptions& options);

/// Throws UsageError for a --detail that reaches outside the array or that the other options rule out.
void check_granularity(const RenderOptions& options);
Granularity granularity_of(const RenderOptions& options);

/// Writes the line of progress to standard error.
void show_progress(const RunProgress& progress);

/// The program's exit code after a run with this verdict.
int exit_code(Verdict verdict);

/// Prints, after a run, what its waveforms are opened with, and how its page is made.
void tell_waveforms(const std::string& prefix);
void tell_page(const std::string& prefix);

/// Warns on standard error, before the run, of a machine that is not certain to end.
void warn_of(const Bound& bound, const char* program = "raycell");

/// Prints on standard error why a run was not completed, and nothing if it was. For a run that got stuck it
/// adds what would have prevented that.
void explain(const RunResult& result, const Bound& bound, const char* program = "raycell");

}  // namespace raycell
