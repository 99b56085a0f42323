// The results of a run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cells/deadlock/wait_graph.hpp"
#include "cells/meters/meters.hpp"
#include "model/machine/untimed.hpp"
#include "pipeline/activity.hpp"
#include "pipeline/binding.hpp"
#include "pipeline/stages/stage.hpp"

namespace raycell {

/// Source of the loading figures: this run, or the run that saved the array, on a machine with the same
/// timing or with other buffers, links or costs.
enum class LoadedBy { run, saved, saved_other_timing };

enum class Verdict { completed, deadlock, livelock, cycle_limit, capacity, interrupted };
const char* name_of(Verdict verdict);

/// The alarms that a time-out of `cycles` cycles in every cell would have raised (cells/units/time_out.hpp),
/// compared with the proof.
struct TimeOutResult {
    Cycle cycles = 0;
    std::uint64_t false_alarms = 0;  ///< in cells without a deadlock: they moved again
    std::uint64_t early_alarms = 0;  ///< in cells that moved again but later deadlocked, also in part
    std::uint64_t knot_cells = 0;    ///< cells that hold a node of a knot ...
    std::uint64_t knot_alarms = 0;   ///< ... and those of them that raise an alarm and never move again
    std::uint64_t missed_knots = 0;  ///< knots without a cell that raises a lasting alarm
    std::uint64_t tail_alarms = 0;   ///< cells with tails only that raise an alarm and never move again
    std::int64_t first_alarm_delay =
        0;  ///< cycles from the first knot to the first lasting alarm in a cell of a knot
};

/// The messages in the machine when a run stops, counted in their places; none if it completed.
struct InFlight {
    std::uint64_t rays = 0;  ///< in buffers, registers, slots, units and the exterior
    std::uint64_t answers = 0;
    std::uint64_t loads = 0;     ///< in the rows of cells
    std::uint64_t upstream = 0;  ///< load messages in the stages before the rows
};

/// The results of a run of either engine. Cycles are 0 for the untimed engine.
struct RunResult {
    Verdict verdict = Verdict::completed;
    Picture picture;
    Cycle load_cycles = 0;
    Cycle precast_cycles = 0;
    Cycle trace_cycles = 0;
    Binding load_binding;
    Binding trace_binding;  ///< of precast and trace
    StageStatistics geometry;
    StageStatistics precomputation;
    StageStatistics distribution;
    StageStatistics exterior;
    Counters counters;
    InFlight in_flight;
    StorageCounts storage;
    int ray_store_peak = 0;
    double ray_store_mean = 0;  ///< over all cells and the trace phase
    struct BufferUse {
        std::string name;
        int peak = 0;
        double mean = 0;  ///< messages per buffer, over the class's used buffers and all cycles
    };
    std::vector<BufferUse> buffers;
    std::vector<std::string> report;              ///< what is stuck and where, oldest first
    Cycle ended = 0;                              ///< cycle in which the run stopped
    WaitGraph waits;                              ///< analysed; empty if the run completed or was interrupted
    std::vector<std::pair<int, int>> knot_cells;  ///< (x, y) of the cells of all knots
    Cycle knot_formed = never;                    ///< cycle since which the first knot exists
    Ledger ledger;                                ///< the rays destroyed and postponed
    std::vector<TimeOutResult> time_outs;
    Activity load_activity;
    Activity activity;          ///< of precast and trace
    Cycle trace_start = never;  ///< first cycle of tracing; activity before it is precast
    LoadedBy loading = LoadedBy::run;
    std::uint64_t precast_hops = 0;  ///< hops of rays and answers in the precast phase
    std::uint64_t schedule_hash = 0;
    double wall_load = 0;  ///< seconds
    double wall_precast = 0;
    double wall_trace = 0;
    double processor_load = 0;  ///< processor time of this process, in seconds
    double processor_precast = 0;
    double processor_trace = 0;
};

}  // namespace raycell
