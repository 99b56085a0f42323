// What a cell tells to those who watch. Causes are what the cell itself came upon when it last looked: the
// order of the checks is that of move_ray(), accept_hit() and send_answer().
#include "cells/cell_view.hpp"

#include <algorithm>

#include "cells/cell.hpp"

namespace raycell {

HeadStall Cell::stall_of_answer(const Answer& answer, Cycle now) const {
    if (local(answer)) return store_port_ == now ? HeadStall::store_port : HeadStall::none;
    switch (out_[std::size_t(route(answer))]->room(env_.classes.answer)) {
        case Link::Room::full:
            return HeadStall::answer_full;
        case Link::Room::wires_busy:
            return HeadStall::answer_wires;
        case Link::Room::free:
            break;
    }
    return HeadStall::none;
}

namespace {

HeadStall stall_of_output(Link::Room room) {
    return room == Link::Room::full         ? HeadStall::output_full
           : room == Link::Room::wires_busy ? HeadStall::wires_busy
                                            : HeadStall::none;
}

}  // namespace

HeadStall Cell::stall_of(const RayPacket& packet, Cycle now) const {
    if (packet.stage == RayPacket::Stage::in_test) return HeadStall::none;
    if (packet.stage == RayPacket::Stage::untested) return HeadStall::traversal_unit;
    // Only where the answer goes matters here.
    const auto answer = [&] { return stall_of_answer(answer_to(packet.ray, Answer::Kind::intensity), now); };
    switch (packet.need.kind) {
        case Need::Kind::output:
            return stall_of_output(out_[std::size_t(packet.need.side)]->room(packet.need.index));
        case Need::Kind::response:
            return answer();
        case Need::Kind::shading_unit:
            return !shading_.idle() || slot_complete() ? HeadStall::shading_unit : HeadStall::none;
        case Need::Kind::slot:
            // Slots are only taken through the port: a ray that the port held back had one, if there is one.
            if (!ray_store_.has_room(packet.ray.generation))
                return env_.machine.recovery == Recovery::none ? HeadStall::no_slot : answer();
            return store_port_ == now ? HeadStall::store_port : HeadStall::none;
        case Need::Kind::nothing:
        case Need::Kind::border_walk:
            break;
    }
    return HeadStall::none;
}

HeadStall Cell::stall_of(const Link& in, int index, Cycle now) const {
    const Message head = in.front(index);
    switch (head.kind) {
        case Message::Kind::ray:
            return stall_of(*head.ray, now);
        case Message::Kind::answer:
            if (now < in.arrival(index) + env_.costs().route_return) return HeadStall::none;  // being routed
            return stall_of_answer(*head.answer, now);
        case Message::Kind::load:
            if (loading_unit(now).state != UnitView::State::blocked) return HeadStall::none;
            return stall_of_output(out_[std::size_t(Side::east)]->room(0));
        case Message::Kind::none:
            break;
    }
    return HeadStall::none;
}

HeadStall Cell::stall_of(const Slot& slot, Cycle now) const {
    if (slot.child) return stall_of(*slot.child, now);
    if (slot.state != Slot::State::to_answer) return HeadStall::none;
    return stall_of_answer(answer_to(slot.packet->ray, Answer::Kind::intensity), now);
}

UnitView Cell::traversal_unit() const {
    const RayPacket* packet = traversal_.packet();
    if (!packet) return {};
    const bool compares = !packet->ray.outside && packet->visit.comparisons.runs > 0;
    return {UnitView::State::busy, compares ? UnitView::Operation::compare : UnitView::Operation::walk,
            packet->ray.id};
}

UnitView Cell::shading_unit() const {
    using Operation = UnitView::Operation;
    using Job = ShadingUnit::Job;
    const Job job = shading_.job();
    switch (job) {
        case Job::idle:
            break;
        case Job::set_up:
        case Job::shade:
            return {UnitView::State::busy, job == Job::shade ? Operation::shade : Operation::set_up,
                    ray_store_[shading_.slot()].packet->ray.id};
        case Job::direct:
            return {UnitView::State::busy, Operation::direct, shading_.direct_ray()->ray.id};
        case Job::direct_answer:
            return {UnitView::State::blocked, Operation::direct, shading_.direct_ray()->ray.id};
    }
    return {};
}

UnitView Cell::loading_unit(Cycle now) const {
    const LoadItem* item = loading_.item();
    if (!item) return {};
    return {
        now < loading_.done() ? UnitView::State::busy : UnitView::State::blocked,
        LoadingUnit::makes_voxel(*item, x_) ? UnitView::Operation::make_voxel : UnitView::Operation::pass_on,
        UnitView::no_ray};
}

Cycle Cell::oldest_arrival() const {
    Cycle oldest = never;
    for (const Link* in : in_) {
        for (int index = 0; in && index < env_.classes.count; ++index) {
            if (in->front(index).kind != Message::Kind::none) oldest = std::min(oldest, in->arrival(index));
        }
    }
    return oldest;
}

}  // namespace raycell
