// Asking for memory ahead: in a large array a hop costs what the caches miss, not what it computes.
#include <algorithm>

#include "cells/cell.hpp"

namespace raycell {

/// What every step looks at: it comes first in a cell.
void Cell::fetch() const {
    constexpr std::size_t line = 64;
    const char* at = reinterpret_cast<const char*>(this);
    for (std::size_t i = 0; i < hot_lines; ++i) __builtin_prefetch(at + i * line, 1);
    __builtin_prefetch(&statistics_, 1);
}

void Cell::fetch_links() const {
    time_out_.fetch();
    for (std::uint32_t inputs = pending_ & ((1U << ray_input_count_) - 1) & ~parked_; inputs;
         inputs &= inputs - 1) {
        const RayInput& input = ray_inputs_[std::size_t(__builtin_ctz(inputs))];
        in_[std::size_t(input.side)]->fetch(env_.buffer_places[std::size_t(input.side)][input.index]);
    }
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        in_[side]->fetch(env_.buffer_places[side][std::size_t(env_.classes.answer)]);
    }
    if (pending_ & ~decided_ & ~bit_in_test()) __builtin_prefetch(&store_);
    for (std::uint32_t rays = (decided_ | bit_in_test()) & ~parked_; rays; rays &= rays - 1) {
        const Way& way = ways_[std::size_t(__builtin_ctz(rays))];
        if (way.side == no_way || !out_[way.side]) continue;
        out_[way.side]->fetch(env_.buffer_places[way.side][way.index]);
        fetch_neighbour(way.side);
    }
}

void Cell::fetch_messages() const {
    constexpr std::size_t line = 64;
    const auto fetch_object = [](const void* object, std::size_t bytes) {
        const char* at = static_cast<const char*>(object);
        for (std::size_t i = 0; i < bytes; i += line) __builtin_prefetch(at + i, 1);
    };
    for (std::uint32_t inputs = pending_ & ((1U << ray_input_count_) - 1); inputs; inputs &= inputs - 1) {
        const auto place = std::size_t(__builtin_ctz(inputs));
        if (parked_ >> place & 1) continue;
        const RayPacket* packet = packet_at(place);
        if (!packet) continue;
        // Who waits for the room that it leaves behind is woken.
        const RayInput& input = ray_inputs_[place];
        const auto side = std::size_t(input.side);
        if (in_[side]->sender_waits(input.index)) fetch_neighbour(side);
        fetch_object(packet, sizeof(RayPacket));
        if (traversal_.packet || decided_ >> place & 1) continue;
        // It will be tested: the depths of the first voxels, which it is compared with.
        constexpr std::size_t most_voxels = 6;
        const std::size_t voxels = std::min(store_.voxels.size(), most_voxels);
        for (std::size_t i = 0; i < voxels; ++i) __builtin_prefetch(&store_.voxels[i].near);
    }
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        const Message* head = in_[side]->head(env_.classes.answer);
        if (!head || head->kind != Message::Kind::answer) continue;
        fetch_object(head->answer, sizeof(Answer));
        if (in_[side]->sender_waits(env_.classes.answer)) fetch_neighbour(side);
    }
}

/// Of answers, which only their destination tells.
void Cell::fetch_ways() const {
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const Message* head = in_[std::size_t(__builtin_ctz(sides))]->head(env_.classes.answer);
        if (!head || head->kind != Message::Kind::answer || local(*head->answer)) continue;
        const auto side = std::size_t(route(*head->answer));
        out_[side]->fetch(env_.buffer_places[side][std::size_t(env_.classes.answer)]);
        fetch_neighbour(side);
        __builtin_prefetch(&env_.pixel_hops[std::size_t(head->answer->id >> 32)], 1);
    }
}

}  // namespace raycell
