#include "cells/units/traversal_unit.hpp"

namespace raycell {

std::uint32_t TraversalUnits::test(RayPacket& packet, const Setting& setting, const CostTable& costs) {
    const Context& context = setting.context;
    packet.visit = visit_cell(setting.store, packet.ray, context, setting.index);
    packet.need =
        need_of(packet.ray, packet.visit, setting.store, setting.x, setting.y, setting.classes, context);
    return visit_cycles(packet.visit, context.settings, costs);
}

}  // namespace raycell
