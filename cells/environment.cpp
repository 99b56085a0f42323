#include "cells/environment.hpp"

#include <algorithm>
#include <stdexcept>

#include "cells/channels/link.hpp"
#include "model/machine/stall.hpp"
#include "model/machine/storage_bits.hpp"

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
      voxel_bits(raycell::voxel_bits(settings, context.arithmetic.formats(), context.lights.rays.size())),
      kept_span_bits(raycell::kept_span_bits(bits)),
      own_rays(own_rays_of(settings, machine)),
      primary_cycles(raycell::primary_cycles(context, machine.costs)),
      answer_routing(classes.count > 1 ? int(machine.costs.route_return) : 0) {
    if (!machine.wire_check) return;
    wire.emplace(settings, machine, context.arithmetic.formats());
    load_wire.emplace(settings, context.arithmetic.formats());
}

void CellConfig::stall(Link& link, const std::string& name) const {
    if (!(machine.stall > 0)) return;
    std::uint64_t who = 0;
    for (const char c : name) who = mix_bits(who, std::uint64_t(c));
    link.set_stall(machine.stall, machine.seed, who);
}

/// What `unpacked` gives; counts it, and says where a value without a code came up.
template <typename F, typename U>
auto Environment::checked(const F& what, const U& unpacked) {
    try {
        return unpacked();
    } catch (const std::range_error& error) {
        throw std::runtime_error("--wire-check: cycle " + std::to_string(scheduler.now()) + ", " + what() +
                                 ": " + error.what());
    }
}

void Environment::pack_and_unpack(RayPacket& packet) {
    const std::uint64_t id = packet.ray.id;
    ++meters.counters.packed;
    packet.ray = checked([&] { return "ray " + ray_name(id); },
                         [&] { return wire->unpack_ray(wire->pack(packet.ray), phase == Phase::precast); });
    packet.ray.id = id;
    packet.visit = {};
}

void Environment::pack_and_unpack(Answer& answer) {
    const std::uint64_t id = answer.id;
    ++meters.counters.packed;
    answer = checked([&] { return "ray " + ray_name(id); },
                     [&] { return wire->unpack_answer(wire->pack(answer), phase == Phase::precast); });
    answer.id = id;
}

namespace {

bool equal(const Material& a, const Material& b) {
    return a.colour == b.colour && a.diffuse == b.diffuse && a.specular == b.specular && a.shine == b.shine &&
           a.transmit == b.transmit && a.ior == b.ior && a.mirror == b.mirror;
}
bool equal(const ViewerMessage& a, const ViewerMessage& b) {
    const auto same = [](const Source& p, const Source& q) {
        return p.kind == q.kind && p.position == q.position && p.intensity == q.intensity &&
               p.axis == q.axis && p.cut_off == q.cut_off && p.falloff == q.falloff && p.edge_u == q.edge_u &&
               p.edge_v == q.edge_v && p.radius == q.radius && p.exponent == q.exponent;
    };
    return a.eye == b.eye && a.at_infinity == b.at_infinity && a.beyond == b.beyond &&
           a.background == b.background && a.depth_levels == b.depth_levels && a.level == b.level &&
           a.tells_kinds == b.tells_kinds && a.samples == b.samples && a.share == b.share &&
           std::equal(a.sources.begin(), a.sources.end(), b.sources.begin(), b.sources.end(), same);
}

}  // namespace

/// Packs a load message and puts into its place what unpacks. What all cells latch is kept once for all of
/// them: it must be equal.
WireBits Environment::exchange(LoadItem& item) const {
    // Its object is the one whose features came last.
    const auto replace = [](auto& message, auto unpacked) {
        unpacked.object = message.object;
        message = std::move(unpacked);
    };
    WireBits packed;
    bool latched = true;
    switch (item.kind) {
        case LoadItem::Kind::setup:
            packed = load_wire->pack(viewer_of(context));
            latched = equal(load_wire->unpack_viewer(packed), viewer_of(context));
            break;
        case LoadItem::Kind::features:
            packed = load_wire->pack(context.objects[item.object]);
            latched = equal(load_wire->unpack_features(packed), context.objects[item.object]);
            break;
        case LoadItem::Kind::polygon:
            packed = load_wire->pack(item.polygon);
            replace(item.polygon, load_wire->unpack_polygon(packed));
            break;
        case LoadItem::Kind::surface:
            packed = load_wire->pack(static_cast<const Surface&>(item.trapeze));
            {
                Trapeze alone;  // no rows, columns or edges come along
                static_cast<Surface&>(alone) = load_wire->unpack_surface(packed);
                replace(item.trapeze, alone);
            }
            break;
        case LoadItem::Kind::trapeze:
            packed = load_wire->pack(item.trapeze, item.intensities);
            item.trapeze = load_wire->unpack_trapeze(packed, item.intensities);
            break;
        case LoadItem::Kind::span:
            packed = load_wire->pack(item.span);
            replace(item.span, load_wire->unpack_span(packed));
            break;
        case LoadItem::Kind::end_of_scene:
            packed = load_wire->end_of_scene();
            break;
    }
    if (!latched) throw std::logic_error("internal error: latched words differ from those of the message");
    return packed;
}

void Environment::pack_and_unpack(LoadItem& item, int charged) {
    ++meters.counters.packed_load;
    const auto what = [&] { return std::string("load message '") + name_of(item.kind) + "'"; };
    const WireBits packed = checked(what, [&] { return exchange(item); });
    if (packed.size() != charged) {
        throw std::logic_error("internal error: " + what() + " has " + std::to_string(packed.size()) +
                               " bits and is charged for " + std::to_string(charged));
    }
}

int CellConfig::load_bits(const LoadItem& item) const {
    switch (item.kind) {
        case LoadItem::Kind::setup:
            return bits.setup(SourceCounts(context.scene.sources, settings.source_samples));
        case LoadItem::Kind::features:
            return bits.features;
        case LoadItem::Kind::polygon:
            return int(item.polygon.vertices.size()) * bits.vertex + bits.polygon;
        case LoadItem::Kind::trapeze:
            return bits.trapeze + item.trapeze.edge_count * bits.edge;
        case LoadItem::Kind::surface:
            return bits.surface;
        case LoadItem::Kind::span:
            return bits.span + std::min(item.span.edge_count, bits.span_edges) * bits.edge;
        case LoadItem::Kind::end_of_scene:
            break;
    }
    return bits.end_of_scene;
}

}  // namespace raycell
