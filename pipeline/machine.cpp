#include "pipeline/machine.hpp"

#include <algorithm>
#include <ctime>

#include "model/loading/loading.hpp"
#include "model/tracing/traffic.hpp"
#include "pipeline/results.hpp"

namespace raycell {
namespace {

void take_larger(Binding& most, const Binding& other) { most.consider(other); }

}  // namespace

Machine::Machine(sc_core::sc_module_name name, const CellScene& scene, const PictureSettings& settings,
                 const MachineSettings& machine, const ExteriorTracer* tracer,
                 const SyntheticTraffic* traffic, const Granularity& granularity, RankExchange* ranks)
    : sc_module(name),
      parts_(scene, settings, machine, tracer, traffic, granularity, ranks),
      joined_(parts_) {
    if (machine.max_cycles > 0) parts_.scheduler.set_limit(Cycle(machine.max_cycles));
    parts_.scheduler.set_watch(&Machine::watch, this);
    if (ranks) parts_.scheduler.set_meeting(&Machine::meet, this);
}

void Machine::use_loaded(LoadedArray array) {
    expect_loaded_for(parts_, array);
    preloaded_ = std::make_unique<LoadedArray>(std::move(array));
}

RunResult Machine::run(std::function<void(const RunProgress&)> progress) {
    progress_ = std::move(progress);
    RunResult result;
    const PictureSettings& settings = parts_.environment.context.settings;
    load(result);
    const auto going = [&] { return result.verdict == Verdict::completed; };
    const Cycle next = going() ? 1 : 0;  // no cycle follows a run that has ended
    activity_.begin(parts_.scheduler.now() + next, parts_.environment.meters.counters, true);
    furnish();
    if (settings.stage == RunStage::load) {
        if (going()) {
            for (const Cell& cell : parts_.array.cells()) display(cell);
        }
    } else {
        if (going() && settings.shadows == Shadows::precast) run_phase(Phase::precast, result);
        if (going()) {
            result.trace_start = parts_.scheduler.now() + 1;
            run_phase(Phase::trace, result);
        }
        activity_.finish(parts_.scheduler.now() + next, parts_.environment.meters.counters);
        result.activity = activity_.activity();
        joined_.join(result.activity);
    }
    if (settings.stage == RunStage::trace)
        result.trace_binding = joined_.of_all(binding_of_trace(parts_), take_larger);
    const Results results(parts_, joined_, totals_);
    result.in_flight = results.in_flight();
    results.check_conservation(result.in_flight, going());
    results.collect(result);
    if (going() && result.storage.overflowed > 0) result.verdict = Verdict::capacity;
    result.picture = joined_.picture();
    result.ended = parts_.scheduler.now();
    return result;
}

/// Shows the nearest voxels of a cell in its block of pixels.
void Machine::display(const Cell& cell) {
    const Context& context = parts_.environment.context;
    const Frame& frame = context.scene.frame;
    for (int pixel = 0; pixel < frame.block(); ++pixel) {
        parts_.picture.pixels[frame.pixel_index(cell.x(), cell.y(), pixel)] =
            display_cell(context, cell.store(), cell.x(), cell.y(), pixel);
    }
}

void Machine::load(RunResult& result) {
    if (preloaded_) {
        start_loaded(parts_, *preloaded_, result);
        totals_ = parts_.environment.meters.counters;
        preloaded_.reset();
        return;
    }
    activity_.begin(parts_.scheduler.now(), parts_.environment.meters.counters, false);
    run_phase(Phase::load, result);
    activity_.finish(parts_.scheduler.now() + 1, parts_.environment.meters.counters);
    result.load_activity = activity_.activity();
    joined_.join(result.load_activity);
    // Load messages use the buffers of class 0, at a time when no others do; their figures are kept apart.
    result.buffers.push_back(Results(parts_, joined_, totals_).buffer_use("load", 0, result.load_cycles));
    result.load_binding = joined_.of_all(binding_of_load(parts_), take_larger);
    if (on_loaded_ && result.verdict == Verdict::completed) hand_over_loaded(parts_, result, on_loaded_);
}

/// Sets the state at the end of loading: fresh link statistics, synthetic voxels, shadow bits.
void Machine::furnish() {
    const Context& context = parts_.environment.context;
    for (Link& link : parts_.array.links()) link.reset_statistics();
    for (Cell& cell : parts_.array.cells()) {
        if (context.traffic) SyntheticTraffic::furnish(cell.store(), context.scene.frame, cell.x(), cell.y());
        if (context.settings.shadows != Shadows::per_hit) reset_shadow_bits(cell.store());
    }
}

// ---- phases

void Machine::run_phase(Phase phase, RunResult& result) {
    Environment& env = parts_.environment;
    phase_began_ = WallClock::now();
    const std::clock_t processor = std::clock();
    env.phase = phase;
    env.phase_start = parts_.scheduler.now();
    slow_ray_ = parts_.slow_ray();
    if (phase == Phase::precast) count_precast_rays();
    if (phase == Phase::load) {
        for (const auto& lane : parts_.lanes) lane->geometry.start();
    } else {
        if (env.meters.observer) env.meters.observer->phase_begins(phase, env.phase_start + 1);
        parts_.array.begin_phase();
    }
    // No free-running clock: sc_start() returns when no client has work any more.
    parts_.scheduler.begin();
    // Not called without an event, which happens when the limit allows no further cycle: SystemC would warn
    // on standard output.
    if (parts_.ranks || parts_.scheduler.next() != never) sc_core::sc_start();
    parts_.scheduler.sample();
    totals_ = joined_.of_all(env.meters.counters, raycell::join);
    Judge judge(parts_, joined_, totals_);
    if (!judge.phase_complete()) judge.judge(interrupted_, result);
    // A phase ends with its last message; later wakes found no work.
    const bool completed = result.verdict == Verdict::completed;
    const Cycle end = completed ? std::max(totals_.last_progress, env.phase_start) : parts_.scheduler.now();
    const Cycle cycles = end - env.phase_start;
    const double seconds = seconds_since(phase_began_);
    const double worked = double(std::clock() - processor) / CLOCKS_PER_SEC;
    switch (phase) {
        case Phase::load:
            result.load_cycles = cycles, result.wall_load = seconds, result.processor_load = worked;
            break;
        case Phase::precast:
            result.precast_cycles = cycles, result.wall_precast = seconds, result.processor_precast = worked;
            result.precast_hops = totals_.rays.ray_hops + totals_.rays.return_hops;
            break;
        case Phase::trace:
            result.trace_cycles = cycles, result.wall_trace = seconds, result.processor_trace = worked;
            break;
    }
}

void Machine::count_precast_rays() {
    for (const Cell& cell : parts_.array.cells()) precast_rays_ += cell.store().voxels.size();
    precast_rays_ *= parts_.environment.context.lights.rays.size();
}

// ---- while a phase runs

bool Machine::watch(void* self, Cycle now) { return static_cast<Machine*>(self)->goes_on(now); }

Cycle Machine::meet(void* self, Cycle) {
    auto& machine = *static_cast<Machine*>(self);
    return machine.parts_.ranks->meet(machine.progress(), machine.parts_.environment).next;
}

/// Called before each cycle: whether the run goes on with it.
bool Machine::goes_on(Cycle now) {
    const Environment& env = parts_.environment;
    // All ranks must decide alike here, so they use the progress that they have agreed on.
    const RankExchange* ranks = parts_.ranks;
    if (ranks ? ranks->agreed().interrupted != 0 : interrupt_ && *interrupt_) {
        interrupted_ = true;
        return false;
    }
    const Counters& counters = env.meters.counters;
    activity_.observe(now, counters);
    if (before_cycle_) before_cycle_(now);
    const Cycle last_progress = ranks ? ranks->agreed().last_progress : counters.last_progress;
    const std::uint64_t destroyed = ranks ? ranks->agreed().rays_destroyed : counters.rays_destroyed;
    const Cycle idle = now - std::max(last_progress, env.phase_start);
    if (env.phase == Phase::trace && destroyed > 0 && nothing_comes_home(idle)) {
        drain(now);
        if (now - drain_start_ > 1000 * slow_ray_) return false;
    } else if (env.draining) {  // an answer has come home
        drain_no_more(now);
    }
    constexpr std::uint64_t calls_between_reports = 4096;
    if (progress_ && ++watch_calls_ % calls_between_reports == 0) tell_progress(now);
    return true;
}

/// Holds back new rays, so that all that is not deadlocked comes to rest.
void Machine::drain(Cycle now) {
    Environment& env = parts_.environment;
    if (!env.draining && env.meters.observer) env.meters.observer->draining(true, now);
    env.draining = true;
    if (drain_start_ == never) drain_start_ = now;
}

void Machine::drain_no_more(Cycle now) {
    Environment& env = parts_.environment;
    env.draining = false;
    if (env.meters.observer) env.meters.observer->draining(false, now);
    drain_start_ = never;
    parts_.array.wake_all(now + 1);
}

/// Whether a run in which no answer has come home for `idle` cycles, though rays were sent again, has a knot
/// or counts as a livelock. It looks for a knot at idle times that double, so that looking costs little. A
/// knot stays for ever: such a run can't complete.
bool Machine::nothing_comes_home(Cycle idle) {
    if (idle > 1000 * slow_ray_) return true;
    const Cycle first_look = first_look_.value_or(slow_ray_);
    if (idle <= first_look) {
        next_look_ = first_look;
        return false;
    }
    if (!knot_stands_ && idle > next_look_) {
        knot_stands_ = MachineWaits(parts_).graph().deadlocked();
        next_look_ = 2 * idle;
    }
    return knot_stands_;
}

RankProgress Machine::progress() const {
    const Counters& c = parts_.environment.meters.counters;
    RankProgress mine;
    mine.last_progress = c.last_progress;
    mine.rays_destroyed = c.rays_destroyed;
    mine.done = parts_.environment.phase == Phase::load ? c.cells_loaded : c.pixels_done;
    mine.hops = c.load_hops + c.rays.ray_hops + c.rays.return_hops;
    mine.interrupted = interrupt_ && *interrupt_;
    return mine;
}

/// Polygons that every lane here has done with.
std::size_t Machine::polygons_taken() const {
    std::size_t least = parts_.environment.context.scene.polygons.size();
    for (const auto& lane : parts_.lanes) least = std::min(least, lane->geometry.polygons_taken());
    return least;
}

/// The share of the phase's work that is done. Loading is measured by polygons: loaded cells are counted by
/// the end-of-scene marks, which come last.
double Machine::phase_share() const {
    const Counters& c = parts_.environment.meters.counters;
    const auto share = [](std::uint64_t done, std::uint64_t all) {
        return all > 0 ? double(done) / double(all) : 0.0;
    };
    switch (parts_.environment.phase) {
        case Phase::load:
            return share(polygons_taken(), parts_.environment.context.scene.polygons.size());
        case Phase::precast:
            return share(c.rays_answered + c.rays_silent, precast_rays_);
        case Phase::trace:
            return share(c.pixels_done, parts_.array.cells().size() *
                                            std::size_t(parts_.environment.context.scene.frame.block()));
    }
    return 0;
}

void Machine::tell_progress(Cycle now) const {
    constexpr const char* names[] = {"load", "precast", "trace"};
    const RankProgress so_far = parts_.ranks ? parts_.ranks->agreed() : progress();
    const bool traces = parts_.environment.phase == Phase::trace;
    progress_({names[int(parts_.environment.phase)], now, so_far.done,
               traces ? parts_.picture.pixels.size() : parts_.cell_count(), so_far.hops, phase_share(),
               seconds_since(phase_began_)});
}

}  // namespace raycell
