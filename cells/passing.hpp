// What every kind of cell does with messages that pass through it and with its own pixel: shared by the
// array's cells and by a user's own cell modules.
#pragma once

#include "cells/environment.hpp"
#include "cells/units/injector.hpp"
#include "cells/units/loading_unit.hpp"

namespace raycell {

/// Sends a tested ray over `out`, the output of the side that it needs; a message must be able to start there
/// now. A template, because cells use Link and a user's modules use LinkOut.
template <typename Out>
void send_ray(RayPacket& packet, Out& out, Environment& environment, CellMeter& meter) {
    const Need need = packet.need;
    const std::uint64_t id = packet.ray.id;
    const int cycles = is_shadow(packet.ray.kind) ? environment.cycles.shadow_ray : environment.cycles.ray;
    if (!need.leaves) {
        cross(packet.ray, packet.visit.crossing, environment.context.arithmetic);
        packet.stage = RayPacket::Stage::untested;
    }
    environment.over_wire(packet);
    ++packet.hops;
    meter.ray_left(environment.meters.counters, need.leaves);
    environment.count_hop(id);
    out.send(need.index, Message(&packet), cycles);
}

/// Sends an answer towards its home over `out`; a message must be able to start there now.
template <typename Out>
void send_answer(Answer* answer, Out& out, Environment& environment, CellMeter& meter) {
    const bool intensity = answer->kind == Answer::Kind::intensity;
    meter.answer_left(environment.meters.counters);
    environment.count_hop(answer->id);
    environment.over_wire(*answer);
    out.send(environment.classes.answer, Message(answer),
             intensity ? environment.cycles.intensity : environment.cycles.verdict,
             environment.answer_routing);
}

/// Sends a load message over `out`; it must be able to start there now.
void send_load(LinkOut& out, LoadItem& item, Environment& environment);
/// The same over a link of the feed, before the rows.
void send_feed(LinkOut& out, LoadItem& item, Environment& environment);

/// The answer in which a tested ray ends, if it needs one.
Answer response_of(const RayPacket& packet, const Context& context);
/// A ray ends here, with or without an answer: counts it and gives the packet back to its pool. Not for
/// postponed rays.
void end_ray(RayPacket& packet, Environment& environment, CellMeter& meter);
/// Makes and counts the packet of a ray that starts now: a child, a primary or a precast ray.
RayPacket* launch(const Ray& ray, Environment& environment);
/// First cycle in which cell (x, y) may send a primary ray in the phase that begins now.
Cycle start_of_primaries(const Environment& environment, int x, int y);
/// The primary rays of the pixels from `pixel` to last - 1 of a cell's block must be sent, from cycle `start`
/// on.
void begin_tracing(Injector& injector, const Environment& environment, int pixel, int last, Cycle start);
/// Returns the primary ray of cell (x, y) that is due, and notes it as sent.
Ray begin_primary(unsigned number, Injector& injector, Environment& environment, int x, int y);
/// Handles the answer to a primary ray of cell (x, y), which may be a postponed notice.
void end_primary(const Answer& answer, Injector& injector, Environment& environment, int x, int y);

/// A span is kept from which a voxel is made; `lines` of the index table are passed for it.
void keep_span(LoadingUnits& unit, std::uint32_t lines, const CellStore& store, Environment& environment,
               CellMeter& meter);

/// One cycle of loading in column x: works on the oldest message of `from`, stores its voxel in `store` if it
/// makes one, and passes it on over `east` (null at the array's border). Returns the kind of the message if
/// its work ended in this cycle.
std::optional<LoadItem::Kind> pass_load(LoadingUnits& unit, LinkIn& from, LinkOut* east, CellStore& store,
                                        Environment& environment, CellMeter& meter, int x, Wakeup& wakeup);

}  // namespace raycell
