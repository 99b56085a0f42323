#include "pipeline/machine.hpp"

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <tuple>

#include "model/loading/loading.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {
const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::completed:
            return "completed";
        case Verdict::deadlock:
            return "deadlock";
        case Verdict::livelock:
            return "livelock";
        case Verdict::cycle_limit:
            return "cycle_limit";
        case Verdict::capacity:
            return "capacity";
        case Verdict::interrupted:
            return "interrupted";
    }
    return "";
}

Machine::Machine(sc_core::sc_module_name name, const CellScene& scene, const PictureSettings& settings,
                 const MachineSettings& machine, const ExteriorTracer* tracer,
                 const SyntheticTraffic* traffic, const Granularity& granularity, RankExchange* ranks)
    : sc_module(name),
      scheduler_("scheduler", sc_core::sc_time(1e3 / machine.clock_mhz, sc_core::SC_NS)),
      picture_(scene.frame.width, scene.frame.height),
      environment_(scene, settings, machine, scheduler_, picture_, traffic,
                   ranks ? &ranks->share() : nullptr),
      geometry_("geometry", environment_),
      precomputation_("precomputation", environment_),
      distribution_("distribution", environment_),
      array_("array", environment_, granularity),
      to_precomputation_(scheduler_, 1, stage_link_depth),
      to_distribution_(scheduler_, 1, stage_link_depth),
      ranks_(ranks) {
    if (machine.max_cycles > 0) scheduler_.set_limit(Cycle(machine.max_cycles));
    scheduler_.set_watch(&Machine::watch, this);
    if (ranks) scheduler_.set_meeting(&Machine::meet, this);
    bind_pipeline();
    const bool anything_beyond =
        std::any_of(scene.beyond.begin(), scene.beyond.end(), [](bool b) { return b; });
    if (settings.exterior == ExteriorMode::host && anything_beyond && settings.stage == RunStage::trace) {
        if (ranks && ranks->rank() != 0) {
            Exterior::join_remote(array_, environment_, *ranks);
            return;
        }
        if (!tracer)
            throw std::invalid_argument("exterior 'host' needs a tracer for what lies outside the cube");
        exterior_ = std::make_unique<Exterior>("exterior", environment_, *tracer);
        exterior_->join(array_, ranks);
    }
}

void Machine::bind_pipeline() {
    to_precomputation_.set_name("geometry.out");
    environment_.stall(to_precomputation_, to_precomputation_.name());
    to_precomputation_.connect_source(geometry_);
    to_precomputation_.connect_sink(precomputation_);
    geometry_.out.bind(to_precomputation_);
    precomputation_.in.bind(to_precomputation_);

    to_distribution_.set_name("precomputation.out");
    environment_.stall(to_distribution_, to_distribution_.name());
    to_distribution_.connect_source(precomputation_);
    precomputation_.out.bind(to_distribution_);
    const ArrayShare& share = environment_.share;
    if (share.contains(0)) {
        to_distribution_.connect_sink(distribution_.row(0));
        distribution_.row(0).in.bind(to_distribution_);
    }

    for (const int y : share.rows()) {
        row_links_.push_back(std::make_unique<Link>(scheduler_, 1, environment_.machine.buffer_depth));
        Link& link = *row_links_.back();
        link.set_name("distribution.row_" + std::to_string(y) + ".east");
        environment_.stall(link, link.name());
        link.connect_source(distribution_.row(y));
        distribution_.row(y).east.bind(link);
        array_.join_row(y, link);
    }
}

Cycle Machine::slow_ray() const {
    // A ray and its answer may cross the array and visit the exterior, and
    // each operation may be the dearest of the table, once per source.
    // The longest back-off is 127 bases.
    const Environment& env = environment_;
    Cycle dearest = 0;
    for (const auto& [name, member] : CostTable::entries())
        dearest = std::max(dearest, Cycle(env.costs().*member));
    const Cycle span = Cycle(env.width() + env.height());
    const Cycle hop = 64 + Cycle(env.cycles_for(env.bits.ray)) + Cycle(env.costs().walk_step);
    return Cycle(env.costs().backoff) * 128 + span * hop + Cycle(env.machine.exterior_latency) +
           dearest * Cycle(1 + env.context.scene.sources.size());
}

