// Rays and answers of an RTL cell.
#include <stdexcept>

#include "testbench/rtl/array/books.hpp"

namespace raycell {

RayPacket& RtlBooks::packet_at(const rtl::CellPlace& place) const {
    if (place.side == rtl::own_register) {
        if (RayPacket* packet = cell_.injector().ray()) return *packet;
        fail("its own ray acts, and there is none");
    }
    if (place.side == rtl::slot_register) {
        if (RayPacket* packet = slot_at(place.index).child) return *packet;
        fail("a child of slot " + std::to_string(place.index) + " acts, and there is none");
    }
    const Message front = input(place.side)->front(place.index);
    if (front.kind != Message::Kind::ray)
        fail(std::string("input ") + name_of(Side(place.side)) + " class " + std::to_string(place.index) +
             ": a ray acts, and none is there");
    return *front.ray;
}

void RtlBooks::remove_from(const rtl::CellPlace& place) {
    if (place.side == rtl::own_register)
        cell_.injector().left();
    else if (place.side == rtl::slot_register) {
        Slot& slot = slot_at(place.index);
        slot.child = nullptr;
        slot.wait = {now(), Stall::shading};
    } else
        input(place.side)->pop(place.index);
}

void RtlBooks::launch() {
    if (cell_.injector().ray()) fail("it sends its own ray while one is in the register");
    const Ray ray = begin_primary(0, cell_.injector(), env_, cell_.x(), cell_.y());
    cell_.injector().load(*raycell::launch(ray, env_));
    if (env_.meters.observer) env_.meters.observer->launched(cell_, now(), ray, nullptr);
    tell(CellEvent::launch, ray.id, std::uint32_t(ray.kind));
}

/// The model's test of the ray says what it costs and what is to come of it.
void RtlBooks::test(const rtl::CellPlace& place) {
    RayPacket& packet = packet_at(place);
    const std::uint64_t id = packet.ray.id;
    Wait waited = packet.wait;
    if (packet.stage == RayPacket::Stage::decided) {
        if (packet.need.kind != Need::Kind::border_walk)
            disagree("ray " + ray_name(id) + " is tested once more; expected one test");
        else
            start_outside(packet.ray, packet.visit.hit.t, env_.context.arithmetic);
        waited = {packet.decided, Stall::traversal};
    } else if (place.side < rtl::load_side) {
        const Link& link = *input(place.side);
        waited = {link.head_since_at(link.place(place.index)), Stall::traversal};
    }
    settle(waited, id);
    const CellStore& store = cell_.store();
    const IndexTable index{store.index.data(), std::uint32_t(store.index.size())};
    const std::uint32_t cycles = TraversalUnits::test(
        packet, {store, index, env_.context, env_.classes, cell_.x(), cell_.y()}, env_.costs());
    cell_.meter().tested(env_.meters.counters, packet.visit, cycles);
    packet.stage = RayPacket::Stage::decided;
    packet.decided = now() + cycles;
    packet.wait = {};
    record(CellEvent::test, std::uint32_t(id), id, std::uint32_t(packet.visit.event));
}

void RtlBooks::move_ray(const rtl::CellAct& act) {
    RayPacket& packet = packet_at(act.place);
    const std::uint64_t id = packet.ray.id;
    if (act.since != packet.decided) {
        disagree("the test of ray " + ray_name(id) + " ended for cycle " + std::to_string(act.since) +
                 ", expected cycle " + std::to_string(packet.decided));
        packet.decided = act.since;
    }
    const bool output = packet.need.kind == Need::Kind::output;
    const bool hit = packet.need.kind == Need::Kind::slot;
    if (act.waits && hit) return wait_for_slot(packet, act);
    if (act.waits) return wait(packet.wait, id, act, !output);
    settle(packet.wait, id);
    packet.wait = {};
    switch (packet.need.kind) {
        case Need::Kind::output:
            if (act.to >= side_count) break;
            remove_from(act.place);
            return forward(packet, act);
        case Need::Kind::response:
            if (act.to == rtl::to_nobody) break;
            respond(packet, act);
            remove_from(act.place);
            return end_ray(packet, env_, cell_.meter());
        case Need::Kind::nothing:
            if (act.to != rtl::to_nobody) break;
            tell(CellEvent::silent, id, 0);
            remove_from(act.place);
            return end_ray(packet, env_, cell_.meter());
        case Need::Kind::slot:
            if (act.to == rtl::to_nobody) break;
            return act.to == rtl::to_slot ? accept(packet, act) : postpone(packet, act);
        default:
            break;
    }
    fail("ray " + ray_name(id) + " leaves to " + goal_name(act.to) + ", which is not what it needs");
}

/// The ray goes on as the RTL cell's bits say.
void RtlBooks::forward(RayPacket& packet, const rtl::CellAct& act) {
    const Need need = packet.need;
    const std::uint64_t id = packet.ray.id;
    if (act.to != int(need.side))
        disagree("ray " + ray_name(id) + " leaves to the " + goal_name(act.to) + ", expected the " +
                 name_of(need.side));
    const int cycles = is_shadow(packet.ray.kind) ? env_.cycles.shadow_ray : env_.cycles.ray;
    const rtl::CellMessage sent = outgoing(act.to, need.index, cycles);
    if (!need.leaves) cross(packet.ray, packet.visit.crossing, env_.context.arithmetic);
    compare(Message(&packet), sent);
    packet.ray = wire_.unpack_ray(bits_of(sent), env_.phase == Phase::precast);
    packet.ray.id = id_of(sent, id);
    packet.stage = RayPacket::Stage::untested;
    packet.visit = {};
    if (env_.wire) ++env_.meters.counters.packed;
    ++packet.hops;
    cell_.meter().ray_left(env_.meters.counters, need.leaves);
    env_.count_hop(id);
    cell_.output(Side(act.to))->send(sent.index, Message(&packet), sent.cycles);
    const std::uint32_t detail = std::uint32_t(act.to) << 8 | unsigned(sent.index);
    record(CellEvent::send, detail, packet.ray.id, detail);
}

/// The ray ends in an answer, which leaves at once.
void RtlBooks::respond(RayPacket& packet, const rtl::CellAct& act) {
    leave(response_of(packet, env_.context), act.to);
}

// ---- answers

void RtlBooks::move_answer(const rtl::CellAct& act) {
    const auto side = std::size_t(act.place.side);
    Link& from = *input(act.place.side);
    const Message front = from.front(act.place.index);
    if (front.kind != Message::Kind::answer)
        fail(std::string("input ") + name_of(Side(side)) + ": an answer acts, and none is there");
    Answer& answer = *front.answer;
    const std::uint64_t id = answer.id;
    if (act.waits) return wait(answer_waits_[side], id, act, true);
    if (act.to == rtl::to_home) {
        deliver(answer);
        env_.pools.answers.give_back(&answer);
    } else {
        send(answer, act.to);
    }
    settle(answer_waits_[side], id);
    answer_waits_[side] = {};
    from.pop(act.place.index);
}

void RtlBooks::send(Answer& answer, int side) {
    if (cell_.is_home(answer)) fail("answer to ray " + ray_name(answer.id) + " goes on; expected home");
    if (side != int(cell_.route(answer)))
        disagree("answer to ray " + ray_name(answer.id) + " leaves to the " + goal_name(side) +
                 ", expected the " + name_of(cell_.route(answer)));
    const int cycles = answer.kind == Answer::Kind::intensity ? env_.cycles.intensity : env_.cycles.verdict;
    const rtl::CellMessage sent = outgoing(side, env_.classes.answer, cycles);
    compare(Message(&answer), sent);
    const std::uint64_t id = id_of(sent, answer.id);
    answer = wire_.unpack_answer(bits_of(sent), env_.phase == Phase::precast);
    answer.id = id;
    if (env_.wire) ++env_.meters.counters.packed;
    cell_.meter().answer_left(env_.meters.counters);
    env_.count_hop(id);
    cell_.output(Side(side))->send(sent.index, Message(&answer), sent.cycles, env_.answer_routing);
    const std::uint32_t detail = std::uint32_t(side) << 8 | unsigned(sent.index);
    record(CellEvent::send, detail, id, detail);
}

/// An answer is home: the pixel is what the RTL cell says.
void RtlBooks::deliver(const Answer& answer) {
    if (!cell_.is_home(answer)) fail("answer to ray " + ray_name(answer.id) + " is kept; it is not home");
    const bool of_pixel = answer.ray_kind == RayKind::primary;
    if (!of_pixel && !rtl_.makes_voxels())
        fail("answer to ray " + ray_name(answer.id) + " came home, and it is for no pixel");
    port_used_ = now();
    cell_.meter().delivered(env_.meters.counters, answer.kind, now());
    record(CellEvent::deliver, std::uint32_t(answer.id), answer.id, std::uint32_t(answer.kind));
    if (!of_pixel) return deliver_to_slot(answer);
    Answer read = answer;
    if (answer.kind == Answer::Kind::intensity) {
        const Formats& formats = env_.context.arithmetic.formats();
        const std::vector<std::uint64_t> words = rtl_.pixel();
        for (int channel = 0; channel < 3; ++channel) {
            WireBits bits;
            bits.put(words.at(std::size_t(channel)), formats.word_bits);
            read.colour[channel] = get_word(bits, formats.intensity, formats.word_bits);
        }
        if (read.colour != answer.colour)
            disagree("its pixel is not the intensity that came home, ray " + ray_name(answer.id));
    }
    end_primary(read, cell_.injector(), env_, cell_.x(), cell_.y());
}

}  // namespace raycell
