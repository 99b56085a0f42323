// Asking for memory ahead: in a large array a hop costs what the caches miss, not what it computes.
#include <algorithm>

#include "cells/cell.hpp"

namespace raycell {

/// What every step looks at: it comes first in a cell.
void Cell::fetch(const void* cell) {
    constexpr std::size_t line = 64;
    const char* at = static_cast<const char*>(cell);
    for (std::size_t i = 0; i < hot_lines; ++i) fetch_line(at + i * line);
}

void Cell::fetch_links() const {
    time_out_.fetch();
    for (std::uint32_t inputs = pending_ & ((1U << ray_input_count_) - 1) & ~parked_; inputs;
         inputs &= inputs - 1) {
        const RayInput& input = ray_inputs_[std::size_t(__builtin_ctz(inputs))];
        in_[std::size_t(input.side)]->fetch_buffer(input.place);
    }
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        in_[side]->fetch_buffer(answer_places_[side]);
    }
    // A ray will be tested: the depths that it is compared with.
    if (occupied() & ~decided_ & ~bit_in_test()) {
        constexpr std::uint32_t most = 32;
        constexpr std::uint32_t in_line = 64 / sizeof(DepthRun);
        for (std::uint32_t i = 0; i < std::min(run_count_, most); i += in_line) fetch_line(runs_ + i);
        if (env_.context.traffic) fetch_line(&store_);
    }
    for (std::uint32_t rays = (decided_ | bit_in_test()) & ~parked_; rays; rays &= rays - 1) {
        const Way& way = ways_[std::size_t(__builtin_ctz(rays))];
        if (way.side == no_way || !out_[way.side]) continue;
        out_[way.side]->fetch(env_.buffer_places[way.side][way.index]);
        fetch_neighbour(way.side);
    }
}

/// Who waits for the room that a message leaves behind in a buffer is woken.
void Cell::fetch_sender(std::size_t side, std::uint8_t place) const {
    if (!in_[side]->sender_waits_at(place)) return;
    in_[side]->fetch_source();
    fetch_neighbour(side);
}

void Cell::fetch_messages() const {
    constexpr std::size_t line = 64;
    const auto fetch_object = [](const void* object, std::size_t bytes) {
        const char* at = static_cast<const char*>(object);
        for (std::size_t i = 0; i < bytes; i += line) fetch_line(at + i);
    };
    for (std::uint32_t inputs = pending_ & ((1U << ray_input_count_) - 1); inputs; inputs &= inputs - 1) {
        const auto place = std::size_t(__builtin_ctz(inputs));
        if (parked_ >> place & 1) continue;
        const RayPacket* packet = packet_at(place);
        if (!packet) continue;
        fetch_sender(std::size_t(ray_inputs_[place].side), ray_inputs_[place].place);
        fetch_object(packet, sizeof(RayPacket));
        // Synthetic traffic knows the cell by its voxel.
        if (env_.context.traffic) fetch_line(store_.voxels.data());
    }
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        const Message* head = in_[side]->head_at(answer_places_[side], env_.scheduler.now());
        if (!head || head->kind != Message::Kind::answer) continue;
        fetch_object(head->answer, sizeof(Answer));
        fetch_sender(side, answer_places_[side]);
    }
}

/// Of answers, which only their destination tells.
void Cell::fetch_ways() const {
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto from = std::size_t(__builtin_ctz(sides));
        const Message* head = in_[from]->head_at(answer_places_[from], env_.scheduler.now());
        if (!head || head->kind != Message::Kind::answer || is_home(*head->answer)) continue;
        const auto side = std::size_t(route(*head->answer));
        out_[side]->fetch(env_.buffer_places[side][std::size_t(env_.classes.answer)]);
        fetch_neighbour(side);
        fetch_line(&env_.pixel_hops[pixel_of(head->answer->id)]);
    }
}

}  // namespace raycell
