// What a cell's buffers, slots and units wait for: the cell's part of the wait-for graph. The conditions are
// those of cell.cpp and cell_shade.cpp; whoever changes when something moves there changes it here.
#include <algorithm>

#include "cells/cell.hpp"
#include "cells/deadlock/wait_map.hpp"

namespace raycell {
namespace {

using Kind = WaitGraph::Kind;

Cycle later(Cycle a, Cycle b) { return b == never ? a : std::max(a, b); }

}  // namespace

std::string Cell::buffer_name(Side from, int index) const {
    return std::string("input ") + name_of(from) + " " + class_name(env_.machine.networks, index);
}

void Cell::add_places(WaitMap& map) const {
    if (env_.phase == Phase::load) {
        // Into a row's first cell leads the distributor's link.
        if (!load_in_ || x_ == 0) return;
        WaitGraph::Node node;
        node.x = x_;
        node.y = y_;
        node.side = int(Side::west);
        node.what = "input west";
        add_buffer(map, *load_in_, 0, std::move(node));
        return;
    }
    const auto node = [this](Kind kind, std::string what, std::string holds, Cycle since) {
        WaitGraph::Node n;
        n.kind = kind;
        n.x = x_;
        n.y = y_;
        n.what = std::move(what);
        n.holds = std::move(holds);
        n.since = since;
        return n;
    };
    for (int side = 0; side < side_count; ++side) {
        if (const Link* in = in_[std::size_t(side)]) {
            for (int index = 0; index < env_.classes.count; ++index) {
                WaitGraph::Node buffer = node(Kind::buffer, buffer_name(Side(side), index), "", 0);
                buffer.side = side;
                add_buffer(map, *in, index, std::move(buffer));
            }
        }
    }
    if (injector_.ray())
        map.place(injector_.ray()->ray, map.add(this, 0,
                                                node(Kind::own, "own ray", describe(injector_.ray()->ray),
                                                     injector_.ray()->decided)));
    if (shading_.job() == ShadingUnit::Job::direct || shading_.job() == ShadingUnit::Job::direct_answer) {
        map.place(shading_.direct_ray()->ray,
                  map.add(this, 0,
                          node(Kind::shading, "shading unit", describe(shading_.direct_ray()->ray),
                               shading_.done())));
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        const Slot& slot = ray_store_[i];
        if (slot.state == Slot::State::empty) continue;
        const std::string name = "slot " + std::to_string(i);
        map.place(slot.packet->ray,
                  map.add(this, i, node(Kind::slot, name, describe(slot.packet->ray), slot.changed)));
        if (!slot.child) continue;
        map.place(slot.child->ray, map.add(this, i,
                                           node(Kind::child, "child of " + name, describe(slot.child->ray),
                                                slot.child->decided)));
    }
}

void add_buffer(WaitMap& map, const Link& link, int index, WaitGraph::Node node) {
    const int count = link.occupancy(index);
    if (count == 0) return;
    // The last message to move into its place, or to become the first.
    node.since = later(0, link.last_pop(index));
    for (int place = 0; place < count; ++place) {
        const Link::Held held = link.held(index, place);
        node.since = std::max(node.since, held.visible);
        if (place > 0) continue;
        if (held.message.kind == Message::Kind::ray) {
            node.since = std::max(node.since, held.message.ray->decided);
            node.holds = describe(held.message.ray->ray);
        } else if (held.message.kind == Message::Kind::answer) {
            node.holds = describe(*held.message.answer);
        } else if (held.message.kind == Message::Kind::load) {
            node.holds = describe(*held.message.load);
        }
    }
    if (count > 1) node.holds += ", " + std::to_string(count - 1) + " behind it";
    const WaitGraph::Index added = map.add(&link, std::uint32_t(index), std::move(node));
    for (int place = 0; place < count; ++place) {
        const Message message = link.held(index, place).message;
        if (message.kind == Message::Kind::ray) map.place(message.ray->ray, added);
        if (message.kind == Message::Kind::answer) map.place(*message.answer, added);
    }
}

Wants wants_buffer(const WaitMap& map, const Link& out, int index, const std::string& name) {
    if (!out.full(index)) return Wants::nothing(name + ", which has room");
    const auto buffer = map.find(&out, Kind::buffer, std::uint32_t(index));
    if (!buffer) return Wants::nothing(name);
    return {false, false, {*buffer}, name};
}

Wants Cell::wants_output(const WaitMap& map, Side side, int index) const {
    return wants_buffer(
        map, *out_[std::size_t(side)], index,
        std::string("output ") + name_of(side) + " " + class_name(env_.machine.networks, index));
}

Wants Cell::wants_answer_way(const WaitMap& map, const Answer& answer) const {
    if (local(answer)) return Wants::nothing("its way home, in this cell");
    return wants_output(map, route(answer), env_.classes.answer);
}

Wants Cell::wants_slot(const WaitMap& map, const Ray& ray) const {
    if (ray_store_.has_room(ray.generation)) return Wants::nothing("a slot, and there is one");
    Wants wants{false, false, {}, "a slot"};
    if (env_.machine.recovery == Recovery::postpone) {
        wants = wants_answer_way(map, answer_to(ray, Answer::Kind::postponed));
        wants.text = "a slot, or a way for its postponed notice: " + wants.text;
        if (wants.moves) return wants;
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        const Slot& slot = ray_store_[i];
        if (slot.state == Slot::State::empty) continue;
        if (!ray_store_.would_help(slot.packet->ray.generation, ray.generation)) continue;
        if (const auto node = map.find(this, Kind::slot, i)) wants.on.push_back(*node);
    }
    return wants;
}

Wants Cell::wants_shading(const WaitMap& map) const {
    if (shading_.job() != ShadingUnit::Job::direct_answer) return Wants::nothing("the shading unit");
    const auto unit = map.find(this, Kind::shading, 0);
    return unit ? Wants{false, false, {*unit}, "the shading unit"} : Wants::nothing("the shading unit");
}

Wants Cell::wants_ray(const WaitMap& map, const RayPacket& packet) const {
    if (packet.stage != RayPacket::Stage::decided) return Wants::nothing("the traversal unit");
    switch (packet.need.kind) {
        case Need::Kind::output:
            return wants_output(map, packet.need.side, packet.need.index);
        case Need::Kind::response:
            return wants_answer_way(map, answer_to(packet.ray, packet.need.answer));
        case Need::Kind::slot:
            return wants_slot(map, packet.ray);
        case Need::Kind::shading_unit:
            return wants_shading(map);
        case Need::Kind::border_walk:
            return Wants::nothing("its way to the border");
        case Need::Kind::nothing:
            break;
    }
    return Wants::nothing("nothing: it ends");
}

/// All that a waiting slot still lacks; what is between places (a back-off) comes by itself.
Wants Cell::wants_children(const WaitMap& map, std::uint32_t index) const {
    const Slot& slot = ray_store_[index];
    Wants wants{false, true, {}, ""};
    const auto await = [&](std::optional<WaitGraph::Index> node, const std::string& what) {
        if (node && std::find(wants.on.begin(), wants.on.end(), *node) != wants.on.end()) return;
        wants.text += (wants.text.empty() ? "" : ", ") + what;
        if (node) wants.on.push_back(*node);
    };
    if (slot.child) await(map.find(this, Kind::child, index), "its child to leave");
    for (unsigned child = 0; child < 2; ++child) {
        if (!slot.await_child[child] || slot.send_child[child]) continue;
        const RayKind kind = child == 0 ? RayKind::reflected : RayKind::refracted;
        await(map.where(x_, y_, kind, index, child), child == 0 ? "its reflected ray" : "its refracted ray");
    }
    const bool memo = env_.context.settings.shadows == Shadows::memo;
    const std::uint32_t voxel = slot.packet->visit.hit.voxel;
    const std::uint64_t verdicts =
        memo ? slot.setup.facing & ~store_.known[voxel] : slot.awaited & ~slot.to_ask;
    for (unsigned source = 0; source < 64; ++source) {
        if (!(verdicts >> source & 1)) continue;
        await(memo ? map.where(x_, y_, RayKind::memo, voxel, source)
                   : map.where(x_, y_, RayKind::shadow, index, source),
              "its verdict of source " + std::to_string(source));
    }
    wants.moves = wants.on.empty();
    return wants;
}

Wants Cell::wants_of_slot(const WaitMap& map, std::uint32_t index) const {
    const Slot& slot = ray_store_[index];
    switch (slot.state) {
        case Slot::State::to_set_up:
            return wants_shading(map);
        case Slot::State::waiting:
            return complete(slot) ? wants_shading(map) : wants_children(map, index);
        case Slot::State::to_answer:
            return wants_answer_way(map, answer_to(slot.packet->ray, Answer::Kind::intensity));
        case Slot::State::empty:
        case Slot::State::in_setup:
        case Slot::State::in_shading:
            break;
    }
    return Wants::nothing("the end of its shading");
}

/// A load message: the cases of step_load().
Wants Cell::wants_load(const WaitMap& map) const {
    const Message head = load_in_->front(0);
    if (head.kind != Message::Kind::load) return Wants::nothing("its arrival");
    if (loading_.item() != head.load || env_.scheduler.now() < loading_.done())
        return Wants::nothing("the end of the cell's work");
    if (LoadingUnit::ends_at(*head.load, x_, env_.width())) return Wants::nothing("nothing: it ends here");
    return wants_buffer(map, *out_[std::size_t(Side::east)], 0, "output east");
}

void Cell::add_waits(WaitMap& map) const {
    if (env_.phase == Phase::load) {
        if (!load_in_) return;
        if (const auto node = map.find(load_in_, Kind::buffer, 0)) map.set(*node, wants_load(map));
        return;
    }
    for (int side = 0; side < side_count; ++side) {
        const Link* in = in_[std::size_t(side)];
        if (!in) continue;
        for (int index = 0; index < env_.classes.count; ++index) {
            const auto node = map.find(in, Kind::buffer, std::uint32_t(index));
            if (!node) continue;
            const Message head = in->front(index);
            map.set(*node, head.kind == Message::Kind::ray      ? wants_ray(map, *head.ray)
                           : head.kind == Message::Kind::answer ? wants_answer_way(map, *head.answer)
                                                                : Wants::nothing("its arrival"));
        }
    }
    if (const auto node = map.find(this, Kind::own, 0)) map.set(*node, wants_ray(map, *injector_.ray()));
    if (const auto node = map.find(this, Kind::shading, 0)) {
        map.set(*node,
                shading_.job() == ShadingUnit::Job::direct_answer
                    ? wants_answer_way(map, answer_to(shading_.direct_ray()->ray, Answer::Kind::intensity))
                    : Wants::nothing("the end of its shading"));
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        if (const auto node = map.find(this, Kind::slot, i)) map.set(*node, wants_of_slot(map, i));
        if (const auto node = map.find(this, Kind::child, i))
            map.set(*node, wants_ray(map, *ray_store_[i].child));
    }
}

}  // namespace raycell
