#include "cells/link.hpp"

#include <algorithm>

#include "model/stall.hpp"

namespace raycell {

Link::Link(Scheduler& scheduler, int classes, int depth)
    : scheduler_(scheduler), buffers_(std::size_t(classes)), depth_(depth) {}

bool Link::can_send(int index, Cycle& retry) {
    Buffer& buffer = buffers_[std::size_t(index)];
    const Cycle now = scheduler_.now();
    const std::uint32_t still_seen = buffer.last_pop == now ? buffer.popped_now : 0;
    if (buffer.count + still_seen >= std::uint32_t(depth_)) {
        if (still_seen > 0) {
            retry = std::min(retry, now + 1);
        } else {
            buffer.sender_waits = true;
        }
        return false;
    }
    if (wires_free_ > now) {
        retry = std::min(retry, wires_free_);
        return false;
    }
    return true;
}

LinkOut::Room Link::room(int index) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    const Cycle now = scheduler_.now();
    const std::uint32_t still_seen = buffer.last_pop == now ? buffer.popped_now : 0;
    if (buffer.count + still_seen >= std::uint32_t(depth_)) return Room::full;
    return wires_free_ > now ? Room::wires_busy : Room::free;
}

void Link::send(int index, const Message& message, int cycles) {
    Buffer& buffer = buffers_[std::size_t(index)];
    const Cycle now = scheduler_.now();
    if (buffer.ring.size() < std::size_t(depth_) && buffer.count == buffer.ring.size()) {
        // Unroll the ring before it grows, so that order is kept.
        std::rotate(buffer.ring.begin(), buffer.ring.begin() + buffer.head, buffer.ring.end());
        buffer.head = 0;
        buffer.ring.emplace_back();
    }
    if (stall_ > 0) cycles += int(stall_cycles(stall_, stall_seed_, stall_who_, sends_++));
    const std::size_t place = (buffer.head + buffer.count) % buffer.ring.size();
    buffer.ring[place] = {message, now, now + Cycle(cycles)};
    ++buffer.count;
    if (buffer.pending) *buffer.pending |= buffer.pending_bits;
    ++buffer.statistics.sent;
    // A place read in this cycle still counts: the peak must not depend on which end ran first.
    const std::uint32_t still_seen = buffer.last_pop == now ? buffer.popped_now : 0;
    buffer.statistics.peak = std::max(buffer.statistics.peak, int(buffer.count + still_seen));
    wires_free_ = now + Cycle(cycles);
    busy_cycles_ += std::uint64_t(cycles);
    if (observer_) observer_->sent(*this, index, message, cycles, now);
    if (arrivals_) arrivals_->arrives(port_, index, wires_free_);
    if (sink_) scheduler_.wake(*sink_, wires_free_);
}

void Link::watch(int index, std::uint32_t* pending, std::uint32_t bits) {
    Buffer& buffer = buffers_[std::size_t(index)];
    buffer.pending = pending;
    buffer.pending_bits = bits;
    if (buffer.count > 0) *pending |= bits;
}

Link::ClassStatistics Link::statistics(int index) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    ClassStatistics sum = buffer.statistics;
    for (std::uint32_t i = 0; i < buffer.count; ++i) {
        sum.occupied_cycles += scheduler_.now() - buffer.ring[(buffer.head + i) % buffer.ring.size()].sent;
    }
    return sum;
}

void Link::reset_statistics() {
    busy_cycles_ = 0;
    for (Buffer& buffer : buffers_) {
        buffer.statistics = ClassStatistics();
        buffer.statistics.peak = int(buffer.count);
    }
}

Message Link::front(int index) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    if (buffer.count == 0) return {};
    const Entry& entry = buffer.ring[buffer.head];
    return entry.visible <= scheduler_.now() ? entry.message : Message();
}

Link::Held Link::held(int index, int place) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    const Entry& entry = buffer.ring[(buffer.head + std::uint32_t(place)) % buffer.ring.size()];
    return {entry.message, entry.visible};
}

Cycle Link::arrival(int index) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    return buffer.count == 0 ? never : buffer.ring[buffer.head].visible;
}

Cycle Link::head_since(int index) const {
    const Buffer& buffer = buffers_[std::size_t(index)];
    return buffer.last_pop == never ? arrival(index) : std::max(arrival(index), buffer.last_pop);
}

void Link::pop(int index) {
    Buffer& buffer = buffers_[std::size_t(index)];
    const Cycle now = scheduler_.now();
    if (observer_) observer_->popped(*this, index, buffer.ring[buffer.head].message, now);
    buffer.statistics.occupied_cycles += now - buffer.ring[buffer.head].sent;
    ++buffer.statistics.delivered;
    buffer.head = std::uint32_t((buffer.head + 1) % buffer.ring.size());
    --buffer.count;
    if (buffer.count == 0 && buffer.pending) *buffer.pending &= ~buffer.pending_bits;
    if (buffer.last_pop != now) {
        buffer.last_pop = now;
        buffer.popped_now = 0;
    }
    ++buffer.popped_now;
    if (buffer.sender_waits) {
        buffer.sender_waits = false;
        if (source_) scheduler_.wake(*source_, now + 1);
    }
}

}  // namespace raycell