/// Whether a run in which nothing has come home for `idle` cycles, though rays were sent again, has a knot or
/// goes round in circles. A knot is looked for at idle times that double, so that looking costs little, and
/// stands once it is there: such a run can't complete any more.
bool Machine::nothing_comes_home(Cycle idle) {
    if (idle > 1000 * slow_ray_) return true;
    const Cycle first_look = first_look_.value_or(slow_ray_);
    if (idle <= first_look) {
        next_look_ = first_look;
        return false;
    }
    if (!knot_stands_ && idle > next_look_) {
        knot_stands_ = wait_graph().deadlocked();
        next_look_ = 2 * idle;
    }
    return knot_stands_;
}

bool Machine::watch(void* self, Cycle now) {
    auto& machine = *static_cast<Machine*>(self);
    Environment& env = machine.environment_;
    // What is decided here must be decided alike by all ranks: from what they have agreed upon.
    const RankExchange* ranks = machine.ranks_;
    if (ranks ? ranks->agreed().interrupted != 0 : machine.interrupt_ && *machine.interrupt_) {
        machine.interrupted_ = true;
        return false;
    }
    machine.activity_.observe(now, env.meters.counters);
    const Cycle last_progress = ranks ? ranks->agreed().last_progress : env.meters.counters.last_progress;
    const std::uint64_t destroyed =
        ranks ? ranks->agreed().rays_destroyed : env.meters.counters.rays_destroyed;
    const Cycle idle = now - std::max(last_progress, env.phase_start);
    if (env.phase == Phase::trace && destroyed > 0 && machine.nothing_comes_home(idle)) {
        // With no new rays on their way, all that is not locked comes to rest.
        if (!env.draining && env.meters.observer) env.meters.observer->draining(true, now);
        env.draining = true;
        if (machine.drain_start_ == never) machine.drain_start_ = now;
        if (now - machine.drain_start_ > 1000 * machine.slow_ray_) return false;
    } else if (env.draining) {  // something did come home: go on
        env.draining = false;
        if (env.meters.observer) env.meters.observer->draining(false, now);
        machine.drain_start_ = never;
        machine.array_.wake_all(now + 1);
    }
    constexpr std::uint64_t calls_between_reports = 4096;
    if (machine.progress_ && ++machine.watch_calls_ % calls_between_reports == 0) {
        machine.tell_progress(now);
    }
    return true;
}

/// The end-of-scene marks that count loaded cells come last, so they say nothing of how far loading is.
double Machine::phase_share() const {
    const Counters& c = environment_.meters.counters;
    const auto share = [](std::uint64_t done, std::uint64_t all) {
        return all > 0 ? double(done) / double(all) : 0.0;
    };
    switch (environment_.phase) {
        case Phase::load:
            return share(geometry_.polygons_taken(), environment_.context.scene.polygons.size());
        case Phase::precast:
            return share(c.rays_answered + c.rays_silent, precast_rays_);
        case Phase::trace:
            return share(c.pixels_done, array_.cells().size());  // of several ranks, this one's
    }
    return 0;
}

void Machine::tell_progress(Cycle now) const {
    constexpr const char* names[] = {"load", "precast", "trace"};
    const RankProgress so_far = ranks_ ? ranks_->agreed() : progress();
    const std::uint64_t cells = std::uint64_t(environment_.width()) * std::uint64_t(environment_.height());
    progress_({names[int(environment_.phase)], now, so_far.done, cells, so_far.hops, phase_share(),
               seconds_since(phase_began_)});
}

