// A cell's behaviour. It has no process: its host calls step() in every cycle in which something may have
// changed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cells/cell_host.hpp"
#include "cells/channels/link.hpp"
#include "cells/environment.hpp"
#include "cells/passing.hpp"
#include "cells/units/aging_arbiter.hpp"
#include "cells/units/injector.hpp"
#include "cells/units/input_ports.hpp"
#include "cells/units/loading_unit.hpp"
#include "cells/units/ray_store.hpp"
#include "cells/units/router.hpp"
#include "cells/units/shading_unit.hpp"
#include "cells/units/time_out.hpp"
#include "cells/units/traversal_unit.hpp"

namespace raycell {

/// One cell (paper, section 4): four input and four output links, a traversal unit, a shading unit, a ray
/// store. Each unit does one thing at a time; costs come from the cost table. A ray stays in its input buffer
/// during its test and until the resource that it needs next is free: an output buffer, a slot, or the way
/// for its answer.
class alignas(64) Cell final : public Client {
  public:
    Cell(Environment& environment, int x, int y);

    // To be called before the simulation starts. A side that is never connected is the array's border.
    void set_host(CellHost& host) { host_ = &host; }
    void connect_in(Side side, Link& in) { inputs_.connect(side, in); }
    void connect_out(Side side, Link& out) { router_.connect(side, out); }
    /// Sets the link on which load messages come in; the default is the west link.
    void connect_load(Link& load) { load_in_ = &load; }
    /// To be called once all links are connected.
    void elaborate();

    /// The scheduler wakes the cell: asks the host to call step().
    void activate() override { host_->activate(*this); }
    void foreseen() const override { host_->foresee(*this); }

    /// Begins the environment's phase in the next cycle.
    void begin_phase();

    /// Begins with the tree of a pixel of its block once more, in a phase trace that is over.
    void begin_tree(int pixel);

    /// Runs one cycle. Returns the next cycle in which the cell must run without being woken; `never` if
    /// there is none.
    Cycle step(Cycle now);

    /// Sets where a copy of the store's index table lies; the voxels must not change any more. `lines` must
    /// outlive the cell.
    void set_index(const IndexEntry* lines) { index_ = {lines, std::uint32_t(store_.index.size())}; }

    const CellStore& store() const { return store_; }
    CellStore& store() { return store_; }
    const RayStore& ray_store() const { return ray_store_; }
    int x() const { return x_; }
    int y() const { return y_; }
    std::uint64_t schedule_hash() const { return meter_.hash(); }
    // For a module in the cell's place that keeps its books here (CellSocket::replaces()).
    CellMeter& meter() { return meter_; }
    Injector& injector() { return injector_; }
    TimeOut& time_out() { return time_out_; }
    RayStore& ray_store() { return ray_store_; }
    ShadingUnit& shading() { return shading_; }
    LoadingUnits& loading_units() { return loading_; }
    /// The state that loading leaves in a cell beside its voxels.
    struct Loading {
        std::uint64_t hash = 0;  ///< of its schedule
        std::uint64_t hops = 0;
        std::uint64_t cycles = 0;  ///< of making voxels
    };
    Loading loading() const {
        return {meter_.hash(), meter_.statistics().load_hops, meter_.statistics().loading_cycles};
    }
    void restore(const Loading& loading) { meter_.restore(loading.hash, loading.hops, loading.cycles); }
    /// Counters of the cell so far; waits and operations still going on count up to cycle `now`.
    CellStatistics statistics(Cycle now) const;
    /// Cycles that the units' current operations still need, those of several units added; statistics counted
    /// them in full when the operations began.
    struct Remaining {
        Cycle traversal = 0;
        Cycle shading = 0;
    };
    Remaining remaining(Cycle now) const;
    /// True while anything in the cell is unfinished: a unit at work, a slot in use, an own ray not answered.
    bool busy() const;
    const TimeOut& time_out() const { return time_out_; }

