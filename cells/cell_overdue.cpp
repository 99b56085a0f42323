// Who has waited too long goes first: the fairness that cells/deadlock.md asks of a cell.
#include <algorithm>
#include <tuple>

#include "cells/cell.hpp"

namespace raycell {

void Cell::move_overdue(Cycle now) {
    overdue_ = false;  // whoever fails again sets it again
    enum Kind { answer, direct_reply, reply, ray };
    std::vector<std::tuple<Cycle, Kind, std::size_t>> waiting;
    const auto add = [&](Cycle since, Kind kind, std::size_t index) {
        if (since < now && now - since > patience) waiting.emplace_back(since, kind, index);
    };
    const int index = env_.classes.answer;
    for (int side = 0; side < side_count; ++side) {
        if (!(pending_ >> (answer_bits + unsigned(side)) & 1)) continue;
        const LinkIn* in = in_[std::size_t(side)];
        if (in->front(index).kind != Message::Kind::answer) continue;
        add(in->arrival(index) + env_.costs().route_return, answer, std::size_t(side));
    }
    if (shading_.job == Shading::Job::direct_answer) add(shading_.done, direct_reply, 0);
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        if (ray_store_[i].state == Slot::State::to_answer) add(ray_store_[i].shaded, reply, i);
    }
    for (std::size_t place = 0; place < place_count(); ++place) {
        if (nothing_at(place)) continue;
        const RayPacket* packet = packet_at(place);
        if (packet && packet->stage == RayPacket::Stage::decided) add(packet->decided, ray, place);
    }
    std::sort(waiting.begin(), waiting.end());
    for (const auto& [since, kind, at] : waiting) {
        if (kind == answer && move_answer(*in_[at], now)) answers_moved_ |= 1U << at;
        if (kind == direct_reply) reply_directly(now);
        if (kind == reply) reply_from_slot(std::uint32_t(at), now);
        if (kind == ray && !move_ray(*packet_at(at), at, now)) passed_over(since, now);
    }
}

}  // namespace raycell
