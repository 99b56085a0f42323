// A cell's behaviour: no process of its own, its host calls step() in every cycle in which something may have
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
/// while it is tested and until what it needs next is free: the output buffer, a slot, or the way for its
/// answer.
class alignas(64) Cell final : public Client {
  public:
    Cell(Environment& environment, int x, int y);

    // Before the simulation starts. A side that is never connected is the array's border.
    void set_host(CellHost& host) { host_ = &host; }
    void connect_in(Side side, Link& in) { inputs_.connect(side, in); }
    void connect_out(Side side, Link& out) { router_.connect(side, out); }
    /// The way in of load messages; else the west link.
    void connect_load(Link& load) { load_in_ = &load; }
    /// All links are connected.
    void elaborate();

    /// Woken: the host is to call step().
    void activate() override { host_->activate(*this); }
    void foreseen() const override { host_->foresee(*this); }

    /// Begins the environment's phase in the next cycle.
    void begin_phase();

    /// One cycle. Returns the next cycle in which the cell wants to run of itself, `never` if none.
    Cycle step(Cycle now);

    /// The depths of the store's voxels, which must not change any more: kept by the caller.
    void set_runs(const DepthRun* runs) { runs_ = {runs, std::uint32_t(store_.voxels.size())}; }

    const CellStore& store() const { return store_; }
    CellStore& store() { return store_; }
    const RayStore& ray_store() const { return ray_store_; }
    int x() const { return x_; }
    int y() const { return y_; }
    std::uint64_t schedule_hash() const { return meter_.hash(); }
    /// What loading leaves in a cell beside its voxels.
    struct Loading {
        std::uint64_t hash = 0;  ///< of its schedule
        std::uint64_t hops = 0;
    };
    Loading loading() const { return {meter_.hash(), meter_.statistics().load_hops}; }
    void restore(const Loading& loading) { meter_.restore(loading.hash, loading.hops); }
    /// What the cell has done so far; what is still going on counts up to `now`.
    CellStatistics statistics(Cycle now) const;
    /// Cycles that the units' operations of the moment will still take: counted when each began.
    struct Remaining {
        Cycle traversal = 0;
        Cycle shading = 0;
    };
    Remaining remaining(Cycle now) const;
    /// True while anything in the cell is unfinished: a unit at work, a slot in use, an own ray not answered.
    bool busy() const;
    const TimeOut& time_out() const { return time_out_; }

    // For whoever looks at a cell from outside, as it stands at the end of the last cycle run.
    const Environment& environment() const { return env_; }
    // The links, null over the border, also to set observers before a run.
    Link* input(Side side) const { return inputs_.link(side); }
    Link* output(Side side) const { return router_.link(side); }
    Link* load_input() const { return load_in_; }
    const TraversalUnit& traversal() const { return traversal_; }
    const ShadingUnit& shading() const { return shading_; }
    const LoadingUnit& loading_unit() const { return loading_; }
    const Injector& injector() const { return injector_; }
    bool is_home(const Answer& answer) const { return answer.home_x == x_ && answer.home_y == y_; }
    /// The side over which an answer goes on: along x, then along y.
    Side route(const Answer& answer) const { return Router::way_home(answer, x_, y_); }
    /// Whether a slot lacks nothing any more; whether any does.
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
    /// Bit per side with an answer that may move.
    std::uint32_t answers_to_move() const {
        return (pending_ & ~router_.parked()) >> InputPorts::answer_bits;
    }
    void move_rays(Cycle now);
    // A place is where a ray that can be tested or moved stands: the input buffers, then the cell's own ray,
    // then the slots' child registers (last, because the store may grow while places are gone through).
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

    // cell_statistics.cpp: what waits, and for what
    Wait wait_of(const RayPacket& packet, std::size_t place) const {
        // Nobody notes down that a ray has come to the head of its buffer: the link knows.
        const bool arrived = packet.stage == RayPacket::Stage::untested && packet.wait.cause == Stall::none;
        if (!arrived || place >= own_place()) return packet.wait;
        return {inputs_.head_since(place), Stall::traversal};
    }
    /// An attempt to move failed because of `cause`.
    void stall(Wait& wait, Stall cause, std::uint64_t ray, Cycle now) {
        if (wait.cause == cause) return;
        settle(wait, ray, now);
        wait = {now, cause};
    }
    /// What waited goes on.
    void settle(const Wait& wait, std::uint64_t ray, Cycle now) {
        if (wait.cause != Stall::none && now > wait.since) add_stall(wait, ray, now);
    }
    void add_stall(const Wait& wait, std::uint64_t ray, Cycle now);

