#include "cells/hosts/prefetch.hpp"

#include <algorithm>

namespace raycell {

Prefetch::Prefetch(const BufferClasses& classes, int width) {
    const auto column = std::ptrdiff_t(sizeof(Cell));
    neighbours_ = {column, column * width, -column, -column * width};
    for (std::size_t side = 0; side < side_count; ++side) {
        for (int index = 0; index < classes.count; ++index) {
            places_[side][std::size_t(index)] = Link::place_of(index, classes.used_over(Side(side)));
        }
    }
}

void Prefetch::cell(const void* client) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
    // Only the statistics' first counters are hot.
    constexpr std::size_t counters = offsetof(CellMeter, statistics_) + offsetof(CellStatistics, stalls);
    static_assert(offsetof(Cell, meter_) + counters <= hot_lines * line);
    static_assert(offsetof(Cell, store_) > hot_lines * line);
#pragma GCC diagnostic pop
    const char* at = static_cast<const char*>(client);
    for (std::size_t i = 0; i < hot_lines; ++i) fetch_line(at + i * line);
}

template <typename Object>
void Prefetch::object(const Object& object) {
    const char* at = reinterpret_cast<const char*>(&object);
    for (std::size_t i = 0; i < sizeof(Object); i += line) fetch_line(at + i);
}

void Prefetch::buffer(const Link& link, std::size_t place) {
    if (place < Link::own_buffers) fetch_line(&link.buffers_[place]);
}

/// The sender to be woken, if one waits for the room that a message leaves in a buffer.
void Prefetch::sender(const Cell& cell, std::size_t side, std::uint8_t place) const {
    const Link& in = *cell.inputs_.link(Side(side));
    if (!in.sender_waits_at(place)) return;
    fetch_line(&in);
    neighbour(cell, Side(side));
}

/// The cache line that a message over a link touches in the cell at the other end.
void Prefetch::neighbour(const Cell& cell, Side side) const {
    fetch_line(reinterpret_cast<const char*>(&cell) + neighbours_[std::size_t(side)]);
}

void Prefetch::output(const Cell& cell, Side side, int index) const {
    const Link* out = cell.router_.link(side);
    if (!out) return;
    fetch_line(out);
    buffer(*out, places_[std::size_t(side)][std::size_t(index)]);
    neighbour(cell, side);
}

void Prefetch::links(const Cell& cell) {
    if (cell.time_out_.since() != never) fetch_line(cell.time_out_.ended_);
    for (std::uint32_t rays = rays_of(cell); rays; rays &= rays - 1) {
        const auto input = std::size_t(__builtin_ctz(rays));
        buffer(*cell.inputs_.link(Side(cell.inputs_.side_of(input))), cell.inputs_.place_of(input));
    }
    for (std::uint32_t sides = cell.answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        buffer(*cell.inputs_.link(Side(side)), cell.inputs_.answer_place(side));
    }
    // A ray will be tested: prefetches the depths with which it is compared.
    if (cell.occupied() & ~cell.decided_ & ~cell.bits_in_test()) {
        constexpr std::uint32_t most = 32;
        constexpr std::uint32_t in_line = line / sizeof(IndexEntry);
        for (std::uint32_t i = 0; i < std::min(cell.index_.count, most); i += in_line)
            fetch_line(cell.index_.first + i);
        if (cell.env_.context.traffic) fetch_line(&cell.store_);
    }
}

void Prefetch::messages(const Cell& cell) const {
    for (std::uint32_t rays = rays_of(cell); rays; rays &= rays - 1) {
        const auto input = std::size_t(__builtin_ctz(rays));
        const RayPacket* packet = cell.packet_at(input);
        if (!packet) continue;
        sender(cell, cell.inputs_.side_of(input), cell.inputs_.place_of(input));
        object(*packet);
        // Synthetic traffic reads the cell's voxel.
        if (cell.env_.context.traffic) fetch_line(cell.store_.voxels.data());
    }
    for (std::uint32_t sides = cell.answers_to_move(); sides; sides &= sides - 1) {
        const auto side = std::size_t(__builtin_ctz(sides));
        const Answer* answer = cell.inputs_.answer(side, cell.env_.scheduler.now());
        if (!answer) continue;
        object(*answer);
        sender(cell, side, cell.inputs_.answer_place(side));
    }
}

void Prefetch::outputs(const Cell& cell) const {
    const auto output_of = [&](const RayPacket* packet) {
        if (packet && packet->need.kind == Need::Kind::output)
            output(cell, packet->need.side, packet->need.index);
    };
    // Most often a test is over in this step.
    for (std::size_t i = 0; i < cell.traversal_.count(); ++i) output_of(cell.traversal_.packet(i));
    const std::uint32_t decided = cell.decided_ & ~cell.router_.parked();
    for (std::uint32_t rays = decided; rays; rays &= rays - 1)
        output_of(cell.packet_at(std::size_t(__builtin_ctz(rays))));
    for (std::uint32_t sides = cell.answers_to_move(); sides; sides &= sides - 1) {
        const auto from = std::size_t(__builtin_ctz(sides));
        const Answer* answer = cell.inputs_.answer(from, cell.env_.scheduler.now());
        if (!answer || cell.is_home(*answer)) continue;
        output(cell, cell.route(*answer), cell.env_.classes.answer);
        fetch_line(&cell.env_.meters.pixel_hops[pixel_of(answer->id)]);
    }
}

}  // namespace raycell
