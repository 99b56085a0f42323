// A unidirectional FIFO channel between two cells: one set of wires, one buffer per class at the far end
// (paper, section 4.3: "buffers shared by neighbouring cells").
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <systemc>

#include "cells/channels/message.hpp"
#include "cells/channels/observer.hpp"
#include "cells/clock/scheduler.hpp"

namespace raycell {

/// The interface of the sending side, for the ports of modules. Any channel may implement it. The channel
/// keeps time by the Scheduler. Modules may be sensitive to default_event(): it is notified, by the
/// scheduler's wake, in the cycle after room was made for a sender that was refused.
class LinkOut : virtual public sc_core::sc_interface {
  public:
    /// Whether a message of this class can start now: the wires are idle and its buffer has room, as of the
    /// start of the cycle. If the wires are busy, lowers `retry` to the cycle in which they are free; if
    /// there is no room, the sender is told in the cycle after room was made.
    virtual bool can_send(int index, Cycle& retry) = 0;
    /// Starts a message; it is visible at the far end after `cycles` cycles. The receiver is woken `later`
    /// cycles after that, for messages that it can't act on earlier.
    virtual void send(int index, const Message& message, int cycles, int later = 0) = 0;
};

/// The interface of the receiving side. default_event() is notified in the cycle in which a message becomes
/// visible.
class LinkIn : virtual public sc_core::sc_interface {
  public:
    /// The oldest message of a class if it has arrived, else an empty message.
    virtual Message front(int index) const = 0;
    /// Cycle in which the oldest message arrived.
    virtual Cycle arrival(int index) const = 0;
    virtual void pop(int index) = 0;
    /// Messages in a buffer, those still on the wires included.
    virtual int occupancy(int index) const = 0;
};

/// The channel. Writes and reads of a cycle become visible in the next one, so results do not depend on the
/// order in which cells run. Declared final so that calls from a cell are not virtual. An array has four
/// links per cell: data that few links need is kept in Extras, and classes that a link never carries have no
/// buffer. Members are ordered by cache line: the data of every hop first, then one line for each buffer.
class alignas(64) Link final : public LinkOut, public LinkIn {
  public:
    struct ClassStatistics {
        std::uint64_t sent = 0;
        std::uint64_t delivered = 0;
        std::uint64_t occupied_cycles = 0;  ///< sum over messages of their cycles in the buffer
        int peak = 0;
    };
    static constexpr int most_classes = 5;
    static constexpr int most_depth = 65535;
    static constexpr std::uint32_t all_classes = ~std::uint32_t(0);

    /// `used` has a bit for each class that the link carries. Throws std::invalid_argument for a wrong depth
    /// or number of classes.
    Link(Scheduler& scheduler, int classes, int depth, std::uint32_t used = all_classes);
    /// A link without buffers and wires: it forwards send() and can_send() to `beyond`.
    Link(Scheduler& scheduler, int classes, LinkOut& beyond);

    /// Notified for both the sender and the receiver; made by the first call.
    const sc_core::sc_event& default_event() const override;

    void connect_source(Client& source) { source_ = &source; }
    void connect_sink(Client& sink) { sink_ = &sink; }
    /// For sinks with many links: called with `port` and the cycle in which a message of a class will be
    /// visible.
    struct Arrivals {
        virtual ~Arrivals() = default;
        virtual void arrives(std::uint32_t port, int index, Cycle visible) = 0;
    };
    void report_arrivals(Arrivals& arrivals, std::uint32_t port);
    /// Random stalls on the wires (MachineSettings::stall); `who` tells links apart.
    void set_stall(double probability, std::uint64_t seed, std::uint64_t who);
    /// Null: no observer.
    void set_observer(LinkObserver* observer);
    /// A name for reports; links between the cells of an array have none.
    void set_name(std::string name);
    std::string name() const { return extras_ ? extras_->name : std::string(); }

    bool can_send(int index, Cycle& retry) override;
    /// The result of can_send() without a request to be woken, for observers.
    enum class Room : std::uint8_t { free, wires_busy, full };
    Room room(int index) const;
    void send(int index, const Message& message, int cycles, int later = 0) override;
    Message front(int index) const override {
        const Buffer* buffer = find(index);
        if (!buffer || buffer->count == 0) return {};
        const Entry& entry = buffer->at(0);
        return entry.visible <= scheduler_.now() ? entry.message : Message();
    }
    Cycle arrival(int index) const override {
        const Buffer* buffer = find(index);
        return buffer && buffer->count > 0 ? buffer->at(0).visible : never;
    }
    void pop(int index) override;
    /// Puts a message that came by another way into its buffer, which must have room; it arrived in cycle
    /// `arrived`.
    void put(int index, const Message& message, Cycle arrived);

