// The cases of the benchmark. Those that use SystemC elaborate, so a process can run only one of them.
#pragma once

#include "cells/hosts/array.hpp"
#include "testbench/bench/traffic.hpp"

namespace raycell::bench {

/// One SC_METHOD per cell and sc_fifo channels: what a SystemC user would write first. Untimed: delta cycles.
Measured run_sc_fifo(const Traffic& traffic);
/// The cells of an array as the machine runs them.
Measured run_array(const Traffic& traffic, const Granularity& granularity);
/// The same cells, links and time wheel, run by a plain loop in place of SystemC's kernel.
Measured run_bare_cells(const Traffic& traffic);
/// A plain loop that only moves rays and answers: no cells, no buffers, no time.
Measured run_bare_tokens(const Traffic& traffic);

}  // namespace raycell::bench