    /// Cycles of a unit's operation, with its random stalls.
    std::uint32_t unit_cycles(std::uint32_t cycles);
    void want(Cycle cycle) { wakeup_.at(cycle); }
    void use_shading_unit(ShadingUnit::Job job, std::uint32_t slot, std::uint32_t cycles, Cycle now);
    /// Into the schedule's hash, `hashed`, and to whoever watches.
    void record(Cycle now, CellEvent event, std::uint32_t hashed, std::uint64_t ray, std::uint32_t detail);
    void record_send(Cycle now, Side side, int index, std::uint64_t ray) {
        const std::uint32_t detail = std::uint32_t(side) << 8 | unsigned(index);
        record(now, CellEvent::send, detail, ray, detail);
    }
    /// To whoever watches alone.
    void tell(Cycle now, CellEvent event, std::uint64_t ray, std::uint32_t detail) const {
        if (env_.meters.observer) env_.meters.observer->cell_event(*this, now, event, ray, detail);
    }

    /// Places of slots that hold a child; there are none without slots in use.
    std::size_t slot_places() const { return children_ > 0 ? ray_store_.touched() : 0; }
    /// Something of a slot has changed: its next child may go, or the shading unit may have work.
    void slot_changed() {
        feed_at_ = 0;
        look_to_shade_ = true;
    }
    /// Bit per place that may hold a ray: inputs and the own ray.
    std::uint32_t occupied() const {
        return inputs_.with_rays(pending_) | std::uint32_t(injector_.ray() != nullptr) << own_place();
    }
    bool test_at(std::size_t place, Cycle now);
    /// The bit of an input or of the own ray in the words below; 0 for a slot's place.
    std::uint32_t bit_of(std::size_t place) const { return place <= own_place() ? 1U << unsigned(place) : 0; }
    void unpark(Cycle now);
    std::uint32_t bit_in_test() const { return traversal_.packet() ? bit_of(traversal_.place()) : 0; }

    static_assert(AgingArbiter::others == 1U << (InputPorts::answer_bits - 1) &&
                  InputPorts::most_ray_inputs + 1 < InputPorts::answer_bits);  // a bit that no place has

    // Everything step() reads comes first; what few cells or reports need, last. Prefetch checks it.
    friend class Prefetch;
    Environment& env_;
    CellHost* host_ = nullptr;
    Wakeup wakeup_;
    std::uint16_t x_;
    std::uint16_t y_;
    // pending_: buffers that hold anything, arrived or on the wires. room_made_: a bit per output behind
    // which room was made since somebody parked on it. Both are the client's.
    std::uint32_t decided_ = 0;  ///< rays whose test is over

    TraversalUnit traversal_;
    Cycle feed_at_ = never;  ///< cycle from which on a slot may have a child to send
    AgingArbiter aging_;
    std::uint16_t replies_ = 0;       ///< answers of slots and of the shading unit that want to go
    std::uint16_t children_ = 0;      ///< on their way out of slots
    std::uint8_t answers_moved_ = 0;  ///< bit per side whose buffer of answers was read in this cycle
    Stall cause_ = Stall::none;       ///< why the last attempt to move something failed
    bool look_to_shade_ : 1;          ///< a slot may have work for the shading unit
    bool replies_first_ : 1;          ///< replies go before answers that came in, which went last
    bool answer_moved_ : 1;           ///< this cycle: an answer left an input
    bool moved_ : 1;                  ///< this cycle: something went on, or came home
    bool blocked_ : 1;                ///< this cycle: something wanted to and could not

    DepthRuns runs_;            ///< of the voxels, once they are all there
    Cycle store_port_ = never;  ///< cycle in which the ray store's one write port was used
    TimeOut time_out_;
    Router router_;
    InputPorts inputs_;

    Injector injector_;
    ShadingUnit shading_;

    CellMeter meter_;  // its first counters are the last hot ones

    CellStore store_;
    RayStore ray_store_;
    std::uint64_t operations_ = 0;      ///< of the units, for their random stalls
    std::vector<std::uint64_t> asked_;  ///< memo: per voxel, sources already asked for
    LoadingUnit loading_;
    Link* load_in_ = nullptr;
};

}  // namespace raycell
