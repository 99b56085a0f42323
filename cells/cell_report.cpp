// What stands in a cell, in words: for reports of runs that stopped.
#include "cells/cell.hpp"

namespace raycell {
namespace {

std::string describe_ray(const RayPacket& packet) {
    const Ray& ray = packet.ray;
    std::string text = "ray " + ray_name(ray.id) + " of generation " + std::to_string(ray.generation);
    if (packet.stage != RayPacket::Stage::decided) return text + ", not yet tested";
    switch (packet.visit.event) {
        case Visit::Event::forward:
            return text + ", waits for the output " + name_of(packet.visit.crossing.side) +
                   " or, at the border, for the answer network";
        case Visit::Event::hit:
            return text + (is_shadow(ray.kind)
                               ? ", waits for the answer network"
                               : ", waits for a slot, the shading unit or the answer network");
        case Visit::Event::leaves_cube:
        case Visit::Event::reaches_source:
            return text + ", waits for the answer network";
    }
    return text;
}

}  // namespace

std::vector<std::string> Cell::describe_blocked() const {
    std::vector<std::string> lines;
    const std::string at = "cell (" + std::to_string(x_) + ", " + std::to_string(y_) + ") ";
    for (std::size_t place = 0; place < ray_input_count_; ++place) {
        const RayPacket* packet = packet_at(place);
        if (!packet) continue;
        const RayInput& input = ray_inputs_[place];
        lines.push_back(at + "input " + name_of(input.side) + " class " + std::to_string(input.index) +
                        " since cycle " + std::to_string(link_of(place).arrival(input.index)) + ": " +
                        describe_ray(*packet));
    }
    for (int side = 0; side < side_count; ++side) {
        const Link* in = in_[std::size_t(side)];
        if (!in) continue;
        const Message message = in->front(env_.classes.answer);
        if (message.kind != Message::Kind::answer) continue;
        lines.push_back(at + "input " + name_of(Side(side)) + " since cycle " +
                        std::to_string(in->arrival(env_.classes.answer)) + ": answer to ray " +
                        ray_name(message.answer->id) +
                        (local(*message.answer)
                             ? ", is home"
                             : std::string(", waits for the output ") + name_of(route(*message.answer))));
    }
    if (const RayPacket* own = injector_.ray()) {
        lines.push_back(at + "own ray since cycle " + std::to_string(own->decided) + ": " +
                        describe_ray(*own));
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        const Slot& slot = ray_store_[i];
        if (slot.state == Slot::State::empty || !slot.packet) continue;
        const Ray& ray = slot.packet->ray;
        lines.push_back(at + "slot " + std::to_string(i) + " since cycle " + std::to_string(slot.since) +
                        ": ray " + ray_name(ray.id) + " of generation " + std::to_string(ray.generation) +
                        (slot.child ? "; its child: " + describe_ray(*slot.child) : ", waits for answers"));
    }
    return lines;
}

}  // namespace raycell
