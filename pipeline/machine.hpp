// The whole machine: binds the stages, the array and the exterior, and runs the phases.
#pragma once

#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cells/clock/wall_time.hpp"
#include "cells/deadlock/cell_waits.hpp"
#include "cells/hosts/array.hpp"
#include "model/files/array_file.hpp"
#include "pipeline/activity.hpp"
#include "pipeline/ranks/rank_exchange.hpp"
#include "pipeline/stages/distribution.hpp"
#include "pipeline/stages/exterior.hpp"
#include "pipeline/stages/geometry.hpp"
#include "pipeline/stages/precomputation.hpp"

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

/// Progress of a run, for people.
struct RunProgress {
    const char* phase;
    Cycle cycle;
    std::uint64_t done;  ///< cells loaded or pixels complete
    std::uint64_t all;
    std::uint64_t hops;
    double share;    ///< of the phase's work: polygons through the first stage, rays at their ends, pixels
    double seconds;  ///< wall time since the phase began
};

class Machine : public sc_core::sc_module {
  public:
    /// `tracer` may be null where nothing is handed to the exterior. With `traffic` what rays meet is drawn
    /// (model/tracing/traffic.hpp). With `ranks` this is its rank's part of a machine that several processes
    /// simulate; the scene's polygons and the tracer are needed by rank 0 alone. All arguments must outlive
    /// the machine.
    Machine(sc_core::sc_module_name name, const CellScene& scene, const PictureSettings& settings,
            const MachineSettings& machine, const ExteriorTracer* tracer,
            const SyntheticTraffic* traffic = nullptr, const Granularity& granularity = {},
            RankExchange* ranks = nullptr);

    /// Runs load, precast and trace to a verdict. Call once. Of several ranks, all have the whole machine's
    /// result, but only rank 0 the whole picture and ledger; the others none.
    RunResult run(std::function<void(const RunProgress&)> progress = {});

    /// While `flag` is not 0 the run ends before its next cycle, with the verdict `interrupted` and what
    /// there is so far; for signal handlers. Null: nothing interrupts.
    void interrupt_by(const volatile std::sig_atomic_t* flag) { interrupt_ = flag; }

    /// Instead of loading, starts with what another machine had loaded: its loading_key() must be this
    /// one's. The schedule goes on from the cycle in which that one's loading ended. Not with random stalls,
    /// whose draws go on. Throws std::invalid_argument for the array of another machine.
    void use_loaded(LoadedArray array);
    /// Called with the loaded array, once it is. Not after use_loaded().
    void set_on_loaded(std::function<void(const LoadedArray&)> on_loaded) {
        on_loaded_ = std::move(on_loaded);
    }

    Array& array() { return array_; }
    Environment& environment() { return environment_; }

    // The loading pipeline before the array, for looking at it.
    static constexpr int stage_link_depth = 4;  ///< messages between two stages before the array
    const Geometry& geometry() const { return geometry_; }
    const Precomputation& precomputation() const { return precomputation_; }
    const Distribution& distribution() const { return distribution_; }
    Link& polygon_link() { return to_precomputation_; }
    Link& trapeze_link() { return to_distribution_; }
    /// From each row's distributor into its first cell.
    const std::vector<std::unique_ptr<Link>>& row_links() const { return row_links_; }

    /// Cells, (x, y), in which something stands: those with the oldest messages first, `most` at most.
    std::vector<std::pair<int, int>> blocked_cells(std::size_t most) const;

    /// Cycles that a slow ray, its answer and its longest back-off take.
    Cycle slow_ray() const;
    /// Cycles without any answer coming home after which postponing is called a livelock.
    Cycle livelock_window() const { return 1000 * slow_ray(); }
    /// Cycles without any answer coming home after which a run in which rays are postponed is looked at for
    /// knots, for the first time; by default slow_ray(). `never`: only when it has ended.
    void look_for_knots_after(Cycle idle) { first_look_ = idle; }

    /// What waits for what as the machine stands now; analysed. Of several ranks, all must call it, and all
    /// have the whole graph.
    WaitGraph wait_graph() const;

