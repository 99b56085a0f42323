// What a run tells.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cells/deadlock/wait_graph.hpp"
#include "cells/meters/meters.hpp"
#include "model/machine/untimed.hpp"
#include "pipeline/activity.hpp"
#include "pipeline/stages/stage.hpp"

namespace raycell {

/// Whose loading a result tells of: its own, or that of the run that saved the array, which was an equal
/// machine's or that of one with other buffers, links or costs.
enum class LoadedBy { run, saved, saved_other_timing };

enum class Verdict { completed, deadlock, livelock, cycle_limit, capacity, interrupted };
const char* name_of(Verdict verdict);

/// What a time-out of `cycles` in every cell would have told (cells/units/time_out.hpp), beside the proof.
struct TimeOutResult {
    Cycle cycles = 0;
    std::uint64_t false_alarms = 0;  ///< in cells of which nothing locked: they moved again
    std::uint64_t early_alarms = 0;  ///< in cells that locked later or in part, and that moved again
    std::uint64_t knot_cells = 0;    ///< that hold a node of a knot ...
    std::uint64_t knot_alarms = 0;   ///< ... and of them, those that give alarm and never move again
    std::uint64_t missed_knots = 0;  ///< none of whose cells gives alarm for good
    std::uint64_t tail_alarms = 0;   ///< cells that only wait for a knot, give alarm and never move again
    std::int64_t first_alarm_delay =
        0;  ///< cycles from the knot's forming to the first lasting alarm in one of its cells
};

/// Messages that are there when a run stops, counted where they stand. None if it completed.
struct InFlight {
    std::uint64_t rays = 0;  ///< in buffers, registers, slots, units and the exterior
    std::uint64_t answers = 0;
    std::uint64_t loads = 0;     ///< in the rows of cells
    std::uint64_t upstream = 0;  ///< load messages in the stages before the rows
};

/// What a run of either engine tells about itself. Cycles are 0 for the untimed one.
struct RunResult {
    Verdict verdict = Verdict::completed;
    Picture picture;
    Cycle load_cycles = 0;
    Cycle precast_cycles = 0;
    Cycle trace_cycles = 0;
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
        double mean = 0;  ///< messages per buffer, over the buffers of the class and all cycles
    };
    std::vector<BufferUse> buffers;
    std::vector<std::string> report;  ///< what was stuck where, oldest first
    Cycle ended = 0;                  ///< cycle in which the run stopped
    WaitGraph waits;  ///< of a run that did not complete, sorted into live, tails and knots; else empty
    std::vector<std::pair<int, int>> knot_cells;  ///< (x, y) of the cells of the deadlock's knot
    Cycle knot_formed = never;                    ///< cycle from which on the knot stood
    Ledger ledger;                                ///< what was destroyed and postponed
    std::vector<TimeOutResult> time_outs;
    Activity load_activity;
    Activity activity;          ///< of precast and trace
    Cycle trace_start = never;  ///< cycle in which tracing began; before it, from activity.start on, precast
    LoadedBy loading = LoadedBy::run;
    std::uint64_t precast_hops = 0;  ///< of all hops of rays and answers, those of the precast phase
    std::uint64_t schedule_hash = 0;
    double wall_load = 0;  ///< seconds
    double wall_precast = 0;
    double wall_trace = 0;
    double processor_load = 0;  ///< seconds of this process
    double processor_precast = 0;
    double processor_trace = 0;
};

}  // namespace raycell
