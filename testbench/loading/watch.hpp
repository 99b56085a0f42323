// Follows every load message through the links and units of the pipeline, checks the rules of the design and
// adds up where the cycles went.
#pragma once

#include <array>
#include <vector>

#include "cells/clock/scheduler.hpp"
#include "testbench/loading/faults.hpp"
#include "testbench/loading/plan.hpp"

namespace raycell::loading {

/// Cycles in which a unit had finished a message and could not send it.
struct OutputWait {
    std::uint64_t full = 0;  ///< no room in the buffer at the far end
    std::uint64_t busy = 0;  ///< room, but the wires carried another message
};

/// Where a unit's cycles went, from the start of loading to its last message. A distributor sends to the east
/// and down at the same time, so its waits may overlap; `blocked` counts each cycle once. A cell looks at
/// messages and makes voxels at the same time: all but `making` is about the messages.
struct UnitUse {
    std::uint64_t messages = 0;  ///< taken; geometry: sent
    std::uint64_t busy_cycles = 0;
    std::uint64_t starved_cycles = 0;  ///< no message has arrived in the input buffer
    std::uint64_t blocked_cycles = 0;
    std::array<OutputWait, 2> waits;  ///< the only output, or east; down
    std::uint64_t queue_full = 0;     ///< of `blocked`, in a cell: it keeps as many spans as it may
    std::uint64_t spans = 0;          ///< kept by a cell until their voxels were made
    std::uint64_t making = 0;         ///< cycles in which a cell made voxels
    std::uint64_t most_kept = 0;      ///< spans at a time, those at work included
};

struct LinkUse {
    std::uint64_t sent = 0;
    std::uint64_t delivered = 0;
    std::uint64_t wire_cycles = 0;      ///< random stalls included
    std::uint64_t occupied_cycles = 0;  ///< sum over messages of the cycles that each held a place
    int depth = 0;
    int peak = 0;
    Cycle first_arrival = never;
    Cycle last_arrival = 0;
};

/// Gets every message that is sent over a link and every one that leaves a buffer, cycle by cycle.
class LoadListener {
  public:
    virtual ~LoadListener() = default;
    virtual void sent(std::size_t link, const LoadItem& item, int cycles, Cycle now) = 0;
    virtual void popped(std::size_t link, const LoadItem& item, Cycle now) = 0;
};

class LoadWatch : public LoadListener {
  public:
    /// `plan` and `machine` must outlive it.
    LoadWatch(const LoadPlan& plan, const MachineSettings& machine);

    void sent(std::size_t link, const LoadItem& item, int cycles, Cycle now) override;
    void popped(std::size_t link, const LoadItem& item, Cycle now) override;
    /// Call after a run that was not stopped: checks that all messages arrived and none is left.
    void finish();
    /// Call after finish(): checks that loading was over in the cycle in which its last cell was loaded.
    void finish_at(Cycle load_cycles);

    const std::vector<UnitUse>& units() const { return use_; }
    const std::vector<LinkUse>& links() const { return link_use_; }

    /// Messages keep their order in links and units; a cell or distributor sends on what it took. Sources and
    /// viewer come first, a cell knows the features of every span's object, nothing follows the end-of-scene
    /// mark.
    const Faults& order() const { return order_; }
    /// Every unit and link handles the messages of the plan, no more and no fewer, in as many cycles;
    /// geometry, precomputation and distributors send them in its order and with its bits.
    const Faults& content() const { return content_; }
    /// Every sent message arrives, and every cell drops the messages that end in it.
    const Faults& conservation() const { return conservation_; }
    /// A message moves in the first cycle in which its unit is done, the wires are free and there is room. A
    /// cell is loaded when the end-of-scene mark has passed and its last voxel is made and in order.
    const Faults& promptness() const { return promptness_; }

  private:
    struct Held {
        const LoadItem* item;
        std::uint64_t ticket;  ///< its number in the order in which messages began their way
        Cycle sent;
        Cycle arrival;
        std::uint32_t work;  ///< cycles of work at the far end
        bool makes_voxel;    ///< there; asked early, because the cell alters a span before it takes it
    };
    struct LinkState {
        std::vector<Held> held;   ///< oldest first
        std::vector<Cycle> room;  ///< cycles of pops whose room no later message has used
        Cycle wires_free = 0;
        Cycle last_pop = never;
        int popped_now = 0;  ///< in cycle last_pop
        std::uint64_t next_ticket = 0;
    };
    struct UnitState {
        Cycle begin = 1;  ///< first cycle in which it can take a message, or begin the next trapeze
        Cycle ready = 0;  ///< cycle in which its current work is done
        Cycle last_send = 0;
        bool works = false;              ///< distributor: is working on the oldest message of its input
        const LoadItem* held = nullptr;  ///< cell: taken in cycle `taken`, to be sent in the same cycle
        std::uint64_t ticket = 0;
        Cycle taken = never;
        std::vector<Cycle> kept;  ///< cell: when the voxels of the spans kept will be made, in order
        Cycle room = 0;           ///< cell: first cycle in which it could keep the span at hand
        Cycle ordered = 0;        ///< cell: cycle in which the last voxel stands in the index table
        Cycle made = 0;           ///< cell: cycle in which all voxels of the spans kept are made and in order
        bool set_up = false;      ///< cell: sources and viewer are known
        bool finished = false;    ///< cell: has seen the end-of-scene mark
        std::uint32_t object = no_object;
    };
    static constexpr std::uint32_t no_object = ~std::uint32_t(0);

    // Each returns the message's ticket.
    std::uint64_t leave_geometry(int lane, Cycle now);
    std::uint64_t leave_precomputation(int lane, const LoadItem& item, Cycle now);
    std::uint64_t leave_distributor(std::size_t link, const LoadItem& item, Cycle now);
    std::uint64_t leave_cell(std::size_t link, const LoadItem& item, Cycle now);
    void leave(std::size_t link, std::size_t output, Cycle ready, Cycle now);
    void begin_work(std::size_t unit, const Held& head);
    void compare(std::size_t link, const std::vector<std::uint64_t>& planned, const LoadItem& item);
    void take_into_precomputation(std::size_t unit, const Held& held, Cycle now);
    void take_into_distributor(std::size_t unit, const Held& held, Cycle now);
    void take_into_cell(std::size_t unit, const Held& held, Cycle now);
    void keep_span(std::size_t unit, Cycle now);
    void latch(std::size_t unit, const LoadItem& item, Cycle now);
    void finish_link(std::size_t link);
    void finish_unit(std::size_t unit);
    bool makes_voxel(std::size_t unit, const LoadItem& item) const;
    std::uint32_t work_at(std::size_t unit, const LoadItem& item) const;
    std::string at(std::size_t link, Cycle now) const;
    std::string in(std::size_t unit, Cycle now) const;

    const LoadPlan& plan_;
    const Layout& layout_;
    const MachineSettings& machine_;
    const CostTable& costs_;
    std::vector<LinkState> links_;
    std::vector<UnitState> units_;
    std::vector<LinkUse> link_use_;
    std::vector<UnitUse> use_;
    std::vector<std::uint64_t> dropped_;  ///< by row
    Faults order_;
    Faults content_;
    Faults conservation_;
    Faults promptness_;
    Cycle loaded_ = 0;  ///< cycle in which the last cell that has seen the mark was loaded
};

}  // namespace raycell::loading
