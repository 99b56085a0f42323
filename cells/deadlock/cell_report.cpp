// Describes in words the messages in a cell, for reports of runs that stopped.
#include "cells/deadlock/cell_waits.hpp"

namespace raycell {
namespace {

std::string describe_ray(const RayPacket& packet) {
    const Ray& ray = packet.ray;
    std::string text = "ray " + ray_name(ray.id) + " of generation " + std::to_string(ray.generation);
    if (packet.stage != RayPacket::Stage::decided) return text + ", not yet tested";
    switch (packet.need.kind) {
        case Need::Kind::output:
            return text + ", waits for the output " + name_of(packet.need.side);
        case Need::Kind::response:
            return text + ", waits for the way of its answer";
        case Need::Kind::slot:
            return text + ", waits for a slot, or with recovery for the way of its postponed notice";
        case Need::Kind::shading_unit:
            return text + ", waits for the shading unit";
        case Need::Kind::nothing:
        case Need::Kind::border_walk:
            break;
    }
    return text;
}

}  // namespace

std::vector<std::string> describe_blocked(const Cell& cell) {
    const Environment& env = cell.environment();
    std::vector<std::string> lines;
    const std::string at = "cell (" + std::to_string(cell.x()) + ", " + std::to_string(cell.y()) + ") ";
    for (int side = 0; side < side_count; ++side) {
        const Link* in = cell.input(Side(side));
        for (int index = 0; in && index < env.classes.count; ++index) {
            const Message message = in->front(index);
            if (message.kind != Message::Kind::ray) continue;
            lines.push_back(at + "input " + name_of(Side(side)) + " class " + std::to_string(index) +
                            " since cycle " + std::to_string(in->arrival(index)) + ": " +
                            describe_ray(*message.ray));
        }
    }
    for (int side = 0; side < side_count; ++side) {
        const Link* in = cell.input(Side(side));
        if (!in) continue;
        const Message message = in->front(env.classes.answer);
        if (message.kind != Message::Kind::answer) continue;
        lines.push_back(at + "input " + name_of(Side(side)) + " since cycle " +
                        std::to_string(in->arrival(env.classes.answer)) + ": answer to ray " +
                        ray_name(message.answer->id) +
                        (cell.is_home(*message.answer) ? ", is home"
                                                       : std::string(", waits for the output ") +
                                                             name_of(cell.route(*message.answer))));
    }
    if (const RayPacket* own = cell.injector().ray()) {
        lines.push_back(at + "own ray since cycle " + std::to_string(own->decided) + ": " +
                        describe_ray(*own));
    }
    for (std::uint32_t i = 0; i < cell.ray_store().touched(); ++i) {
        const Slot& slot = cell.ray_store()[i];
        if (slot.state == Slot::State::empty || !slot.packet) continue;
        const Ray& ray = slot.packet->ray;
        lines.push_back(at + "slot " + std::to_string(i) + " since cycle " + std::to_string(slot.since) +
                        ": ray " + ray_name(ray.id) + " of generation " + std::to_string(ray.generation) +
                        (slot.child ? "; its child: " + describe_ray(*slot.child) : ", waits for answers"));
    }
    return lines;
}

}  // namespace raycell
