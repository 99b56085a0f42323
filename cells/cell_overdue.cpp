// Who has waited too long goes first: the fairness that cells/deadlock/deadlock.md asks of a cell.
#include <algorithm>
#include <tuple>

#include "cells/cell.hpp"

namespace raycell {

/// Moves what had waited for more than `patience` cycles when the epoch began, oldest first, whatever it is;
/// the usual order follows for the others. Looks for it when an epoch begins in which there may be any, and
/// in every step while there is: so it does not matter how often the cell runs.
void Cell::move_overdue(Cycle now) {
    const Cycle began = now / epoch * epoch;
    enum Kind { answer, reply, ray };
    std::vector<std::tuple<Cycle, Kind, std::size_t>> overdue;
    overdue_parked_ = 0;
    // Of what is not overdue: what comes later, or from behind it in a buffer, is younger. (But for an answer
    // that stands behind a ray, which can be only where both have one buffer: remove_from() sees to that.)
    Cycle oldest = now;
    const auto add = [&](Cycle since, Kind kind, std::size_t index, std::uint32_t bit) {
        if (since >= began || began - since <= patience) {
            oldest = std::min(oldest, since);
        } else if (parked_ & bit) {
            overdue_parked_ |= std::uint16_t(bit);  // looked at again when it may move
        } else {
            overdue.emplace_back(since, kind, index);
        }
    };
    const int index = env_.classes.answer;
    for (int side = 0; side < side_count; ++side) {
        const std::uint32_t bit = 1U << (answer_bits + unsigned(side));
        if (!(pending_ & bit)) continue;
        const Link* in = in_[std::size_t(side)];
        const std::uint8_t place = answer_places_[std::size_t(side)];
        const Message* head = in->head_at(place, now);
        if (!head || head->kind != Message::Kind::answer) continue;
        add(in->arrival_at(place) + env_.costs().route_return, answer, std::size_t(side), bit);
    }
    if (shading_.job == Shading::Job::direct_answer) add(shading_.done, reply, 0, 0);
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        if (ray_store_[i].state == Slot::State::to_answer) add(ray_store_[i].changed, reply, 0, 0);
    }
    for (std::size_t place = 0; place < place_count(); ++place) {
        if (nothing_at(place)) continue;
        const RayPacket* packet = packet_at(place);
        if (packet && packet->stage == RayPacket::Stage::decided) {
            add(packet->decided, ray, place, bit_of(place));
        }
    }
    // Otherwise not before the epoch in which the oldest can be overdue.
    look_for_overdue_ = overdue.empty() ? ((oldest + patience) / epoch + 1) * epoch : now + 1;
    std::sort(overdue.begin(), overdue.end());
    for (const auto& [since, kind, at] : overdue) {
        if (kind == answer) {
            const Link& in = *in_[at];
            const int held = in.occupancy(index);
            move_answer(at, now);
            if (in.occupancy(index) < held) answers_moved_ |= std::uint8_t(1U << at);
        } else if (kind == reply) {
            move_replies(now);  // all of them: there are finitely many
        } else {
            try_ray(*packet_at(at), at, now);
        }
    }
}

}  // namespace raycell
