#include "pipeline/results.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {

InFlight Results::in_flight() const {
    const MessagePools& pools = parts_.environment.pools;
    InFlight there;
    there.rays = pools.rays.in_use();
    if (parts_.exterior) there.rays += std::uint64_t(parts_.exterior->working());  // no longer in the pool
    there.rays = joined_.sum(there.rays);
    there.answers = joined_.sum(pools.answers.in_use());
    there.upstream = parts_.distribution.holds();
    for (const auto& lane : parts_.lanes) there.upstream += lane->holds();
    there.upstream = joined_.sum(there.upstream);
    there.loads = joined_.sum(pools.loads.in_use()) - there.upstream;
    return there;
}

void Results::check_conservation(const InFlight& there, bool completed) const {
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

void Results::collect(RunResult& result) const {
    result.counters = totals_;
    const auto add = [](StageStatistics& a, const StageStatistics& b) { a += b; };
    result.geometry = joined_.of_all(parts_.geometry(), add);
    result.precomputation = joined_.of_all(parts_.precomputation(), add);
    result.distribution = joined_.of_all(parts_.distribution.statistics(), add);
    if (parts_.exterior) result.exterior = parts_.exterior->statistics();
    collect_cells(result);
    result.schedule_hash = joined_.schedule_hash();
    result.ledger = parts_.environment.meters.ledger;
    joined_.join(result.ledger);
    collect_time_outs(result);
    collect_buffers(result);
}

void Results::collect_cells(RunResult& result) const {
    const Context& context = parts_.environment.context;
    const VoxelBits each =
        voxel_bits(context.settings, context.arithmetic.formats(), context.lights.rays.size());
    std::uint64_t slot_cycles = 0;
    Cell::Remaining to_come;
    for (const Cell& cell : parts_.array.cells()) {
        const Cell::Remaining remaining = cell.remaining(parts_.scheduler.now());
        to_come.traversal += remaining.traversal;
        to_come.shading += remaining.shading;
        result.storage.add(cell.store(), each);
        result.ray_store_peak = std::max(result.ray_store_peak, cell.ray_store().peak());
        slot_cycles += cell.ray_store().waiting_cycles(parts_.scheduler.now());
    }
    result.counters.slot_cycles += joined_.sum(slot_cycles);
    result.counters.traversal_cycles -= joined_.sum(to_come.traversal);
    result.counters.shading_cycles -= joined_.sum(to_come.shading);
    result.storage =
        joined_.of_all(result.storage, [](StorageCounts& a, const StorageCounts& b) { a.add(b); });
    result.ray_store_peak = joined_.of_all(result.ray_store_peak, [](int& a, int b) { a = std::max(a, b); });
    if (result.trace_cycles > 0) {
        result.ray_store_mean =
            double(result.counters.slot_cycles) / (double(result.trace_cycles) * double(parts_.cell_count()));
    }
}

RunResult::BufferUse Results::buffer_use(const char* buffer_class, int index, Cycle cycles) const {
    struct Sums {
        int peak = 0;
        std::uint64_t occupied = 0;
        std::uint64_t buffers = 0;
    } sums;
    for (const Link& link : parts_.array.links()) {
        const Link::ClassStatistics s = link.statistics(index);
        sums.peak = std::max(sums.peak, s.peak);
        sums.occupied += s.occupied_cycles;
        sums.buffers += s.sent > 0 ? 1 : 0;  // buffers that no message used do not count
    }
    sums = joined_.of_all(sums, [](Sums& a, const Sums& b) {
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

void Results::collect_buffers(RunResult& result) const {
    if (parts_.environment.phase == Phase::load) return;
    for (int index = 0; index < parts_.environment.classes.count; ++index) {
        result.buffers.push_back(buffer_use(class_name(parts_.environment.machine.networks, index), index,
                                            result.precast_cycles + result.trace_cycles));
    }
}

}  // namespace raycell
