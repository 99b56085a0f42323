#include "cells/channels/link.hpp"

#include <algorithm>
#include <stdexcept>

#include "model/machine/stall.hpp"

namespace raycell {

Link::Link(Scheduler& scheduler, int classes, int depth, std::uint32_t used)
    : scheduler_(scheduler),
      depth_(std::uint16_t(depth)),
      classes_(std::uint8_t(classes & 15)),
      room_bits_(0) {
    static_assert(sizeof(Buffer) == 64 && sizeof(Link) == (1 + own_buffers) * 64);
    if (depth < 1 || depth > most_depth || classes > most_classes)
        throw std::invalid_argument("a link of " + std::to_string(depth) +
                                    " messages a buffer; expected 1 to " + std::to_string(most_depth));
    make_buffers(used);
}

Link::Link(Scheduler& scheduler, int classes, LinkOut& beyond) : Link(scheduler, classes, 1) {
    depth_ = 0;
    extras().beyond = &beyond;
}

void Link::make_buffers(std::uint32_t used) {
    places_.fill(no_buffer);
    std::uint8_t buffers = 0;
    for (int index = 0; index < classes_; ++index) {
        if (used >> index & 1) places_[std::size_t(index)] = buffers++;
    }
    if (buffers > own_buffers) {
        extras().more_buffers = std::make_unique<Buffer[]>(buffers - own_buffers);
        for (std::size_t i = 0; i < buffers - own_buffers; ++i) extras_->more_buffers[i].watched = true;
    }
}

std::size_t Link::bytes(std::uint32_t used) {
    constexpr std::size_t allocation = 64;  // what the heap adds per block of cache lines, in bytes
    const auto buffers = std::size_t(__builtin_popcount(used));
    if (buffers <= own_buffers) return sizeof(Link);
    return sizeof(Link) + allocation + (buffers - own_buffers) * sizeof(Buffer);
}

Link::Extras& Link::extras() {
    if (extras_) return *extras_;
    extras_ = std::make_unique<Extras>();
    for (Buffer& b : buffers_) b.watched = true;
    return *extras_;
}

void Link::report_arrivals(Arrivals& arrivals, std::uint32_t port) {
    extras().arrivals = &arrivals;
    extras().port = port;
}

void Link::set_stall(double probability, std::uint64_t seed, std::uint64_t who) {
    extras().stall = probability;
    extras().stall_seed = seed;
    extras().stall_who = who;
}

void Link::set_observer(LinkObserver* observer) { extras().observer = observer; }

void Link::set_name(std::string name) { extras().name = std::move(name); }

const sc_core::sc_event& Link::default_event() const {
    // Making the event changes no result of a run.
    auto& bell = const_cast<Link*>(this)->extras().bell;
    if (!bell) bell = std::make_unique<Extras::Bell>();
    return bell->event;
}

void Link::ring(Cycle cycle) {
    if (extras_->bell) scheduler_.wake(*extras_->bell, cycle);
}

void Link::put(int index, const Message& message, Cycle arrived) {
    Buffer& b = buffer(index);
    if (b.count == b.capacity) b.grow(depth_);
    b.at(b.count) = {message, arrived};
    ++b.count;
    ++b.sent;
    b.occupied -= scheduler_.now();
    b.peak = std::max(b.peak, b.count);
    if (sink_) sink_->pending_ |= b.pending_bits;
}

std::uint32_t Link::stalled() {
    if (!(extras_->stall > 0)) return 0;
    return stall_cycles(extras_->stall, extras_->stall_seed, extras_->stall_who, extras_->sends++);
}

void Link::tell_sent(int index, const Message& message, int cycles) {
    if (extras_->observer) extras_->observer->sent(*this, index, message, cycles, scheduler_.now());
    if (extras_->arrivals) extras_->arrivals->arrives(extras_->port, index, wires_free_);
    ring(wires_free_);
}

void Link::tell_popped(std::uint8_t place) {
    if (!extras_->observer) return;
    const int index = int(std::find(places_.begin(), places_.end(), place) - places_.begin());
    extras_->observer->popped(*this, index, buffer_at(place).at(0).message, scheduler_.now());
}

Link::Room Link::room(int index) const {
    if (depth_ == 0) {
        Cycle retry = never;
        if (extras_->beyond->can_send(index, retry)) return Room::free;
        return retry == never ? Room::full : Room::wires_busy;
    }
    const Buffer& b = buffer(index);
    const Cycle now = scheduler_.now();
    if (b.count + b.still_seen(now) >= depth_) return Room::full;
    return wires_free_ > now ? Room::wires_busy : Room::free;
}

/// Doubles the capacity, up to `depth`: most buffers of a deep machine never fill.
void Link::Buffer::grow(int depth) {
    const auto larger = std::uint16_t(std::min(depth, 2 * int(capacity)));
    auto* entries = new Entry[larger];
    for (std::uint32_t i = 0; i < count; ++i) entries[i] = at(i);
    if (capacity > 1) delete[] ring;
    ring = entries;
    head = 0;
    capacity = larger;
}

void Link::watch(int index, std::uint32_t bits) {
    if (!sink_) throw std::logic_error("a link without a sink is watched");
    Buffer& b = buffer(index);
    if (bits > 0xffffU) throw std::invalid_argument("a link's sink has bits of 0 to 15");
    b.pending_bits = std::uint16_t(bits);
    if (b.count > 0) sink_->pending_ |= bits;
}

Link::ClassStatistics Link::statistics(int index) const {
    ClassStatistics sum;
    const Buffer* b = find(index);
    if (!b) return sum;
    sum.sent = b->sent;
    sum.delivered = b->sent - b->count;
    sum.peak = b->peak;
    sum.occupied_cycles = b->occupied + b->count * scheduler_.now();
    return sum;
}

/// Messages still in a buffer count as sent at the start of the new phase.
void Link::reset_statistics() {
    for (int index = 0; index < classes_; ++index) {
        if (!find(index)) continue;
        Buffer& b = buffer(index);
        b.sent = b.count;
        b.busy = 0;
        b.occupied = -(b.count * scheduler_.now());
        b.peak = b.count;
    }
}

std::uint64_t Link::busy_cycles() const {
    std::uint64_t sum = 0;
    for (int index = 0; index < classes_; ++index) {
        if (const Buffer* b = find(index)) sum += b->busy;
    }
    // A message still on the wires was counted with all its cycles when it was sent.
    const Cycle now = scheduler_.now();
    return wires_free_ > now ? sum - std::min<std::uint64_t>(sum, wires_free_ - now) : sum;
}

Link::Held Link::held(int index, int place) const { return buffer(index).at(std::uint32_t(place)); }

Cycle Link::last_pop(int index) const {
    const Buffer* b = find(index);
    return b ? b->last_pop : never;
}

}  // namespace raycell
