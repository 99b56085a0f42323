#include "cells/probes/cell_view.hpp"

namespace raycell {

Stall CellView::stall_of_answer(const Answer& answer) const {
    if (cell_.is_home(answer)) return cell_.port_used(now_) ? Stall::store_port : Stall::none;
    switch (cell_.output(cell_.route(answer))->room(env_.classes.answer)) {
        case Link::Room::full:
            return Stall::answer_full;
        case Link::Room::wires_busy:
            return Stall::answer_busy;
        case Link::Room::free:
            break;
    }
    return Stall::none;
}

namespace {

Stall stall_of_output(Link::Room room) {
    return room == Link::Room::full         ? Stall::output_full
           : room == Link::Room::wires_busy ? Stall::output_busy
                                            : Stall::none;
}

}  // namespace

Stall CellView::stall_of(const RayPacket& packet) const {
    if (packet.stage == RayPacket::Stage::in_test) return Stall::none;
    if (packet.stage == RayPacket::Stage::untested) return Stall::traversal;
    // Only the answer's way matters here, not its kind.
    const auto answer = [&] { return stall_of_answer(answer_to(packet.ray, Answer::Kind::intensity)); };
    switch (packet.need.kind) {
        case Need::Kind::output:
            return stall_of_output(cell_.output(packet.need.side)->room(packet.need.index));
        case Need::Kind::response:
            return answer();
        case Need::Kind::shading_unit:
            return !cell_.shading().idle() || cell_.slot_complete() ? Stall::shading : Stall::none;
        case Need::Kind::slot:
            // Slots are taken only through the port: if there is a slot, a waiting ray waits for the port.
            if (!cell_.ray_store().has_room(packet.ray.generation))
                return env_.machine.recovery == Recovery::none ? Stall::no_slot : answer();
            return cell_.port_used(now_) ? Stall::store_port : Stall::none;
        case Need::Kind::nothing:
        case Need::Kind::border_walk:
            break;
    }
    return Stall::none;
}

Stall CellView::stall_of(const Link& in, int index) const {
    const Message head = in.front(index);
    switch (head.kind) {
        case Message::Kind::ray:
            return stall_of(*head.ray);
        case Message::Kind::answer:
            if (now_ < in.arrival(index) + env_.costs().route_return) return Stall::none;  // being routed
            return stall_of_answer(*head.answer);
        case Message::Kind::load:
            if (loading_unit().state != UnitView::State::blocked) return Stall::none;
            return stall_of_output(cell_.output(Side::east)->room(0));
        case Message::Kind::none:
            break;
    }
    return Stall::none;
}

Stall CellView::stall_of(const Slot& slot) const {
    if (slot.child) return stall_of(*slot.child);
    if (slot.state != Slot::State::to_answer) return Stall::none;
    return stall_of_answer(answer_to(slot.packet->ray, Answer::Kind::intensity));
}

UnitView CellView::traversal_unit(std::size_t unit) const {
    const RayPacket* packet = cell_.traversal().packet(unit);
    if (!packet) return {};
    const bool compares = !packet->ray.outside && packet->visit.comparisons.runs > 0;
    return {UnitView::State::busy, compares ? UnitView::Operation::compare : UnitView::Operation::walk,
            packet->ray.id};
}

UnitView CellView::shading_unit() const {
    using Operation = UnitView::Operation;
    using Job = ShadingUnit::Job;
    const Job job = cell_.shading().job();
    switch (job) {
        case Job::idle:
            break;
        case Job::set_up:
        case Job::shade:
            return {UnitView::State::busy, job == Job::shade ? Operation::shade : Operation::set_up,
                    cell_.ray_store()[cell_.shading().slot()].packet->ray.id};
        case Job::direct:
            return {UnitView::State::busy, Operation::direct, cell_.shading().direct_ray()->ray.id};
        case Job::direct_answer:
            return {UnitView::State::blocked, Operation::direct, cell_.shading().direct_ray()->ray.id};
    }
    return {};
}

UnitView CellView::loading_unit() const {
    using Operation = UnitView::Operation;
    const LoadingUnits& unit = cell_.loading_unit();
    if (now_ < unit.made()) return {UnitView::State::busy, Operation::make_voxel, UnitView::no_ray};
    if (!unit.item()) return {};
    return {now_ < unit.done() ? UnitView::State::busy : UnitView::State::blocked, Operation::pass_on,
            UnitView::no_ray};
}

}  // namespace raycell
