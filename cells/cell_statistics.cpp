// A cell's counters, and the waits that are going on in it.
#include "cells/cell.hpp"

namespace raycell {

void Cell::add_stall(const Wait& wait, std::uint64_t ray, Cycle now) {
    const Cycle cycles = now - wait.since;
    meter_.stalled(wait.cause, cycles);
    if (env_.meters.observer) env_.meters.observer->stalled(*this, now, ray, wait.cause, cycles);
}

Cell::Remaining Cell::remaining(Cycle now) const {
    Remaining remaining;
    for (std::size_t i = 0; i < traversal_.count(); ++i) {
        if (traversal_.packet(i) && traversal_.done(i) > now) remaining.traversal += traversal_.done(i) - now;
    }
    if (!shading_.idle() && shading_.done() > now) remaining.shading = shading_.done() - now;
    return remaining;
}

CellStatistics Cell::statistics(Cycle now) const {
    CellStatistics sum = meter_.statistics();
    const Remaining to_come = remaining(now);
    sum.traversal_cycles -= to_come.traversal;
    sum.shading_cycles -= to_come.shading;
    sum.loading_cycles -= loading_.to_make(now);
    sum.slot_cycles += ray_store_.waiting_cycles(now);
    const auto add = [&](const Wait& wait) {
        if (wait.cause != Stall::none && now > wait.since) sum.stalls[wait.cause] += now - wait.since;
    };
    for (std::size_t place = 0; place < place_count(); ++place) {
        if (nothing_at(place)) continue;
        if (const RayPacket* packet = packet_at(place)) add(wait_of(*packet, place));
    }
    for (const Wait& wait : inputs_.answer_waits()) add(wait);
    add(shading_.direct_wait());
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        const Slot& slot = ray_store_[i];
        const bool waits = slot.state == Slot::State::to_set_up || slot.state == Slot::State::to_answer;
        if (waits || complete(slot)) add(slot.wait);
    }
    return sum;
}

Cycle Cell::oldest_arrival() const {
    Cycle oldest = never;
    for (int side = 0; side < side_count; ++side) {
        const Link* in = inputs_.link(Side(side));
        for (int index = 0; in && index < env_.classes.count; ++index) {
            if (in->front(index).kind != Message::Kind::none) oldest = std::min(oldest, in->arrival(index));
        }
    }
    return oldest;
}

}  // namespace raycell