    // For observers: the state at the end of the last cycle run.
    const Environment& environment() const { return env_; }
    // The links, null at the array's border; also used to set observers before a run.
    Link* input(Side side) const { return inputs_.link(side); }
    Link* output(Side side) const { return router_.link(side); }
    Link* load_input() const { return load_in_; }
    const TraversalUnits& traversal() const { return traversal_; }
    const ShadingUnit& shading() const { return shading_; }
    const LoadingUnits& loading_unit() const { return loading_; }
    const Injector& injector() const { return injector_; }
    bool is_home(const Answer& answer) const { return answer.home_x == x_ && answer.home_y == y_; }
    /// The side over which an answer leaves: along x first, then along y.
    Side route(const Answer& answer) const { return Router::way_home(answer, x_, y_); }
    /// Whether a slot has all its answers and can be shaded.
    bool complete(const Slot& slot) const {
        return ShadingUnit::complete(slot, store_, env_.settings.shadows);
    }
    bool slot_complete() const {
        return ShadingUnit::any_complete(ray_store_, store_, env_.settings.shadows);
    }
    /// Whether the ray store's one write port was used in cycle `now`.
    bool port_used(Cycle now) const { return store_port_ == now; }
    /// Cycle in which the oldest message in the cell's inputs arrived, `never` if there is none.
    Cycle oldest_arrival() const;

  private:
    // cell_load.cpp
    void step_load(Cycle now);
    // cell.cpp: traversal and routing
    void finish_traversal(Cycle now);
    void start_traversal(Cycle now);
    void move_answers(Cycle now);
    void move_answer(std::size_t from, Cycle now);
    /// One bit per side: it holds an answer that is not parked.
    std::uint32_t answers_to_move() const {
        return (pending_ & ~router_.parked()) >> InputPorts::answer_bits;
    }
    void move_rays(Cycle now);
    // A place holds a ray that can be tested or moved. Order of places: input buffers, the cell's own ray,
    // the child registers of the slots (last, because the store may grow during a loop over the places).
    std::size_t own_place() const { return inputs_.ray_inputs(); }
    std::size_t first_slot_place() const { return own_place() + 1; }
    std::size_t place_count() const { return first_slot_place() + ray_store_.touched(); }
    RayPacket* packet_at(std::size_t place) const;
    bool nothing_at(std::size_t place) const { return place < own_place() && !(pending_ >> place & 1); }
    void remove_from(std::size_t place);
    void try_ray(RayPacket& packet, std::size_t place, Cycle now);
    bool move_ray(RayPacket& packet, std::size_t place, Cycle now);
    bool forward(RayPacket& packet, std::size_t place, Cycle now);
    bool respond(RayPacket& packet, std::size_t place, Cycle now);
    bool postpone(RayPacket& packet, std::size_t place, Cycle now);
    void end_silently(RayPacket& packet, std::size_t place, Cycle now);
    bool send_answer(const Answer& answer, Cycle now);
    // cell_overdue.cpp
    void move_overdue(Cycle now);
    // cell_deliver.cpp: answers that are home
    void deliver(const Answer& answer, Cycle now);
    void deliver_to_slot(const Answer& answer, Cycle now);
    // cell_inject.cpp: own rays and children of slots
    void feed_own(Cycle now);
    void feed_children(Cycle now);
    RayPacket* next_child(Slot& slot, std::uint32_t index, Cycle now);
    RayPacket* launch(const Ray& ray, const Ray* parent);
    // cell_shade.cpp: hits, the shading unit's jobs, replies
    bool accept_hit(RayPacket& packet, std::size_t place, Cycle now);
    bool accept_direct(RayPacket& packet, std::size_t place, Cycle now);
    void begin_direct(RayPacket& packet, Cycle now);
    void start_shading(Cycle now);
    void finish_shading(Cycle now);
    bool has_replies() const { return replies_ > 0; }
    void move_replies(Cycle now);
    void release_slot(std::uint32_t index, Cycle now);

    // cell_statistics.cpp: waits and their causes
    Wait wait_of(const RayPacket& packet, std::size_t place) const {
        // The cell does not record when a ray reaches the head of its buffer: the link knows it.
        const bool arrived = packet.stage == RayPacket::Stage::untested && packet.wait.cause == Stall::none;
        if (!arrived || place >= own_place()) return packet.wait;
        return {inputs_.head_since(place), Stall::traversal};
    }
    /// An attempt to move failed because of `cause`: begins a wait, unless one with this cause is going on.
    void stall(Wait& wait, Stall cause, std::uint64_t ray, Cycle now) {
        if (wait.cause == cause) return;
        settle(wait, ray, now);
        wait = {now, cause};
    }
    /// The wait is over: counts its cycles.
    void settle(const Wait& wait, std::uint64_t ray, Cycle now) {
        if (wait.cause != Stall::none && now > wait.since) add_stall(wait, ray, now);
    }
    void add_stall(const Wait& wait, std::uint64_t ray, Cycle now);