void Machine::run_phase(Phase phase, RunResult& result) {
    phase_began_ = WallClock::now();
    const std::clock_t processor = std::clock();
    environment_.phase = phase;
    environment_.phase_start = scheduler_.now();
    slow_ray_ = slow_ray();
    if (phase == Phase::precast) {
        for (const Cell& cell : array_.cells()) precast_rays_ += cell.store().voxels.size();
        precast_rays_ *= environment_.context.sources.size();
    }
    if (phase == Phase::load) {
        if (environment_.share.contains(0)) geometry_.start();
    } else {
        if (environment_.meters.observer)
            environment_.meters.observer->phase_begins(phase, scheduler_.now() + 1);
        array_.begin_phase();
    }
    // No free-running clock: this returns when nobody has anything to do any more.
    scheduler_.begin();
    // SystemC warns on standard output of a start without an event: where the limit allows no cycle more.
    if (ranks_ || scheduler_.next() != never) sc_core::sc_start();
    scheduler_.sample();
    totals_ = joined(environment_.meters.counters, raycell::join);
    if (!phase_complete()) judge(result);
    // A phase is over with its last message; what woke after that only found nothing to do.
    const Cycle end = result.verdict == Verdict::completed
                          ? std::max(totals_.last_progress, environment_.phase_start)
                          : scheduler_.now();
    const Cycle cycles = end - environment_.phase_start;
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

void Machine::load(RunResult& result) {
    if (preloaded_) {
        start_loaded(result);
        return;
    }
    activity_.begin(scheduler_.now(), environment_.meters.counters, false);
    run_phase(Phase::load, result);
    activity_.finish(scheduler_.now() + 1, environment_.meters.counters);
    result.load_activity = activity_.activity();
    join_activity(result.load_activity);
    // Load messages use the buffers of class 0 while nobody else does; their figures are kept apart.
    result.buffers.push_back(buffer_use("load", 0, result.load_cycles));
    if (on_loaded_ && result.verdict == Verdict::completed) hand_over_loaded(result);
}

RunResult Machine::run(std::function<void(const RunProgress&)> progress) {
    progress_ = std::move(progress);
    RunResult result;
    const PictureSettings& settings = environment_.context.settings;
    load(result);
    const auto going = [&] { return result.verdict == Verdict::completed; };
    const Cycle next = going() ? 1 : 0;  // what never began does not begin after the run's end
    activity_.begin(scheduler_.now() + next, environment_.meters.counters, true);
    for (Link& link : array_.links()) link.reset_statistics();
    if (environment_.context.traffic) {
        for (Cell& cell : array_.cells()) {
            SyntheticTraffic::furnish(cell.store(), environment_.context.scene.frame, cell.x(), cell.y());
        }
    }
    if (settings.shadows != Shadows::per_hit) {
        for (Cell& cell : array_.cells()) reset_shadow_bits(cell.store());
    }
    if (settings.stage == RunStage::load) {
        if (going()) {
            for (const Cell& cell : array_.cells()) {
                picture_.at(cell.x(), cell.y()) =
                    display_cell(environment_.context, cell.store(), cell.x(), cell.y());
            }
        }
    } else {
        if (going() && settings.shadows == Shadows::precast) run_phase(Phase::precast, result);
        if (going()) {
            result.trace_start = scheduler_.now() + 1;
            run_phase(Phase::trace, result);
        }
        activity_.finish(scheduler_.now() + next, environment_.meters.counters);
        result.activity = activity_.activity();
        join_activity(result.activity);
    }
    result.in_flight = in_flight();
    check_conservation(result.in_flight, going());
    collect(result);
    if (going() && result.storage.overflowed > 0) result.verdict = Verdict::capacity;
    result.picture = whole_picture();
    result.ended = scheduler_.now();
    return result;
}

InFlight Machine::in_flight() const {
    const MessagePools& pools = environment_.pools;
    InFlight there;
    there.rays = pools.rays.in_use();
    if (exterior_)
        there.rays += std::uint64_t(exterior_->working());  // those left the pool when it took them
    there.rays = sum(there.rays);
    there.answers = sum(pools.answers.in_use());
    there.upstream = geometry_.holds() + std::uint64_t(to_precomputation_.occupancy(0)) +
                     precomputation_.holds() + std::uint64_t(to_distribution_.occupancy(0)) +
                     distribution_.holds();
    there.upstream = sum(there.upstream);
    there.loads = sum(pools.loads.in_use()) - there.upstream;
    return there;
}

/// What was sent has come home or is still there, however the run ended.
void Machine::check_conservation(const InFlight& there, bool completed) const {
    const Counters& c = totals_;
    const bool rays = c.rays_sent == c.rays_answered + c.rays_silent + c.rays_destroyed + there.rays;
    const bool answers = c.answers_sent == c.answers_delivered + there.answers;
    const bool loads = c.loads_sent == c.loads_delivered + there.loads;
    const bool nothing_left = there.rays + there.answers + there.loads + there.upstream == 0;
    if (rays && answers && loads && (nothing_left || !completed)) return;
    const auto text = [](std::uint64_t count, const char* what) {
        return std::to_string(count) + " " + what;
    };
    throw std::logic_error("internal error: messages are not conserved: rays " + text(c.rays_sent, "sent, ") +
                           text(c.rays_answered, "answered, ") + text(c.rays_silent, "silent, ") +
                           text(c.rays_destroyed, "destroyed, ") + text(there.rays, "in flight; answers ") +
                           text(c.answers_sent, "sent, ") + text(c.answers_delivered, "delivered, ") +
                           text(there.answers, "in flight; load messages ") + text(c.loads_sent, "sent, ") +
                           text(c.loads_delivered, "delivered, ") + text(there.loads, "in flight, ") +
                           text(there.upstream, "before the rows"));
}

void Machine::collect(RunResult& result) const {
    result.counters = totals_;
    result.geometry = geometry_.statistics();
    result.precomputation = precomputation_.statistics();
    result.distribution =
        joined(distribution_.statistics(), [](StageStatistics& a, const StageStatistics& b) {
            a.items += b.items;
            a.busy_cycles += b.busy_cycles;
        });
    if (exterior_) result.exterior = exterior_->statistics();
    const Context& context = environment_.context;
    const VoxelBits each = voxel_bits(context.settings, context.arithmetic.formats(), context.sources.size());
    std::uint64_t slot_cycles = 0;
    Cell::Remaining to_come;
    for (const Cell& cell : array_.cells()) {
        const Cell::Remaining remaining = cell.remaining(scheduler_.now());
        to_come.traversal += remaining.traversal;
        to_come.shading += remaining.shading;
        result.storage.add(cell.store(), each);
        result.ray_store_peak = std::max(result.ray_store_peak, cell.ray_store().peak());
        slot_cycles += cell.ray_store().waiting_cycles(scheduler_.now());
    }
    result.counters.slot_cycles += sum(slot_cycles);
    result.counters.traversal_cycles -= sum(to_come.traversal);
    result.counters.shading_cycles -= sum(to_come.shading);
    result.storage = joined(result.storage, [](StorageCounts& a, const StorageCounts& b) { a.add(b); });
    result.ray_store_peak = joined(result.ray_store_peak, [](int& a, int b) { a = std::max(a, b); });
    if (result.trace_cycles > 0) {
        result.ray_store_mean =
            double(result.counters.slot_cycles) /
            (double(result.trace_cycles) * double(environment_.width()) * double(environment_.height()));
    }
    result.schedule_hash = joined_schedule_hash();
    result.ledger = environment_.meters.ledger;
    join_ledger(result.ledger);
    collect_time_outs(result);
    collect_buffers(result);
}

/// Peak and mean of one class over the array's links since their last reset.
RunResult::BufferUse Machine::buffer_use(const char* buffer_class, int index, Cycle cycles) const {
    struct Sums {
        int peak = 0;
        std::uint64_t occupied = 0;
        std::uint64_t buffers = 0;
    } sums;
    for (const Link& link : array_.links()) {
        const Link::ClassStatistics s = link.statistics(index);
        sums.peak = std::max(sums.peak, s.peak);
        sums.occupied += s.occupied_cycles;
        sums.buffers += s.sent > 0 ? 1 : 0;  // a class that a link never carries has no buffer there
    }
    sums = joined(sums, [](Sums& a, const Sums& b) {
        a.peak = std::max(a.peak, b.peak);
        a.occupied += b.occupied;
        a.buffers += b.buffers;
    });
    RunResult::BufferUse use;
    use.name = buffer_class;
    use.peak = sums.peak;
    if (sums.buffers > 0 && cycles > 0)
        use.mean = double(sums.occupied) / (double(sums.buffers) * double(cycles));
    return use;
}

void Machine::collect_buffers(RunResult& result) const {
    if (environment_.phase == Phase::load) return;
    for (int index = 0; index < environment_.classes.count; ++index) {
        result.buffers.push_back(buffer_use(class_name(environment_.machine.networks, index), index,
                                            result.precast_cycles + result.trace_cycles));
    }
}

}  // namespace raycell
