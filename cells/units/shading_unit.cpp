#include "cells/units/shading_unit.hpp"

namespace raycell {

bool ShadingUnit::complete(const Slot& slot, const CellStore& store, Shadows shadows) {
    if (slot.state != Slot::State::waiting || slot.child || slot.to_ask || slot.awaited) return false;
    if (slot.send_child[0] || slot.send_child[1] || slot.await_child[0] || slot.await_child[1]) return false;
    if (shadows != Shadows::memo) return true;
    return (slot.setup.facing & ~store.known[slot.packet->visit.hit.voxel]) == 0;
}

bool ShadingUnit::any_complete(const RayStore& slots, const CellStore& store, Shadows shadows) {
    for (std::uint32_t i = 0; i < slots.touched(); ++i) {
        if (complete(slots[i], store, shadows)) return true;
    }
    return false;
}

std::optional<ShadingUnit::Choice> ShadingUnit::choose(const RayStore& slots, const CellStore& store,
                                                       Shadows shadows) {
    constexpr std::uint32_t none = ~std::uint32_t(0);
    std::uint32_t shade = none;
    std::uint32_t set_up = none;
    for (std::uint32_t i = 0; i < slots.touched(); ++i) {
        const Slot& slot = slots[i];
        if (complete(slot, store, shadows) && (shade == none || slot.since < slots[shade].since)) shade = i;
        if (slot.state == Slot::State::to_set_up && (set_up == none || slot.since < slots[set_up].since)) {
            set_up = i;
        }
    }
    if (shade != none) return Choice{Job::shade, shade};
    if (set_up != none) return Choice{Job::set_up, set_up};
    return std::nullopt;
}

std::uint32_t ShadingUnit::set_up(Slot& slot, const CellStore& store, const Context& context,
                                  const CostTable& costs, int x, int y) {
    slot.setup = set_up_hit(context, store, slot.packet->ray, slot.packet->visit.hit, x, y);
    slot.state = Slot::State::in_setup;
    return setup_cycles(context, slot.setup, costs);
}

std::uint32_t ShadingUnit::shade(Slot& slot, const CellStore& store, const Context& context,
                                 const CostTable& costs) {
    const CellHit& hit = slot.packet->visit.hit;
    if (context.settings.shadows != Shadows::per_hit) slot.lit = store.lit[hit.voxel];
    const std::uint32_t object = store.voxels[hit.voxel].object;
    slot.result = shade_hit(context, slot.setup, object, slot.lit, slot.colour[0], slot.colour[1]);
    slot.state = Slot::State::in_shading;
    return shade_cycles(context, slot.setup, object, slot.lit & slot.setup.facing, true, costs);
}

std::uint32_t ShadingUnit::direct(RayPacket& packet, const HitSetup& setup, const CellStore& store,
                                  const Context& context, const CostTable& costs) {
    const std::uint32_t voxel = packet.visit.hit.voxel;
    const std::uint64_t lit = context.settings.shadows == Shadows::per_hit ? 0 : store.lit[voxel];
    packet_ = &packet;
    const std::uint32_t object = store.voxels[voxel].object;
    result_ = shade_hit(context, setup, object, lit, dvec3(0), dvec3(0));
    return setup_cycles(context, setup, costs) +
           shade_cycles(context, setup, object, lit & setup.facing, false, costs);
}

void ShadingUnit::await(Slot& slot, Shadows shadows, std::uint64_t asked) {
    if (shadows == Shadows::per_hit) slot.to_ask = slot.awaited = slot.setup.facing;
    if (shadows == Shadows::memo) slot.to_ask = slot.setup.facing & ~asked;
    slot.send_child[0] = slot.await_child[0] = slot.setup.reflects;
    slot.send_child[1] = slot.await_child[1] = slot.setup.refracts;
    slot.state = Slot::State::waiting;
}

}  // namespace raycell
