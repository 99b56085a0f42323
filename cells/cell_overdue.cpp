// Overdue messages move first (cells/units/aging_arbiter.hpp), then all others in the usual order.
#include "cells/cell.hpp"

namespace raycell {

void Cell::move_overdue(Cycle now) {
    using Kind = AgingArbiter::Kind;
    AgingArbiter::Look look(aging_, now);
    const auto is_parked = [&](std::uint32_t bit) { return (router_.parked() & bit) != 0; };
    for (std::size_t side = 0; side < side_count; ++side) {
        const std::uint32_t bit = InputPorts::answer_bit(side);
        if (!(pending_ & bit) || !inputs_.answer(side, now)) continue;
        look.add(inputs_.answer_arrival(side) + env_.costs().route_return, Kind::answer, side, bit,
                 is_parked(bit));
    }
    if (shading_.job() == ShadingUnit::Job::direct_answer) look.add(shading_.done(), Kind::reply, 0);
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        if (ray_store_[i].state == Slot::State::to_answer) look.add(ray_store_[i].changed, Kind::reply, 0);
    }
    for (std::size_t place = 0; place < place_count(); ++place) {
        if (nothing_at(place)) continue;
        const RayPacket* packet = packet_at(place);
        if (packet && packet->stage == RayPacket::Stage::decided)
            look.add(packet->decided, Kind::ray, place, bit_of(place), is_parked(bit_of(place)));
    }
    const int index = env_.classes.answer;
    for (const AgingArbiter::Overdue& overdue : look.finish()) {
        if (overdue.kind == Kind::answer) {
            const Link& in = *inputs_.link(Side(overdue.index));
            const int held = in.occupancy(index);
            move_answer(overdue.index, now);
            if (in.occupancy(index) < held) answers_moved_ |= std::uint8_t(1U << overdue.index);
        } else if (overdue.kind == Kind::reply) {
            move_replies(now);  // all replies move: their number is bounded
        } else {
            try_ray(*packet_at(overdue.index), overdue.index, now);
        }
    }
}

}  // namespace raycell
