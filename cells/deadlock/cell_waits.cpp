#include "cells/deadlock/cell_waits.hpp"

#include <algorithm>

namespace raycell {
namespace {

using Kind = WaitGraph::Kind;

Wants with_text(const std::string& before, Wants wants) {
    wants.text = before + wants.text;
    return wants;
}

Cycle later(Cycle a, Cycle b) { return b == never ? a : std::max(a, b); }

/// Builds one cell's part of the wait-for graph in the machine's `map`.
class CellWaits {
  public:
    CellWaits(const Cell& cell, WaitMap& map) : cell_(cell), env_(cell.environment()), map_(map) {}
    void add_places();
    void add_waits();

  private:
    std::string buffer_name(Side from, int index) const;
    Wants wants_output(Side side, int index) const;
    Wants wants_answer_way(const Answer& answer) const;
    Wants wants_slot(const Ray& ray) const;
    Wants wants_shading() const;
    Wants wants_ray(const RayPacket& packet) const;
    Wants wants_children(std::uint32_t index) const;
    Wants wants_of_slot(std::uint32_t index) const;
    Wants wants_load() const;

    const Cell& cell_;
    const Environment& env_;
    WaitMap& map_;
};

std::string CellWaits::buffer_name(Side from, int index) const {
    return std::string("input ") + name_of(from) + " " + class_name(env_.machine.networks, index);
}

void CellWaits::add_places() {
    if (env_.phase == Phase::load) {
        // The link into a row's first cell is the distributor's.
        if (!cell_.load_input() || cell_.x() == 0) return;
        WaitGraph::Node node;
        node.x = cell_.x();
        node.y = cell_.y();
        node.side = int(Side::west);
        node.what = "input west";
        add_buffer(map_, *cell_.load_input(), 0, std::move(node));
        return;
    }
    const auto node = [this](Kind kind, std::string what, std::string holds, Cycle since) {
        WaitGraph::Node n;
        n.kind = kind;
        n.x = cell_.x();
        n.y = cell_.y();
        n.what = std::move(what);
        n.holds = std::move(holds);
        n.since = since;
        return n;
    };
    for (int side = 0; side < side_count; ++side) {
        if (const Link* in = cell_.input(Side(side))) {
            for (int index = 0; index < env_.classes.count; ++index) {
                WaitGraph::Node buffer = node(Kind::buffer, buffer_name(Side(side), index), "", 0);
                buffer.side = side;
                add_buffer(map_, *in, index, std::move(buffer));
            }
        }
    }
    if (cell_.injector().ray())
        map_.place(cell_.injector().ray()->ray,
                   map_.add(&cell_, 0,
                            node(Kind::own, "own ray", describe(cell_.injector().ray()->ray),
                                 cell_.injector().ray()->decided)));
    if (cell_.shading().job() == ShadingUnit::Job::direct ||
        cell_.shading().job() == ShadingUnit::Job::direct_answer) {
        map_.place(cell_.shading().direct_ray()->ray,
                   map_.add(&cell_, 0,
                            node(Kind::shading, "shading unit", describe(cell_.shading().direct_ray()->ray),
                                 cell_.shading().done())));
    }
    for (std::uint32_t i = 0; i < cell_.ray_store().touched(); ++i) {
        const Slot& slot = cell_.ray_store()[i];
        if (slot.state == Slot::State::empty) continue;
        const std::string name = "slot " + std::to_string(i);
        map_.place(slot.packet->ray,
                   map_.add(&cell_, i, node(Kind::slot, name, describe(slot.packet->ray), slot.changed)));
        if (!slot.child) continue;
        map_.place(slot.child->ray, map_.add(&cell_, i,
                                             node(Kind::child, "child of " + name, describe(slot.child->ray),
                                                  slot.child->decided)));
    }
}

Wants CellWaits::wants_output(Side side, int index) const {
    const int x = cell_.x() + step_x(side);
    const int y = cell_.y() + step_y(side);
    const bool inside = x >= 0 && x < env_.width() && y >= 0 && y < env_.height();
    const std::string where =
        inside ? "cell (" + std::to_string(x) + ", " + std::to_string(y) + ")" : std::string("the exterior");
    return wants_buffer(
        map_, *cell_.output(side), index,
        "room in " + where + ", output " + name_of(side) + " " + class_name(env_.machine.networks, index));
}

Wants CellWaits::wants_answer_way(const Answer& answer) const {
    if (cell_.is_home(answer)) return Wants::nothing("its way home, in this cell");
    return wants_output(cell_.route(answer), env_.classes.answer);
}

Wants CellWaits::wants_slot(const Ray& ray) const {
    if (cell_.ray_store().has_room(ray.generation)) return Wants::nothing("a slot, and there is one");
    Wants wants{false, false, {}, "a slot"};
    if (env_.machine.recovery == Recovery::postpone) {
        wants = wants_answer_way(answer_to(ray, Answer::Kind::postponed));
        wants.text = "a slot, or a way for its postponed notice: " + wants.text;
        if (wants.moves) return wants;
    }
    for (std::uint32_t i = 0; i < cell_.ray_store().touched(); ++i) {
        const Slot& slot = cell_.ray_store()[i];
        if (slot.state == Slot::State::empty) continue;
        if (!cell_.ray_store().would_help(slot.packet->ray.generation, ray.generation)) continue;
        if (const auto node = map_.find(&cell_, Kind::slot, i)) wants.on.push_back(*node);
    }
    return wants;
}

Wants CellWaits::wants_shading() const {
    if (cell_.shading().job() != ShadingUnit::Job::direct_answer) return Wants::nothing("the shading unit");
    const auto unit = map_.find(&cell_, Kind::shading, 0);
    return unit ? Wants{false, false, {*unit}, "the shading unit"} : Wants::nothing("the shading unit");
}

Wants CellWaits::wants_ray(const RayPacket& packet) const {
    if (packet.stage != RayPacket::Stage::decided) return Wants::nothing("the traversal unit");
    switch (packet.need.kind) {
        case Need::Kind::output:
            return wants_output(packet.need.side, packet.need.index);
        case Need::Kind::response:
            return with_text("a way for its answer, since it has ended: ",
                             wants_answer_way(answer_to(packet.ray, packet.need.answer)));
        case Need::Kind::slot:
            return wants_slot(packet.ray);
        case Need::Kind::shading_unit:
            return wants_shading();
        case Need::Kind::border_walk:
            return Wants::nothing("its way to the border");
        case Need::Kind::nothing:
            break;
    }
    return Wants::nothing("nothing: it ends");
}

/// All that a waiting slot still lacks. A child that stands nowhere (in its back-off) adds no edge: it comes
/// by itself.
Wants CellWaits::wants_children(std::uint32_t index) const {
    const Slot& slot = cell_.ray_store()[index];
    Wants wants{false, true, {}, ""};
    const auto await = [&](std::optional<WaitGraph::Index> node, const std::string& what) {
        if (node && std::find(wants.on.begin(), wants.on.end(), *node) != wants.on.end()) return;
        wants.text += (wants.text.empty() ? "" : ", ") + what;
        if (node) wants.on.push_back(*node);
    };
    if (slot.child) await(map_.find(&cell_, Kind::child, index), "its child to leave");
    for (unsigned child = 0; child < 2; ++child) {
        if (!slot.await_child[child] || slot.send_child[child]) continue;
        const RayKind kind = child == 0 ? RayKind::reflected : RayKind::refracted;
        await(map_.where(cell_.x(), cell_.y(), kind, index, child),
              child == 0 ? "its reflected ray" : "its refracted ray");
    }
    const bool memo = env_.context.settings.shadows == Shadows::memo;
    const std::uint32_t voxel = slot.packet->visit.hit.voxel;
    const std::uint64_t verdicts =
        memo ? slot.setup.facing & ~cell_.store().known[voxel] : slot.awaited & ~slot.to_ask;
    for (unsigned source = 0; source < 64; ++source) {
        if (!(verdicts >> source & 1)) continue;
        await(memo ? map_.where(cell_.x(), cell_.y(), RayKind::memo, voxel, source)
                   : map_.where(cell_.x(), cell_.y(), RayKind::shadow, index, source),
              "its verdict of source " + std::to_string(source));
    }
    wants.moves = wants.on.empty();
    return wants;
}

Wants CellWaits::wants_of_slot(std::uint32_t index) const {
    const Slot& slot = cell_.ray_store()[index];
    switch (slot.state) {
        case Slot::State::to_set_up:
            return wants_shading();
        case Slot::State::waiting:
            return cell_.complete(slot) ? wants_shading() : wants_children(index);
        case Slot::State::to_answer:
            return wants_answer_way(answer_to(slot.packet->ray, Answer::Kind::intensity));
        case Slot::State::empty:
        case Slot::State::in_setup:
        case Slot::State::in_shading:
            break;
    }
    return Wants::nothing("the end of its shading");
}

/// What a load message waits for: the cases of pass_load().
Wants CellWaits::wants_load() const {
    const Message head = cell_.load_input()->front(0);
    if (head.kind != Message::Kind::load) return Wants::nothing("its arrival");
    if (cell_.loading_unit().item() != head.load || env_.scheduler.now() < cell_.loading_unit().done())
        return Wants::nothing("the end of the cell's work");
    const Cycle making = env_.costs().load_voxel(env_.context.settings.hit);
    Wakeup unused;
    if (LoadingUnits::makes_voxel(*head.load, cell_.x()) &&
        !cell_.loading_unit().has_room(env_.machine.load_queue, making, env_.scheduler.now(), unused))
        return Wants::nothing("a place in the cell: voxels before it are being made");
    if (LoadingUnits::ends_at(*head.load, cell_.x(), env_.width()))
        return Wants::nothing("nothing: it ends here");
    return wants_buffer(map_, *cell_.output(Side::east), 0, "output east");
}

void CellWaits::add_waits() {
    if (env_.phase == Phase::load) {
        if (!cell_.load_input()) return;
        if (const auto node = map_.find(cell_.load_input(), Kind::buffer, 0)) map_.set(*node, wants_load());
        return;
    }
    for (int side = 0; side < side_count; ++side) {
        const Link* in = cell_.input(Side(side));
        if (!in) continue;
        for (int index = 0; index < env_.classes.count; ++index) {
            const auto node = map_.find(in, Kind::buffer, std::uint32_t(index));
            if (!node) continue;
            const Message head = in->front(index);
            map_.set(*node, head.kind == Message::Kind::ray      ? wants_ray(*head.ray)
                            : head.kind == Message::Kind::answer ? wants_answer_way(*head.answer)
                                                                 : Wants::nothing("its arrival"));
        }
    }
    if (const auto node = map_.find(&cell_, Kind::own, 0))
        map_.set(*node, wants_ray(*cell_.injector().ray()));
    if (const auto node = map_.find(&cell_, Kind::shading, 0)) {
        map_.set(*node,
                 cell_.shading().job() == ShadingUnit::Job::direct_answer
                     ? wants_answer_way(answer_to(cell_.shading().direct_ray()->ray, Answer::Kind::intensity))
                     : Wants::nothing("the end of its shading"));
    }
    for (std::uint32_t i = 0; i < cell_.ray_store().touched(); ++i) {
        if (const auto node = map_.find(&cell_, Kind::slot, i)) map_.set(*node, wants_of_slot(i));
        if (const auto node = map_.find(&cell_, Kind::child, i))
            map_.set(*node, wants_ray(*cell_.ray_store()[i].child));
    }
}

}  // namespace

void add_buffer(WaitMap& map, const Link& link, int index, WaitGraph::Node node) {
    const int count = link.occupancy(index);
    if (count == 0) return;
    // The latest cycle in which a message came to its place or became the first.
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

void add_places(const Cell& cell, WaitMap& map) { CellWaits(cell, map).add_places(); }

void add_waits(const Cell& cell, WaitMap& map) { CellWaits(cell, map).add_waits(); }

}  // namespace raycell
