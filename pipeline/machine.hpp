// The whole machine: runs the phases load, precast and trace to a verdict.
#pragma once

#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cells/clock/wall_time.hpp"
#include "pipeline/joined.hpp"
#include "pipeline/loaded_state.hpp"
#include "pipeline/machine_parts.hpp"
#include "pipeline/machine_waits.hpp"
#include "pipeline/run_result.hpp"
#include "pipeline/verdict.hpp"

namespace raycell {

/// Progress of a run, for people.
struct RunProgress {
    const char* phase;
    Cycle cycle;
    std::uint64_t done;  ///< cells loaded or pixels complete
    std::uint64_t all;
    std::uint64_t hops;
    double share;    ///< of the phase's work: polygons past the first stage, rays ended, or pixels
    double seconds;  ///< wall time since the phase began
};

class Machine : public sc_core::sc_module {
  public:
    /// `tracer` may be null if no ray goes to the exterior. With `traffic` hits are drawn at random
    /// (model/tracing/traffic.hpp). With `ranks` this is one rank's part of a machine that several processes
    /// simulate; only rank 0 needs the tracer. All arguments must outlive the
    /// machine.
    Machine(sc_core::sc_module_name name, const CellScene& scene, const PictureSettings& settings,
            const MachineSettings& machine, const ExteriorTracer* tracer,
            const SyntheticTraffic* traffic = nullptr, const Granularity& granularity = {},
            RankExchange* ranks = nullptr);

    /// Runs load, precast and trace to a verdict. Call once. With several ranks, each gets the whole
    /// machine's result, but only rank 0 gets the picture, the ledger and the schedule hash.
    RunResult run(std::function<void(const RunProgress&)> progress = {});

    /// Traces the trees of the pixels with most hops once more, one after the other, each alone in the
    /// machine: the longest, and its cycles. Nothing waits there for another tree, so the trace can't be
    /// shorter. Call it after a run that completed its trace, once nothing else is asked of the machine: its
    /// counters go on. Not for random stalls, limits of cycles or several ranks: `Unit::none` then.
    Binding longest_tree();

    /// For signal handlers: once `flag` is not 0, the run ends before its next cycle with the verdict
    /// `interrupted` and the results so far. Null: no interruption.
    void interrupt_by(const volatile std::sig_atomic_t* flag) { interrupt_ = flag; }

    /// Starts with the loaded array of another machine instead of loading; its loading_key() must be equal.
    /// The schedule goes on from the cycle in which the other machine's loading ended. Not for random stalls,
    /// whose draws continue from loading. Throws std::invalid_argument for an array with another key.
    void use_loaded(LoadedArray array);
    /// `on_loaded` is called with the loaded array at the end of loading; not after use_loaded().
    void set_on_loaded(std::function<void(const LoadedArray&)> on_loaded) {
        on_loaded_ = std::move(on_loaded);
    }

    /// `hook` is called before each cycle that is run, with its number; the state is still that of the cycle
    /// run before.
    void set_before_cycle(std::function<void(Cycle)> hook) { before_cycle_ = std::move(hook); }

    Array& array() { return parts_.array; }
    Environment& environment() { return parts_.environment; }

    // The loading pipeline before the array, for observers.
    const std::vector<std::unique_ptr<FeedLane>>& lanes() const { return parts_.lanes; }
    const Distribution& distribution() const { return parts_.distribution; }
    const std::vector<std::unique_ptr<Link>>& row_links() const { return parts_.row_links; }

    /// At most `most` cells (x, y) that hold messages or rays, those with the oldest messages first.
    std::vector<std::pair<int, int>> blocked_cells(std::size_t most) const {
        return raycell::blocked_cells(parts_.array, most);
    }
    /// Cycles without an answer coming home after which a run that postpones rays counts as a livelock.
    Cycle livelock_window() const { return 1000 * parts_.slow_ray(); }
    /// Sets the cycles without an answer coming home after which a run that postpones rays is searched for
    /// knots for the first time; the default is a slow ray's cycles. `never`: only at the end of the run.
    void look_for_knots_after(Cycle idle) { first_look_ = idle; }

    /// The analysed wait-for graph of the machine's present state. With several ranks, all must call it; each
    /// gets the whole graph.
    WaitGraph wait_graph() const { return MachineWaits(parts_).graph(); }

  private:
    void load(RunResult& result);
    void furnish();
    void display(const Cell& cell);
    void run_phase(Phase phase, RunResult& result);
    void count_precast_rays();
    static bool watch(void* self, Cycle now);
    static Cycle meet(void* self, Cycle next);
    bool goes_on(Cycle now);
    void drain(Cycle now);
    void drain_no_more(Cycle now);
    bool nothing_comes_home(Cycle idle);
    RankProgress progress() const;
    void tell_progress(Cycle now) const;
    std::size_t polygons_taken() const;
    double phase_share() const;

    MachineParts parts_;
    Joined joined_;
    Counters totals_;  ///< of the whole machine, at the end of the last phase
    ActivityRecorder activity_;
    std::function<void(const RunProgress&)> progress_;
    std::function<void(Cycle)> before_cycle_;
    std::uint64_t watch_calls_ = 0;
    WallClock::time_point phase_began_;
    std::uint64_t precast_rays_ = 0;
    Cycle slow_ray_ = 0;               ///< MachineParts::slow_ray(), which goes through the whole cost table
    std::optional<Cycle> first_look_;  ///< for knots, in cycles after the last progress
    Cycle next_look_ = 0;
    bool knot_stands_ = false;
    Cycle drain_start_ = never;
    const volatile std::sig_atomic_t* interrupt_ = nullptr;
    bool interrupted_ = false;
    std::unique_ptr<LoadedArray> preloaded_;
    std::function<void(const LoadedArray&)> on_loaded_;
};

}  // namespace raycell
