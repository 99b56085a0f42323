// render's --vcd-on-deadlock: the last cycles before a deadlock, of its knot alone.
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
};

/// Those of the knot; where the run doesn't tell, those with the oldest messages, 64 at most, and its end.
DeadlockedCells deadlocked_cells(const RunResult& result, Machine& machine);

/// Runs the same configuration once more, as a process of its own, with probes on these cells, and takes over
/// its PREFIX.vcd and PREFIX.gtkw. Which cells lock is known only when they have, and keeping the last cycles
/// of all cells would cost every run; runs are deterministic, so the second is the first, which is checked by
/// its schedule's hash. Throws std::runtime_error if it can't be run, std::logic_error if it differs,
/// Interrupted.
void dump_deadlock(const RenderOptions& options, nlohmann::ordered_json config, const DeadlockedCells& where,
                   std::uint64_t schedule_hash, OutputSet& outputs);

}  // namespace raycell
