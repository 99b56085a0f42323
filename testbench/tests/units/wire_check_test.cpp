// With a wire check a receiver computes with what unpacks, and with nothing that was not packed.
#include "cells/passing.hpp"
#include "units.hpp"

namespace raycell {
namespace {

/// What a sender knows and no bit carries: it must be gone at the far end.
RayPacket any_packet(RayKind kind) {
    RayPacket packet;
    packet.ray.kind = kind;
    packet.ray.id = ray_id(5, 7);
    packet.ray.position = {0, 0.5, 3};
    packet.ray.child = kind == RayKind::refracted ? 1 : 0;
    packet.ray.generation = 2;
    packet.ray.weight = 0.5;
    packet.ray.leaves_front = true;
    packet.visit.crossing.t = 0.25;
    return packet;
}

TEST(WireCheckOfAMessage, ItsReceiverGetsWhatUnpacksAndNoMore) {
    for (const bool check : {false, true}) {
        UnitContext unit;
        unit.settings.numbers.arithmetic = Numbers::fixed;
        MachineSettings machine;
        machine.wire_check = check;
        Picture picture(3, 3);
        Scheduler scheduler(check ? "with" : "without", sc_core::sc_time(50, sc_core::SC_NS));
        Environment environment(unit.scene, unit.settings, machine, scheduler, picture);
        environment.phase = Phase::trace;
        RayPacket shadow = any_packet(RayKind::shadow);
        set_direction(shadow.ray, {1, 0, 0}, environment.context.arithmetic);
        environment.over_wire(shadow);
        EXPECT_EQ(shadow.ray.id, ray_id(5, 7)) << "its name stays";
        EXPECT_EQ(shadow.ray.generation, check ? 0 : 2) << "a shadow ray carries none";
        EXPECT_EQ(shadow.ray.weight, check ? 1 : 0.5);
        EXPECT_EQ(shadow.ray.leaves_front, !check);
        EXPECT_EQ(shadow.ray.fresh, !check);
        EXPECT_EQ(shadow.visit.crossing.t == 0.25, !check);
        Answer verdict = answer_to(shadow.ray, Answer::Kind::lit);
        verdict.colour = dvec3(1);
        environment.over_wire(verdict);
        EXPECT_EQ(verdict.colour, check ? dvec3(0) : dvec3(1));
        EXPECT_EQ(verdict.kind, Answer::Kind::lit);
        EXPECT_EQ(verdict.ray_kind, RayKind::shadow);
        EXPECT_EQ(environment.meters.counters.packed, check ? 2u : 0u);
    }
}

}  // namespace
}  // namespace raycell
