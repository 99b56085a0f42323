// What render and size share about running a machine: is there room, how far is it, how did it end.
#pragma once

#include "model/machine/bound.hpp"
#include "pipeline/machine.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// A machine that can't be held in memory is refused, with a UsageError, before it is built.
void check_memory(const RenderOptions& options);

/// Refuses, with a UsageError, what can't be hosted as wished.
void check_granularity(const RenderOptions& options);
Granularity granularity_of(const RenderOptions& options);

/// Writes the line of progress to standard error.
void show_progress(const RunProgress& progress);

/// What the program exits with after a run with this verdict.
int exit_code(Verdict verdict);

/// Warns on standard error, before the run, of a machine that is not certain to end.
void warn_of(const Bound& bound, const char* program = "raycell");

/// Says on standard error why a run was not completed; nothing if it was. A run that got stuck is told what
/// would have kept it from that.
void explain(const RunResult& result, const Bound& bound, const char* program = "raycell");

}  // namespace raycell
