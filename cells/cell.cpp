#include "cells/cell.hpp"

#include <algorithm>

#include "model/machine/stall.hpp"

namespace raycell {

Cell::Cell(Environment& environment, int x, int y)
    : env_(environment),
      x_(std::uint16_t(x)),
      y_(std::uint16_t(y)),
      traversal_(environment.machine.traversal_units),
      look_to_shade_(false),
      replies_first_(false),
      answer_moved_(false),
      moved_(false),
      blocked_(false),
      injector_(environment.own_rays),
      ray_store_(environment.machine.ray_store, waiting_generations(environment.context),
                 environment.machine.slots),
      loading_(environment.machine.loading_units) {}

void Cell::elaborate() {
    router_.elaborate();
    inputs_.elaborate(env_.classes);
    if (!load_in_) load_in_ = inputs_.link(Side::west);
}

void Cell::begin_phase() {
    if (env_.context.settings.shadows == Shadows::memo && env_.phase == Phase::trace) {
        asked_.assign(store_.voxels.size(), 0);
    }
    begin_tracing(injector_, env_, 0, env_.phase == Phase::trace ? env_.settings.block() : 0,
                  start_of_primaries(env_, x_, y_));
}

void Cell::begin_tree(int pixel) { begin_tracing(injector_, env_, pixel, pixel + 1, 0); }

Cycle Cell::step(Cycle now) {
    wakeup_ = Wakeup();
    moved_ = blocked_ = answer_moved_ = false;
    if (env_.phase == Phase::load) {
        step_load(now);
        return wakeup_.next;
    }
    if (room_made_) unpark(now);
    // Most steps have little to do: each part is called only when it has work.
    if (!traversal_.idle()) finish_traversal(now);
    if (!shading_.idle()) finish_shading(now);
    answers_moved_ = 0;
    if (aging_.due(now)) move_overdue(now);
    // Replies of this cell and incoming answers take turns when both want to go.
    if (replies_first_) {
        if (has_replies()) move_replies(now);
        if (answers_to_move()) move_answers(now);
    } else {
        if (answers_to_move()) move_answers(now);
        if (has_replies()) move_replies(now);
    }
    if (!injector_.ray() && (injector_.primary_to_send() || env_.phase == Phase::precast)) feed_own(now);
    if (now >= feed_at_) {
        feed_children(now);
    } else if (!env_.draining) {
        want(feed_at_);
    }
    move_rays(now);
    if (traversal_.free()) start_traversal(now);
    if (look_to_shade_ && shading_.idle()) start_shading(now);
    time_out_.step(moved_, blocked_ || router_.parked(), now, env_.wait_counts);
    return wakeup_.next;
}

void Cell::unpark(Cycle now) { aging_.unparked(router_.unpark(room_made_), now); }

void Cell::record(Cycle now, CellEvent event, std::uint32_t hashed, std::uint64_t ray, std::uint32_t detail) {
    meter_.note(now, event, hashed);
    if (event != CellEvent::test) moved_ = true;
    tell(now, event, ray, detail);
}

// ---- traversal
// -----------------------------------------------------------------------------------------------

RayPacket* Cell::packet_at(std::size_t place) const {
    if (place < own_place()) return inputs_.ray(place, env_.scheduler.now());
    if (place == own_place()) return injector_.ray();
    return ray_store_[std::uint32_t(place - first_slot_place())].child;
}

void Cell::remove_from(std::size_t place) {
    moved_ = true;
    decided_ &= ~bit_of(place);
    const Cycle now = env_.scheduler.now();
    if (place < own_place()) {
        bool more = false;
        pending_ &= ~inputs_.pop_ray(place, now, more);
        if (!more) return;
        want(now + 1);
        // An answer that stood behind the ray may have waited longer than any other message.
        if (env_.classes.count == 1) aging_.new_head(now);
        return;
    }
    if (place == own_place()) {
        injector_.left();
    } else {
        Slot& slot = ray_store_[std::uint32_t(place - first_slot_place())];
        slot.child = nullptr;
        --children_;
        slot_changed();
        slot.wait = {now, Stall::shading};
    }
    want(now + 1);  // the next child or own ray may follow
}

std::uint32_t Cell::unit_cycles(std::uint32_t cycles) {
    if (!(env_.machine.stall > 0)) return cycles;
    const std::uint64_t who = std::uint64_t(y_) << 32 | std::uint64_t(x_) << 1 | 1;
    return cycles + stall_cycles(env_.machine.stall, env_.machine.seed, who, operations_++);
}

void Cell::finish_traversal(Cycle now) {
    traversal_.finish(now, wakeup_, [&](std::uint32_t place) { decided_ |= bit_of(place); });
}

/// The next untested rays, round robin over the places, until no unit is free.
void Cell::start_traversal(Cycle now) {
    const std::size_t slots = slot_places();
    std::uint32_t inputs = occupied() & ~decided_ & ~bits_in_test();
    if (inputs == 0 && slots == 0) return;
    // Places of slots come last, so the round is: inputs from next() on, slots, inputs before next(). The
    // number of slots is read last, because it lies in another cache line.
    const std::size_t first_slot = first_slot_place();
    const std::size_t next = traversal_.next();
    const std::size_t start = next < first_slot || next < place_count() ? next : 0;
    const std::uint32_t before = start < first_slot ? inputs & ((1U << start) - 1) : inputs;
    const auto test_inputs = [&](std::uint32_t bits) {
        for (; bits && traversal_.free(); bits &= bits - 1) test_at(std::size_t(__builtin_ctz(bits)), now);
    };
    const auto test_slots = [&](std::size_t from, std::size_t to) {
        for (; from < to && traversal_.free(); ++from) test_at(from, now);
    };
    test_inputs(inputs & ~before);
    test_slots(std::max(start, first_slot), first_slot + slots);
    test_inputs(before);
    test_slots(first_slot, std::min(start, first_slot + slots));
}

/// Tests the ray at a place, if there is one that is not tested yet. A unit must be free.
void Cell::test_at(std::size_t place, Cycle now) {
    RayPacket* packet = packet_at(place);
    if (!packet || packet->stage != RayPacket::Stage::untested) return;
    settle(wait_of(*packet, place), packet->ray.id, now);
    packet->wait.cause = Stall::none;
    const std::uint32_t cycles = unit_cycles(
        TraversalUnits::test(*packet, {store_, index_, env_.context, env_.classes, x_, y_}, env_.costs()));
    meter_.tested(env_.meters.counters, packet->visit, cycles);
    traversal_.start(*packet, std::uint32_t(place), now + cycles);
    record(now, CellEvent::test, std::uint32_t(packet->ray.id), packet->ray.id,
           std::uint32_t(packet->visit.event));
    want(now + cycles);
}

// ---- routing
// -------------------------------------------------------------------------------------------------

bool Cell::send_answer(const Answer& answer, Cycle now) {
    if (is_home(answer)) {
        if (store_port_ == now) {
            want(now + 1);
            cause_ = Stall::store_port;
            return false;
        }
        ++env_.meters.counters.answers_sent;
        tell(now, CellEvent::answer, answer.id, std::uint32_t(answer.kind));
        deliver(answer, now);
        return true;
    }
    const Side way = route(answer);
    const Link::Room room = router_.ask(way, env_.classes.answer, 0, wakeup_);
    if (room != Link::Room::free) {
        cause_ = room == Link::Room::full ? Stall::answer_full : Stall::answer_busy;
        return false;
    }
    ++env_.meters.counters.answers_sent;
    tell(now, CellEvent::answer, answer.id, std::uint32_t(answer.kind));
    Answer* copy = env_.pools.answers.take();
    *copy = answer;
    raycell::send_answer(copy, *router_.link(way), env_, meter_);
    record_send(now, way, env_.classes.answer, answer.id);
    return true;
}

void Cell::move_answers(Cycle now) {
    std::array<int, side_count> order;  // sides with an answer, oldest first
    int count = 0;
    for (std::uint32_t sides = answers_to_move() & ~std::uint32_t(answers_moved_); sides;
         sides &= sides - 1) {
        const int side = __builtin_ctz(sides);
        if (!inputs_.answer(std::size_t(side), now)) continue;
        const Cycle arrival = inputs_.answer_arrival(std::size_t(side));
        int place = count++;
        for (; place > 0; --place) {
            const auto before = std::size_t(order[std::size_t(place - 1)]);
            if (inputs_.answer_arrival(before) <= arrival) break;
            order[std::size_t(place)] = int(before);
        }
        order[std::size_t(place)] = side;
    }
    for (int i = 0; i < count; ++i) {
        const auto side = std::size_t(order[std::size_t(i)]);
        move_answer(side, now);
    }
}

void Cell::move_answer(std::size_t from, Cycle now) {
    Wait& wait = inputs_.answer_wait(from);
    const int index = env_.classes.answer;
    const Cycle ready = inputs_.answer_arrival(from) + env_.costs().route_return;
    if (now < ready) {
        want(ready);
        return;
    }
    Answer* answer = inputs_.answer(from, now);
    const std::uint64_t id = answer->id;
    if (is_home(*answer)) {
        if (store_port_ == now) {
            want(now + 1);
            stall(wait, Stall::store_port, id, now);
            return;
        }
        deliver(*answer, now);
        env_.pools.answers.give_back(answer);
    } else {
        const Side way = route(*answer);
        const Link::Room room = router_.ask(way, index, InputPorts::answer_bit(from), wakeup_);
        if (room != Link::Room::free) {
            blocked_ = true;
            stall(wait, room == Link::Room::full ? Stall::answer_full : Stall::answer_busy, id, now);
            return;
        }
        raycell::send_answer(answer, *router_.link(way), env_, meter_);
        record_send(now, way, index, id);
    }
    answer_moved_ = true;
    settle(wait, id, now);
    wait.cause = Stall::none;
    bool more = false;
    pending_ &= ~inputs_.pop_answer(from, now, more);
    if (!more) return;
    want(now + 1);
    aging_.new_answer();
}

void Cell::move_rays(Cycle now) {
    // Oldest first. With a round robin over places, or one per output, a ray can wait for ever for an output
    // that others keep using (seen as a livelock in spite of reserved slots).
    std::vector<WaitingRay>& waiting = env_.waiting;  // the second and later rays: mostly there is only one
    waiting.clear();
    WaitingRay first{0, 0, nullptr};
    const auto look = [&](std::size_t place) {
        RayPacket* packet = packet_at(place);
        if (!packet || packet->stage != RayPacket::Stage::decided) return;
        if (first.packet) {
            waiting.push_back({packet->decided, place, packet});
        } else {
            first = {packet->decided, place, packet};
        }
    };
    for (std::uint32_t inputs = decided_ & ~router_.parked(); inputs; inputs &= inputs - 1) {
        look(std::size_t(__builtin_ctz(inputs)));
    }
    const std::size_t slots = slot_places();
    for (std::size_t slot = 0; slot < slots; ++slot) look(first_slot_place() + slot);
    if (!first.packet) return;
    if (waiting.empty()) {
        try_ray(*first.packet, first.place, now);
        return;
    }
    waiting.push_back(first);
    std::sort(waiting.begin(), waiting.end(), [](const WaitingRay& a, const WaitingRay& b) {
        return a.since != b.since ? a.since < b.since : a.place < b.place;
    });
    for (const WaitingRay& ray : waiting) try_ray(*ray.packet, ray.place, now);
}

/// Moves a ray if it can, and counts its wait by cause.
void Cell::try_ray(RayPacket& packet, std::size_t place, Cycle now) {
    const std::uint64_t id = packet.ray.id;
    Wait wait = packet.wait;
    packet.wait.cause = Stall::none;  // set before the move: a ray that has moved belongs to others
    if (move_ray(packet, place, now)) {
        settle(wait, id, now);
    } else {
        blocked_ = true;
        stall(wait, cause_, id, now);
        packet.wait = wait;
    }
}

bool Cell::move_ray(RayPacket& packet, std::size_t place, Cycle now) {
    switch (packet.need.kind) {
        case Need::Kind::output:
            return forward(packet, place, now);
        case Need::Kind::response:
            return respond(packet, place, now);
        case Need::Kind::nothing:
            end_silently(packet, place, now);
            return true;
        case Need::Kind::slot:
            return accept_hit(packet, place, now);
        case Need::Kind::shading_unit:
            return accept_direct(packet, place, now);
        case Need::Kind::border_walk:
            start_outside(packet.ray, packet.visit.hit.t, env_.context.arithmetic);
            packet.stage = RayPacket::Stage::untested;
            packet.wait = {now, Stall::traversal};
            decided_ &= ~bit_of(place);
            return true;
    }
    return true;
}

bool Cell::forward(RayPacket& packet, std::size_t place, Cycle now) {
    const std::uint64_t id = packet.ray.id;
    const Need need = packet.need;
    const Link::Room room = router_.ask(need.side, need.index, bit_of(place), wakeup_);
    if (room != Link::Room::free) {
        cause_ = room == Link::Room::full ? Stall::output_full : Stall::output_busy;
        return false;
    }
    remove_from(place);
    send_ray(packet, *router_.link(need.side), env_, meter_);
    record_send(now, need.side, need.index, id);
    return true;
}

/// The ray ends in an answer; false if the answer can't leave yet.
bool Cell::respond(RayPacket& packet, std::size_t place, Cycle now) {
    if (!send_answer(response_of(packet, env_.context), now)) return false;
    remove_from(place);
    end_ray(packet, env_, meter_);
    return true;
}

/// A ray that finds no slot is destroyed; its home will send it again (paper, section 4.2).
bool Cell::postpone(RayPacket& packet, std::size_t place, Cycle now) {
    if (!send_answer(answer_to(packet.ray, Answer::Kind::postponed), now)) return false;
    meter_.postponed(env_.meters.counters);
    env_.meters.ledger.add(packet, x_, y_, now);
    if (env_.phase == Phase::trace) ++env_.picture.pixels[pixel_of(packet.ray.id)].postponed;
    record(now, CellEvent::postpone, std::uint32_t(packet.ray.id), packet.ray.id, 0);
    remove_from(place);
    env_.pools.rays.give_back(&packet);
    return true;
}

void Cell::end_silently(RayPacket& packet, std::size_t place, Cycle now) {
    tell(now, CellEvent::silent, packet.ray.id, 0);
    remove_from(place);
    end_ray(packet, env_, meter_);
}

bool Cell::busy() const {
    return !traversal_.idle() || !shading_.idle() || ray_store_.used() > 0 || injector_.unfinished();
}

}  // namespace raycell