    /// The cycles of a unit's operation, random stalls added.
    std::uint32_t unit_cycles(std::uint32_t cycles);
    void want(Cycle cycle) { wakeup_.at(cycle); }
    void use_shading_unit(ShadingUnit::Job job, std::uint32_t slot, std::uint32_t cycles, Cycle now);
    /// Adds an event to the schedule's hash, with the word `hashed`, and tells the observer.
    void record(Cycle now, CellEvent event, std::uint32_t hashed, std::uint64_t ray, std::uint32_t detail);
    void record_send(Cycle now, Side side, int index, std::uint64_t ray) {
        const std::uint32_t detail = std::uint32_t(side) << 8 | unsigned(index);
        record(now, CellEvent::send, detail, ray, detail);
    }
    /// Tells the observer only.
    void tell(Cycle now, CellEvent event, std::uint64_t ray, std::uint32_t detail) const {
        if (env_.meters.observer) env_.meters.observer->cell_event(*this, now, event, ray, detail);
    }

    /// Number of slot places to scan for children; 0 if no slot holds a child.
    std::size_t slot_places() const { return children_ > 0 ? ray_store_.touched() : 0; }
    /// A slot has changed: its next child may leave, or the shading unit may have work.
    void slot_changed() {
        feed_at_ = 0;
        look_to_shade_ = true;
    }
    /// One bit per ray input that holds a message, and one for the own ray.
    std::uint32_t occupied() const {
        return inputs_.with_rays(pending_) | std::uint32_t(injector_.ray() != nullptr) << own_place();
    }
    void test_at(std::size_t place, Cycle now);
    /// The bit of a ray input or of the own ray in decided_, pending_ and the router's words; 0 for a slot's
    /// place.
    std::uint32_t bit_of(std::size_t place) const { return place <= own_place() ? 1U << unsigned(place) : 0; }
    void unpark(Cycle now);
    std::uint32_t bits_in_test() const {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < traversal_.count(); ++i) {
            if (traversal_.packet(i)) bits |= bit_of(traversal_.place(i));
        }
        return bits;
    }

    static_assert(AgingArbiter::others == 1U << (InputPorts::answer_bits - 1) &&
                  InputPorts::most_ray_inputs + 1 < InputPorts::answer_bits);  // no place has this bit

    // Members are ordered by cache line: everything step() reads comes first, data of few cells or of reports
    // last. Prefetch checks this order.
    friend class Prefetch;
    Environment& env_;
    CellHost* host_ = nullptr;
    Wakeup wakeup_;
    std::uint16_t x_;
    std::uint16_t y_;
    // Inherited from Client: pending_ has a bit per buffer that holds a message, arrived or still on the
    // wires; room_made_ has a bit per output whose far buffer got room since a message parked on it.
    std::uint32_t decided_ = 0;  ///< bits of rays whose test is over

    TraversalUnits traversal_;
    Cycle feed_at_ = never;  ///< first cycle in which a slot may have a child to send
    AgingArbiter aging_;
    std::uint16_t replies_ = 0;       ///< replies that want to leave
    std::uint16_t children_ = 0;      ///< slots with a ray in their child register
    std::uint8_t answers_moved_ = 0;  ///< this cycle: bit per side whose overdue answer moved
    Stall cause_ = Stall::none;       ///< why the last attempt to move something failed
    bool look_to_shade_ : 1;          ///< a slot may have work for the shading unit
    bool replies_first_ : 1;          ///< replies go before incoming answers, which had the last turn
    bool answer_moved_ : 1;           ///< this cycle: an answer left an input
    bool moved_ : 1;                  ///< this cycle: a message moved, came home or was shaded
    bool blocked_ : 1;                ///< this cycle: a message could not move

    IndexTable index_;          ///< the store's, set after loading
    Cycle store_port_ = never;  ///< cycle in which the ray store's one write port was used
    TimeOut time_out_;
    Router router_;
    InputPorts inputs_;

    Injector injector_;
    ShadingUnit shading_;

    CellMeter meter_;  // its first counters are the last hot ones

    CellStore store_;
    RayStore ray_store_;
    std::uint64_t operations_ = 0;      ///< of the units so far, for their random stalls
    std::vector<std::uint64_t> asked_;  ///< memo: per voxel, sources already asked for
    LoadingUnits loading_;
    Link* load_in_ = nullptr;
};

}  // namespace raycell