    /// The place of a class's buffer. A sink that keeps it reads the buffer without touching the link's first
    /// cache line. Only for classes that the link carries.
    std::uint8_t place(int index) const { return places_[std::size_t(index)]; }
    const Message* head_at(std::uint8_t place, Cycle now) const {
        const Buffer& b = buffer_at(place);
        if (b.count == 0) return nullptr;
        const Entry& entry = b.at(0);
        return entry.visible <= now ? &entry.message : nullptr;
    }
    /// Cycle in which the oldest message arrives; the buffer must not be empty.
    Cycle arrival_at(std::uint8_t place) const { return buffer_at(place).at(0).visible; }
    /// Cycle since which the oldest message has been at the head of its buffer and visible.
    Cycle head_since_at(std::uint8_t place) const {
        const Buffer& b = buffer_at(place);
        return b.last_pop == never ? b.at(0).visible : std::max(b.at(0).visible, b.last_pop);
    }
    int occupancy_at(std::uint8_t place) const { return buffer_at(place).count; }
    bool sender_waits_at(std::uint8_t place) const { return buffer_at(place).sender_waits; }
    /// Removes the oldest message. Returns the bits that the sink must clear in its pending_: 0 unless the
    /// buffer is empty now.
    std::uint32_t pop_at(std::uint8_t place, Cycle now);
    /// Asks the link to keep `bits` (among bits 0 to 15) set in its sink's pending_ while the buffer of a
    /// class holds a message, arrived or on the wires, so that a cell need not look into empty buffers.
    /// Throws std::logic_error without a sink, std::invalid_argument for other bits.
    void watch(int index, std::uint32_t bits);
    /// Asks the link to set `bits` (among bits 0 to 3) in its source's room_made_ when it wakes a sender that
    /// can_send() refused for lack of room. Until then the sender need not ask again.
    void tell_room(std::uint32_t bits) { room_bits_ = std::uint8_t(bits & 15U); }
    /// Whether a sender was refused for lack of room and no room has been made since.
    bool sender_waits(int index) const { return buffer(index).sender_waits; }
    int occupancy(int index) const override {
        const Buffer* buffer = find(index);
        return buffer ? buffer->count : 0;
    }
    /// Messages in a buffer as its sender sees them in this cycle: those taken in it still count.
    int seen(int index) const {
        const Buffer* b = find(index);
        return b ? int(b->count + b->still_seen(scheduler_.now())) : 0;
    }
    /// Whether the buffer of a class has no room left; for observers, not for sending.
    bool full(int index) const { return occupancy(index) >= depth_; }
    /// A message in a buffer, for observers. `place` counts from the oldest, 0, and is below occupancy().
    struct Held {
        Message message;
        Cycle visible = 0;  ///< when it arrived, or will
    };
    Held held(int index, int place) const;
    /// Cycle of the last pop of a class, `never` before the first.
    Cycle last_pop(int index) const;

    int classes() const { return classes_; }
    int depth() const { return depth_; }
    /// Counts since the last reset; messages still in a buffer count up to now.
    ClassStatistics statistics(int index) const;
    /// Restarts the counts at the start of a phase.
    void reset_statistics();
    std::uint64_t busy_cycles() const;

    /// Bytes of a link without observer, with empty buffers, that carries the classes `used`.
    static std::size_t bytes(std::uint32_t used);

    /// The place of a class's buffer in a link that carries the classes `used`.
    static constexpr std::uint8_t place_of(int index, std::uint32_t used) {
        return std::uint8_t(__builtin_popcount(used & ((1U << unsigned(index)) - 1)));
    }

  private:
    friend class Prefetch;
    using Entry = Held;
    struct alignas(64) Buffer {
        union {
            Entry first;  ///< while capacity is 1
            Entry* ring;  ///< of `capacity` entries, once more than one was needed
        };
        Cycle last_pop = never;
        std::uint64_t occupied = 0;  ///< sum of pop cycles - sum of send cycles: no time stamp per message
        std::uint32_t sent = 0;
        std::uint32_t busy = 0;  ///< cycles that its messages took on the wires
        std::uint16_t pending_bits = 0;
        std::uint16_t capacity = 1;
        std::uint16_t head = 0;
        std::uint16_t count = 0;
        std::uint16_t popped_now = 0;  ///< in cycle last_pop: not yet room for the sender
        std::uint16_t peak = 0;
        bool sender_waits = false;
        bool watched = false;  ///< the link has Extras: pops are told to its observer

