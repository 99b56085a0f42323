// The exterior's part of the wait-for graph: what the border links and the exterior processors wait for.
#include "pipeline/stages/exterior.hpp"

namespace raycell {

using Kind = WaitGraph::Kind;

void Exterior::add_places(WaitMap& map) const {
    const Networks networks = environment().machine.networks;
    for (const BorderPort& port : ports_) {
        WaitGraph::Node node;
        node.x = port.x;
        node.y = port.y;
        for (int index = 0; index < port.from_cell->classes(); ++index) {
            node.what = "border " + std::string(class_name(networks, index)) + " to the exterior";
            add_buffer(map, *port.from_cell, index, node);
        }
    }
    for (std::uint32_t i = 0; i < processors_.size(); ++i) {
        const Processor& processor = processors_[i];
        if (!processor.busy) continue;
        WaitGraph::Node node;
        node.kind = Kind::processor;
        node.x = ports_[processor.port].x;
        node.y = ports_[processor.port].y;
        node.what = "exterior processor " + std::to_string(i);
        node.holds = describe(processor.answer);
        node.since = processor.done;
        map.place(processor.answer, map.add(this, i, std::move(node)));
    }
}

void Exterior::add_waits(WaitMap& map) const {
    const Environment& env = environment();
    Wants any{working_ < env.machine.exterior_processors, false, {}, "an exterior processor"};
    for (std::uint32_t i = 0; i < processors_.size() && !any.moves; ++i)
        any.on.push_back(*map.find(this, Kind::processor, i));
    for (const BorderPort& port : ports_) {
        for (int index = 0; index < port.from_cell->classes(); ++index) {
            if (const auto node = map.find(port.from_cell, Kind::buffer, std::uint32_t(index)))
                map.set(*node, any);
        }
    }
    for (std::uint32_t i = 0; i < processors_.size(); ++i) {
        const auto node = map.find(this, Kind::processor, i);
        if (!node) continue;
        const Processor& processor = processors_[i];
        map.set(*node, env.scheduler.now() < processor.done
                           ? Wants::nothing("the end of its work")
                           : wants_buffer(map, *ports_[processor.port].to_cell, env.classes.answer,
                                          "the border's link into the array"));
    }
}

}  // namespace raycell
