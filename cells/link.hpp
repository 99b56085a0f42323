// A unidirectional FIFO channel between two cells: one set of wires, one buffer per class at the far end
// (paper, section 4.3: "buffers shared by neighbouring cells").
#pragma once

#include <string>
#include <systemc>
#include <vector>

#include "cells/message.hpp"
#include "cells/observer.hpp"
#include "cells/scheduler.hpp"

namespace raycell {

/// What the sending side sees.
class LinkOut : virtual public sc_core::sc_interface {
  public:
    /// Whether a message of this class can start now: wires idle and room in its buffer, as they stood when
    /// the cycle began. If not, `retry` is lowered to the cycle in which the wires are free, or the sender is
    /// woken in the cycle after room was made.
    virtual bool can_send(int index, Cycle& retry) = 0;
    /// What can_send() would say, without asking to be woken: for whoever watches. A channel that can't tell
    /// says free.
    enum class Room : std::uint8_t { free, wires_busy, full };
    virtual Room room(int /*index*/) const { return Room::free; }
    /// Starts a message; it is visible at the far end after its link cycles.
    virtual void send(int index, const Message& message, int cycles) = 0;
    /// Whether the buffer of a class has no room left; for looking at a machine, not for sending.
    virtual bool full(int index) const = 0;
};

/// What the receiving side sees.
class LinkIn : virtual public sc_core::sc_interface {
  public:
    /// The oldest message of a class if it has arrived, else an empty one.
    virtual Message front(int index) const = 0;
    /// Cycle in which the oldest message arrived.
    virtual Cycle arrival(int index) const = 0;
    /// Cycle from which on the oldest message has been both arrived and the oldest.
    virtual Cycle head_since(int index) const { return arrival(index); }
    virtual void pop(int index) = 0;
    /// Messages in a buffer, those still on the wires included.
    virtual int occupancy(int index) const = 0;
    /// What stands in a buffer, oldest first, for looking at a machine; `place` below occupancy().
    struct Held {
        Message message;
        Cycle visible = 0;  ///< when it arrived, or will
    };
    virtual Held held(int index, int place) const = 0;
    /// Cycle of the last pop of a class, `never` before the first.
    virtual Cycle last_pop(int index) const = 0;
    /// Asks the channel to keep `bits` set in `pending` while the buffer of a class holds anything, on the
    /// wires or arrived: so a cell need not look into empty buffers. A channel that can't leaves them set for
    /// ever.
    virtual void watch(int /*index*/, std::uint32_t* pending, std::uint32_t bits) { *pending |= bits; }
};

/// The channel. Writes and reads of a cycle show in the next one, so the order in which cells run does not
/// matter.
class Link : public LinkOut, public LinkIn {
  public:
    struct ClassStatistics {
        std::uint64_t sent = 0;
        std::uint64_t delivered = 0;
        std::uint64_t occupied_cycles = 0;  ///< sum over messages of the cycles that they took up a place
        int peak = 0;
    };

    Link(Scheduler& scheduler, int classes, int depth);

    void connect_source(Client& source) { source_ = &source; }
    void connect_sink(Client& sink) { sink_ = &sink; }
    /// For sinks with many links: called with `port` and the cycle in which a message of a class will be
    /// visible.
    struct Arrivals {
        virtual ~Arrivals() = default;
        virtual void arrives(std::uint32_t port, int index, Cycle visible) = 0;
    };
    void report_arrivals(Arrivals& arrivals, std::uint32_t port) {
        arrivals_ = &arrivals;
        port_ = port;
    }
    /// Random stalls on the wires (MachineSettings::stall); `who` tells links apart.
    void set_stall(double probability, std::uint64_t seed, std::uint64_t who) {
        stall_ = probability;
        stall_seed_ = seed;
        stall_who_ = who;
    }
    /// Null: nobody watches.
    void set_observer(LinkObserver* observer) { observer_ = observer; }
    /// The name as "cell_3_4.east", for reports.
    void set_name(std::string name) { name_ = std::move(name); }
    const std::string& name() const { return name_; }

    bool can_send(int index, Cycle& retry) override;
    Room room(int index) const override;
    void send(int index, const Message& message, int cycles) override;
    Message front(int index) const override;
    Cycle arrival(int index) const override;
    Cycle head_since(int index) const override;
    void pop(int index) override;
    void watch(int index, std::uint32_t* pending, std::uint32_t bits) override;
    int occupancy(int index) const override { return int(buffers_[std::size_t(index)].count); }

    bool full(int index) const override { return occupancy(index) >= depth_; }
    Held held(int index, int place) const override;
    Cycle last_pop(int index) const override { return buffers_[std::size_t(index)].last_pop; }

    int classes() const { return int(buffers_.size()); }
    int depth() const { return depth_; }
    /// Since the last reset; what still stands in a buffer counts up to now.
    ClassStatistics statistics(int index) const;
    /// Begins a phase: counts anew.
    void reset_statistics();
    std::uint64_t busy_cycles() const { return busy_cycles_; }

  private:
    struct Entry {
        Message message;
        Cycle sent = 0;
        Cycle visible = 0;
    };
    struct Buffer {
        std::vector<Entry> ring;  ///< grows to `depth` at most
        std::uint32_t head = 0;
        std::uint32_t count = 0;
        std::uint32_t popped_now = 0;  ///< in cycle last_pop: not yet room for the sender
        Cycle last_pop = never;
        bool sender_waits = false;
        std::uint32_t pending_bits = 0;
        std::uint32_t* pending = nullptr;  ///< the sink's
        ClassStatistics statistics;
    };

    Scheduler& scheduler_;
    Client* source_ = nullptr;
    Client* sink_ = nullptr;
    Arrivals* arrivals_ = nullptr;
    LinkObserver* observer_ = nullptr;
    std::uint32_t port_ = 0;
    std::vector<Buffer> buffers_;
    int depth_;
    Cycle wires_free_ = 0;
    std::uint64_t busy_cycles_ = 0;
    double stall_ = 0;
    std::uint64_t stall_seed_ = 0;
    std::uint64_t stall_who_ = 0;
    std::uint64_t sends_ = 0;
    std::string name_;
};

}  // namespace raycell
