#include "cells/environment.hpp"

#include "cells/link.hpp"
#include "model/stall.hpp"

namespace raycell {

void Environment::stall(Link& link, const std::string& name) const {
    if (!(machine.stall > 0)) return;
    std::uint64_t who = 0;
    for (const char c : name) who = mix_bits(who, std::uint64_t(c));
    link.set_stall(machine.stall, machine.seed, who);
}

void Environment::find_buffer_places() {
    for (int side = 0; side < side_count; ++side) {
        for (int index = 0; index < classes.count; ++index) {
            buffer_places[std::size_t(side)][std::size_t(index)] =
                Link::place_of(index, classes.used_over(Side(side)));
        }
    }
}

int Environment::load_bits(const LoadItem& item) const {
    switch (item.kind) {
        case LoadItem::Kind::setup:
            return bits.setup(context.scene.sources.size());
        case LoadItem::Kind::features:
            return bits.features;
        case LoadItem::Kind::polygon:
            return int(item.polygon.vertices.size()) * bits.vertex + bits.polygon;
        case LoadItem::Kind::trapeze:
            return bits.trapeze;
        case LoadItem::Kind::span:
            return bits.span;
        case LoadItem::Kind::end_of_scene:
            break;
    }
    return bits.end_of_scene;
}

}  // namespace raycell
