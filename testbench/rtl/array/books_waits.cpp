// What waits in an RTL cell, and for what: counted by cause as the model's cell counts it.
#include "testbench/rtl/array/books.hpp"

namespace raycell {

/// A message that can't go: for which cause, and whether the model would let it go.
void RtlBooks::wait(Wait& wait, std::uint64_t ray, const rtl::CellAct& act, bool answer) {
    const auto idle = [&] {
        disagree("ray " + ray_name(ray) + " waits, though its way to " + goal_name(act.to) + " is free");
    };
    if (act.to == rtl::to_home) {
        if (port_used_ != now()) return idle();
        return stall(wait, Stall::store_port, ray);
    }
    if (act.to == rtl::to_nobody) return idle();
    const int index = answer ? env_.classes.answer : packet_at(act.place).need.index;
    const Link::Room room = cell_.output(Side(act.to))->room(index);
    if (room == Link::Room::free) return idle();
    if (act.full && room != Link::Room::full)
        disagree("it takes the buffer behind its output " + goal_name(act.to) + " class " +
                 std::to_string(index) + " for full; there is room");
    if (room == Link::Room::full) {
        stall(wait, answer ? Stall::answer_full : Stall::output_full, ray);
    } else {
        stall(wait, answer ? Stall::answer_busy : Stall::output_busy, ray);
    }
}

/// A hit waits for the store's port, or its notice for a way out.
void RtlBooks::wait_for_slot(RayPacket& packet, const rtl::CellAct& act) {
    const std::uint64_t id = packet.ray.id;
    if (port_used_ == now()) return stall(packet.wait, Stall::store_port, id);
    if (cell_.ray_store().has_room(packet.ray.generation) || act.to == rtl::to_home)
        return disagree("ray " + ray_name(id) + " waits, though the store's port is free");
    wait(packet.wait, id, act, true);
}

void RtlBooks::ask_for_room(const rtl::CellAct& act, Wakeup& wakeup) {
    if (!act.waits || act.to >= side_count) return;
    const bool ray =
        act.what == rtl::CellAct::What::ray && packet_at(act.place).need.kind == Need::Kind::output;
    const int index = ray ? packet_at(act.place).need.index : env_.classes.answer;
    if (cell_.output(Side(act.to))->can_send(index, wakeup.next)) wakeup.at(now() + 1);
}

/// An answer that is home and waits for the port counts as neither.
void RtlBooks::end_cycle(const std::vector<rtl::CellAct>& acts) {
    using What = rtl::CellAct::What;
    bool moved = false;
    bool held_up = false;
    for (const rtl::CellAct& act : acts) {
        const bool moves = act.what == What::answer || act.what == What::ray || act.what == What::reply;
        moved |= (moves && !act.waits) || act.what == What::shaded;
        held_up |= act.waits && !(act.what == What::answer && act.to == rtl::to_home);
    }
    cell_.time_out().step(moved, held_up, now(), env_.wait_counts);
}

void RtlBooks::stall(Wait& wait, Stall cause, std::uint64_t ray) {
    if (wait.cause == cause) return;
    settle(wait, ray);
    wait = {now(), cause};
}

void RtlBooks::settle(const Wait& wait, std::uint64_t ray) {
    if (wait.cause == Stall::none || now() <= wait.since) return;
    cell_.meter().stalled(wait.cause, now() - wait.since);
    if (env_.meters.observer)
        env_.meters.observer->stalled(cell_, now(), ray, wait.cause, now() - wait.since);
}

}  // namespace raycell