        Buffer() : first() {}
        ~Buffer() {
            if (capacity > 1) delete[] ring;
        }
        Buffer(const Buffer&) = delete;
        Buffer& operator=(const Buffer&) = delete;
        Entry& at(std::uint32_t place) { return capacity > 1 ? ring[wrapped(place)] : first; }
        const Entry& at(std::uint32_t place) const { return capacity > 1 ? ring[wrapped(place)] : first; }
        std::uint32_t wrapped(std::uint32_t place) const {
            const std::uint32_t sum = head + place;
            return sum < capacity ? sum : sum - capacity;
        }
        std::uint32_t still_seen(Cycle now) const { return last_pop == now ? popped_now : 0; }
        void grow(int depth);
    };
    /// Data that only some links need: observed or stalled links, and links at the border.
    struct Extras {
        Arrivals* arrivals = nullptr;
        LinkObserver* observer = nullptr;
        std::uint32_t port = 0;
        double stall = 0;
        std::uint64_t stall_seed = 0;
        std::uint64_t stall_who = 0;
        std::uint64_t sends = 0;
        std::string name;
        LinkOut* beyond = nullptr;
        struct Bell : Client {
            sc_core::sc_event event;
            void activate() override { event.notify(); }
        };
        std::unique_ptr<Bell> bell;
        std::unique_ptr<Buffer[]> more_buffers;  ///< beyond the link's own
    };

    static constexpr std::uint8_t no_buffer = 255;
    const Buffer* find(int index) const {
        const std::uint8_t place = places_[std::size_t(index)];
        return place == no_buffer ? nullptr : &buffer_at(place);
    }
    Buffer& buffer_at(std::uint8_t place) {
        return place < own_buffers ? buffers_[place] : extras_->more_buffers[place - own_buffers];
    }
    const Buffer& buffer_at(std::uint8_t place) const { return const_cast<Link*>(this)->buffer_at(place); }
    Buffer& buffer(int index) { return buffer_at(places_[std::size_t(index)]); }
    const Buffer& buffer(int index) const { return buffer_at(places_[std::size_t(index)]); }
    Extras& extras();
    std::uint32_t stalled();
    void tell_sent(int index, const Message& message, int cycles);
    void tell_popped(std::uint8_t place);
    void make_buffers(std::uint32_t used);
    void ring(Cycle cycle);
    void wake_source(Cycle now);

    Scheduler& scheduler_;
    Cycle wires_free_ = 0;
    std::uint16_t depth_;
    std::uint8_t classes_ : 4;
    std::uint8_t room_bits_ : 4;                     ///< bits to set in the source's room_made_
    std::array<std::uint8_t, most_classes> places_;  ///< places of the classes' buffers
    Client* sink_ = nullptr;
    Client* source_ = nullptr;
    std::unique_ptr<Extras> extras_;
    static constexpr std::size_t own_buffers = 3;  ///< enough for a link between cells
    std::array<Buffer, own_buffers> buffers_;
};

// Inline, because a cell calls these in every hop.

inline bool Link::can_send(int index, Cycle& retry) {
    Buffer& b = buffer(index);
    const Cycle now = scheduler_.now();
    const std::uint32_t still_seen = b.still_seen(now);
    if (b.count + still_seen >= depth_) {
        if (depth_ == 0) return extras_->beyond->can_send(index, retry);
        if (still_seen > 0) {
            retry = std::min(retry, now + 1);
        } else {
            b.sender_waits = true;
        }
        return false;
    }
    if (wires_free_ > now) {
        retry = std::min(retry, wires_free_);
        return false;
    }
    return true;
}

inline void Link::send(int index, const Message& message, int cycles, int later) {
    Buffer& b = buffer(index);
    const Cycle now = scheduler_.now();
    if (extras_) {
        if (extras_->beyond) return extras_->beyond->send(index, message, cycles, later);
        cycles += int(stalled());
    }
    if (b.count == b.capacity) b.grow(depth_);
    wires_free_ = now + Cycle(cycles);
    b.at(b.count) = {message, wires_free_};
    ++b.count;
    if (sink_) sink_->pending_ |= b.pending_bits;
    ++b.sent;
    b.occupied -= now;
    // A message read in this cycle still counts: the peak must not depend on which end ran first.
    b.peak = std::max(b.peak, std::uint16_t(b.count + b.still_seen(now)));
    b.busy += std::uint32_t(cycles);
    if (extras_) tell_sent(index, message, cycles);
    if (!sink_) return;
    scheduler_.wake(*sink_, wires_free_ + Cycle(later));
    if (later > 0) scheduler_.sample_at(wires_free_, wires_free_ + Cycle(later));
}

inline std::uint32_t Link::pop_at(std::uint8_t place, Cycle now) {
    Buffer& b = buffer_at(place);
    if (b.watched) tell_popped(place);
    b.occupied += now;
    b.head = std::uint16_t(b.wrapped(1));
    --b.count;
    if (b.last_pop != now) {
        b.last_pop = now;
        b.popped_now = 0;
    }
    ++b.popped_now;
    if (b.sender_waits) {
        b.sender_waits = false;
        wake_source(now);
    }
    return b.count == 0 ? b.pending_bits : 0;
}

inline void Link::wake_source(Cycle now) {
    if (extras_) ring(now + 1);
    if (!source_) return;
    source_->room_made_ |= room_bits_;
    scheduler_.wake(*source_, now + 1);
}

inline void Link::pop(int index) {
    const std::uint32_t emptied = pop_at(place(index), scheduler_.now());
    if (sink_) sink_->pending_ &= ~emptied;
}

}  // namespace raycell
