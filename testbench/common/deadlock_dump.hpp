// render's --vcd-on-deadlock: waveforms of a deadlock's knot alone, over the last cycles before it.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "pipeline/machine.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

struct DeadlockedCells {
    std::vector<std::pair<int, int>> cells;  ///< (x, y)
    Cycle formed = 0;                        ///< cycle from which on they stood still
    /// The knots' buffers, each followed by one that it waits for: "cell_3_4.west.answer".
    std::vector<std::string> buffers;
};

/// The cells of the knot and the cycle in which it formed. If the run has no knot: the cells with the oldest
/// messages, 64 at most, and the run's last cycle.
DeadlockedCells deadlocked_cells(const RunResult& result, Machine& machine);

/// Runs the same configuration again in a process of its own, with probes on these cells, and takes over its
/// PREFIX.vcd and PREFIX.gtkw. Which cells lock is known only afterwards, and keeping the last cycles of all
/// cells would cost every run. Runs are deterministic; the schedule's hash checks that the second equals the
/// first. Throws std::runtime_error if it can't be run, std::logic_error if it differs, Interrupted.
void dump_deadlock(const std::vector<std::string>& program, const RenderOptions& options,
                   nlohmann::ordered_json config, const DeadlockedCells& where, std::uint64_t schedule_hash,
                   OutputSet& outputs);

}  // namespace raycell
