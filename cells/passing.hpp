// What every cell does with what passes through it and with its own pixel, whatever it is made of: the
// array's own cells and those of somebody else's.
#pragma once

#include "cells/environment.hpp"
#include "cells/units/injector.hpp"
#include "cells/units/loading_unit.hpp"

namespace raycell {

/// Sends a tested ray that needs an output over it; `out`, of its side, must be free. Cells know their links,
/// others' modules LinkOut.
template <typename Out>
void send_ray(RayPacket& packet, Out& out, Environment& environment, CellMeter& meter) {
    const Need need = packet.need;
    const std::uint64_t id = packet.ray.id;
    const int cycles = is_shadow(packet.ray.kind) ? environment.cycles.shadow_ray : environment.cycles.ray;
    if (!need.leaves) {
        cross(packet.ray, packet.visit.crossing, environment.context.arithmetic);
        packet.stage = RayPacket::Stage::untested;
    }
    ++packet.hops;
    meter.ray_left(environment.meters.counters, need.leaves);
    environment.count_hop(id);
    out.send(need.index, Message(&packet), cycles);
}

/// Sends an answer on its way home; `out` must be free.
template <typename Out>
void send_answer(Answer* answer, Out& out, Environment& environment, CellMeter& meter) {
    const bool intensity = answer->kind == Answer::Kind::intensity;
    meter.answer_left(environment.meters.counters);
    environment.count_hop(answer->id);
    out.send(environment.classes.answer, Message(answer),
             intensity ? environment.cycles.intensity : environment.cycles.verdict,
             environment.answer_routing);
}

/// The answer that a tested ray which needs one ends in.
Answer response_of(const RayPacket& packet, const Context& context);
/// A ray ends here, in the answer that it needs or without one: counts it and takes it back. Not those that
/// are postponed.
void end_ray(RayPacket& packet, Environment& environment, CellMeter& meter);
/// A ray that is put on its way: a child, a primary or a precast ray.
RayPacket* launch(const Ray& ray, Environment& environment);
/// The primary ray of pixel (x, y), which is due.
Ray begin_primary(Injector& injector, Environment& environment, int x, int y);
/// The answer to it, or the notice that it was postponed.
void end_primary(const Answer& answer, Injector& injector, Environment& environment, int x, int y);

/// One cycle of loading in column x: works on the oldest message of `from`, puts what it leaves into `store`,
/// and passes it on over `east`, null over the array's border. Returns what kind of message was taken, if
/// any.
std::optional<LoadItem::Kind> pass_load(LoadingUnit& unit, LinkIn& from, LinkOut* east, CellStore& store,
                                        Environment& environment, CellMeter& meter, int x, Wakeup& wakeup);

}  // namespace raycell
