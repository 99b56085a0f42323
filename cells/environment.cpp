#include "cells/environment.hpp"

#include <stdexcept>

#include "cells/channels/link.hpp"
#include "model/machine/stall.hpp"

namespace raycell {

CellConfig::CellConfig(const CellScene& scene, const PictureSettings& picture_settings,
                       const MachineSettings& machine_settings, const SyntheticTraffic* traffic)
    : settings(picture_settings),
      machine(machine_settings),
      context(scene, settings, traffic),
      bits(message_bits(settings, machine, context.arithmetic.formats())),
      cycles{cycles_for(bits.ray), cycles_for(bits.shadow_ray), cycles_for(bits.intensity),
             cycles_for(bits.verdict)},
      classes(buffer_classes(machine.networks)),
      answer_routing(classes.count > 1 ? int(machine.costs.route_return) : 0) {
    if (machine.wire_check) wire.emplace(settings, machine, context.arithmetic.formats());
}

void CellConfig::stall(Link& link, const std::string& name) const {
    if (!(machine.stall > 0)) return;
    std::uint64_t who = 0;
    for (const char c : name) who = mix_bits(who, std::uint64_t(c));
    link.set_stall(machine.stall, machine.seed, who);
}

/// What `unpacked` gives; counts it, and says where a value without a code came up.
template <typename F>
auto Environment::checked(std::uint64_t ray, const F& unpacked) {
    try {
        ++meters.counters.packed;
        return unpacked();
    } catch (const std::range_error& error) {
        throw std::runtime_error("--wire-check: cycle " + std::to_string(scheduler.now()) + ", ray " +
                                 ray_name(ray) + ": " + error.what());
    }
}

void Environment::pack_and_unpack(RayPacket& packet) {
    const std::uint64_t id = packet.ray.id;
    packet.ray =
        checked(id, [&] { return wire->unpack_ray(wire->pack(packet.ray), phase == Phase::precast); });
    packet.ray.id = id;
    packet.visit = {};
}

void Environment::pack_and_unpack(Answer& answer) {
    const std::uint64_t id = answer.id;
    answer = checked(id, [&] { return wire->unpack_answer(wire->pack(answer), phase == Phase::precast); });
    answer.id = id;
}

int CellConfig::load_bits(const LoadItem& item) const {
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