  private:
    void bind_pipeline();
    void load(RunResult& result);
    // machine_loaded.cpp
    void hand_over_loaded(RunResult& result);
    void start_loaded(RunResult& result);
    void visit_loading(std::vector<std::uint64_t>& numbers, bool taking, RunResult& result);
    void run_phase(Phase phase, RunResult& result);
    bool phase_complete() const;
    void tell_progress(Cycle now) const;
    double phase_share() const;
    void judge(RunResult& result);
    InFlight in_flight() const;
    void check_conservation(const InFlight& there, bool completed) const;
    void collect(RunResult& result) const;
    void collect_time_outs(RunResult& result) const;
    RunResult::BufferUse buffer_use(const char* buffer_class, int index, Cycle cycles) const;
    void collect_buffers(RunResult& result) const;
    static std::vector<std::string> report_of(const WaitGraph& graph);
    // loading_waits.cpp
    const Link& input_of_row(int y) const;
    void add_places(const Band& band, WaitMap& map) const;
    void add_waits(const Band& band, WaitMap& map) const;
    bool has_outside() const;
    void add_outside_places(WaitMap& map) const;
    void add_outside_waits(WaitMap& map) const;
    std::vector<std::string> stuck_report() const;
    static bool watch(void* self, Cycle now);

    // machine_ranks.cpp: what several ranks have to put together
    static Cycle meet(void* self, Cycle next);
    RankProgress progress() const;
    /// Of all ranks: `mine` joined with the others' by `join(T&, const T&)`.
    template <typename T, typename Join>
    T joined(T mine, Join join) const;
    std::uint64_t sum(std::uint64_t mine) const;
    void put_waits_together(WaitMap& map) const;
    /// A line of a report, and the row of cells that it is about.
    struct RowLine {
        int row;
        std::string text;
    };
    /// Sections one after the other, of all ranks, each by rows.
    std::vector<std::string> joined_lines(std::vector<std::vector<RowLine>> sections) const;
    void join_activity(Activity& activity) const;
    std::uint64_t joined_schedule_hash() const;
    void join_ledger(Ledger& ledger) const;
    Picture whole_picture() const;
    struct FarBuffer;
    void add_far_buffers(const WaitMap& map, int band, std::vector<FarBuffer>& far) const;
    void expect_no_work();
    bool buffers_empty() const;
    bool nothing_comes_home(Cycle idle);

    Scheduler scheduler_;
    Picture picture_;
    Environment environment_;
    Geometry geometry_;
    Precomputation precomputation_;
    Distribution distribution_;
    Array array_;
    std::unique_ptr<Exterior> exterior_;
    Link to_precomputation_;
    Link to_distribution_;
    std::vector<std::unique_ptr<Link>> row_links_;
    std::function<void(const RunProgress&)> progress_;
    std::uint64_t watch_calls_ = 0;
    WallClock::time_point phase_began_;
    std::uint64_t precast_rays_ = 0;
    ActivityRecorder activity_;
    Cycle slow_ray_ = 0;               ///< slow_ray(), which goes through the whole cost table
    std::optional<Cycle> first_look_;  ///< for knots, cycles after the last progress
    Cycle next_look_ = 0;
    bool knot_stands_ = false;
    Cycle drain_start_ = never;
    const volatile std::sig_atomic_t* interrupt_ = nullptr;
    bool interrupted_ = false;
    RankExchange* ranks_ = nullptr;  ///< null: the whole machine is here
    Counters totals_;                ///< of the whole machine, when a phase has ended
    std::unique_ptr<LoadedArray> preloaded_;
    std::function<void(const LoadedArray&)> on_loaded_;
};

template <typename T, typename Join>
T Machine::joined(T mine, Join join) const {
    if (!ranks_) return mine;
    ByteWriter bytes;
    bytes.put(mine);
    const std::vector<Bytes> all = ranks_->gather_for_all(bytes.take());
    T sum = ByteReader(all.front()).get<T>();
    for (std::size_t rank = 1; rank < all.size(); ++rank) join(sum, ByteReader(all[rank]).get<T>());
    return sum;
}

}  // namespace raycell
