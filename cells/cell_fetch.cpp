// Asking for memory ahead: in a large array a hop costs what the caches miss, not what it computes.
#include <algorithm>
#include <cstddef>

#include "cells/cell.hpp"

namespace raycell {

/// What every step looks at: it comes first in a cell.
void Cell::fetch(const void* cell) {
    constexpr std::size_t line = 64;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
    // What follows the first counters of the statistics is cold.
    static_assert(offsetof(Cell, statistics_) + offsetof(CellStatistics, stalls) <= hot_lines * line);
    static_assert(offsetof(Cell, store_) > hot_lines * line);
#pragma GCC diagnostic pop
    const char* at = static_cast<const char*>(cell);
    for (std::size_t i = 0; i < hot_lines; ++i) fetch_line(at + i * line);
}

void Cell::fetch_links() const {
    time_out_.fetch();
    for (std::uint32_t rays = inputs_.with_rays(pending_) & ~router_.parked(); rays; rays &= rays - 1)
        inputs_.fetch_buffer(std::size_t(__builtin_ctz(rays)));
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1)
        inputs_.fetch_answers(std::size_t(__builtin_ctz(sides)));
    // A ray will be tested: the depths that it is compared with.
    if (occupied() & ~decided_ & ~bit_in_test()) {
        constexpr std::uint32_t most = 32;
        constexpr std::uint32_t in_line = 64 / sizeof(DepthRun);
        for (std::uint32_t i = 0; i < std::min(run_count_, most); i += in_line) fetch_line(runs_ + i);
        if (env_.context.traffic) fetch_line(&store_);
    }
    for (std::uint32_t rays = (decided_ | bit_in_test()) & ~router_.parked(); rays; rays &= rays - 1) {
        const Way& way = ways_[std::size_t(__builtin_ctz(rays))];
        const Link* out = way.side == no_way ? nullptr : router_.link(Side(way.side));
        if (!out) continue;
        out->fetch(env_.buffer_places[way.side][way.index]);
        fetch_neighbour(way.side);
    }
}

/// Who waits for the room that a message leaves behind in a buffer is woken.
void Cell::fetch_sender(std::size_t side, std::uint8_t place) const {
    const Link& in = *inputs_.link(Side(side));
    if (!in.sender_waits_at(place)) return;
    in.fetch_source();
    fetch_neighbour(side);
}

void Cell::fetch_messages() const {
    constexpr std::size_t line = 64;
    const auto fetch_object = [](const void* object, std::size_t bytes) {
        const char* at = static_cast<const char*>(object);
        for (std::size_t i = 0; i < bytes; i += line) fetch_line(at + i);
    };
    for (std::uint32_t rays = inputs_.with_rays(pending_) & ~router_.parked(); rays; rays &= rays - 1) {
        const auto place = std::size_t(__builtin_ctz(rays));
        const RayPacket* packet = packet_at(place);
        if (!packet) continue;
        fetch_sender(inputs_.side_of(place), inputs_.place_of(place));
        fetch_object(packet, sizeof(RayPacket));
        // Synthetic traffic knows the cell by its voxel.
        if (env_.context.traffic) fetch_line(store_.voxels.data());
    }
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        const Answer* answer = inputs_.answer(side, env_.scheduler.now());
        if (!answer) continue;
        fetch_object(answer, sizeof(Answer));
        fetch_sender(side, inputs_.answer_place(side));
    }
}

/// Of answers, which only their destination tells.
void Cell::fetch_ways() const {
    for (std::uint32_t sides = answers_to_move(); sides; sides &= sides - 1) {
        const auto from = std::size_t(__builtin_ctz(sides));
        const Answer* answer = inputs_.answer(from, env_.scheduler.now());
        if (!answer || is_home(*answer)) continue;
        const Side side = route(*answer);
        router_.link(side)->fetch(env_.buffer_places[std::size_t(side)][std::size_t(env_.classes.answer)]);
        fetch_neighbour(std::size_t(side));
        fetch_line(&env_.pixel_hops[pixel_of(answer->id)]);
    }
}

}  // namespace raycell
