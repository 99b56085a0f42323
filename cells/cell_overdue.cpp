// What has waited for too long goes first (cells/units/aging_arbiter.hpp); the usual order follows for the
// others.
#include "cells/cell.hpp"

namespace raycell {

void Cell::move_overdue(Cycle now) {
    using Kind = AgingArbiter::Kind;
    AgingArbiter::Look look(aging_, now);
    const auto is_parked = [&](std::uint32_t bit) { return (parked_ & bit) != 0; };
    for (int side = 0; side < side_count; ++side) {
        const std::uint32_t bit = 1U << (answer_bits + unsigned(side));
        if (!(pending_ & bit)) continue;
        const Link* in = in_[std::size_t(side)];
        const std::uint8_t place = answer_places_[std::size_t(side)];
        const Message* head = in->head_at(place, now);
        if (!head || head->kind != Message::Kind::answer) continue;
        look.add(in->arrival_at(place) + env_.costs().route_return, Kind::answer, std::size_t(side), bit,
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
            const Link& in = *in_[overdue.index];
            const int held = in.occupancy(index);
            move_answer(overdue.index, now);
            if (in.occupancy(index) < held) answers_moved_ |= std::uint8_t(1U << overdue.index);
        } else if (overdue.kind == Kind::reply) {
            move_replies(now);  // all of them: there are finitely many
        } else {
            try_ray(*packet_at(overdue.index), overdue.index, now);
        }
    }
}

}  // namespace raycell
