// The shading unit without a cell: the order of its work, and what a slot still lacks.
#include "cells/units/shading_unit.hpp"

#include "units.hpp"

namespace raycell {
namespace {

using Job = ShadingUnit::Job;

struct Slots3 {
    explicit Slots3(Shadows with = Shadows::per_hit)
        : unit(2, with), shadows(with), slots(3, 1, Slots::free) {
        for (int i = 0; i < 3; ++i) {
            Slot& slot = slots[*slots.allocate(0)];
            slot.packet = &packets[i];
            slot.since = Cycle(10 + i);
            slot.state = Slot::State::waiting;
        }
    }
    std::optional<ShadingUnit::Choice> choice() { return ShadingUnit::choose(slots, unit.store, shadows); }
    bool complete(std::uint32_t slot) { return ShadingUnit::complete(slots[slot], unit.store, shadows); }
    UnitContext unit;
    Shadows shadows;
    RayPacket packets[3];
    RayStore slots;
};

TEST(ShadingUnit, ShadesTheOldestCompleteSlotBeforeItSetsAnyUp) {
    Slots3 s;
    s.slots[0].state = Slot::State::to_set_up;
    s.slots[1].since = 30;
    const auto next = s.choice();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->job, Job::shade);
    EXPECT_EQ(next->slot, 2u);
}

TEST(ShadingUnit, SetsUpTheOldestWhereNoneIsComplete) {
    Slots3 s;
    for (std::uint32_t i : {0U, 1U}) s.slots[i].state = Slot::State::to_set_up;
    s.slots[2].awaited = 1;
    const auto next = s.choice();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->job, Job::set_up);
    EXPECT_EQ(next->slot, 0u);
    for (std::uint32_t i : {0U, 1U}) s.slots[i].state = Slot::State::to_answer;
    EXPECT_FALSE(s.choice());
}

TEST(ShadingUnit, FindsASlotIncompleteForEachThingThatItCanLack) {
    Slots3 s;
    RayPacket child;
    EXPECT_TRUE(s.complete(0));
    const auto lacks = [&](const std::function<void(Slot&)>& change) {
        const Slot whole = s.slots[0];
        change(s.slots[0]);
        EXPECT_FALSE(s.complete(0));
        s.slots[0] = whole;
    };
    lacks([&](Slot& slot) { slot.child = &child; });
    lacks([](Slot& slot) { slot.to_ask = 2; });
    lacks([](Slot& slot) { slot.awaited = 4; });
    for (const int i : {0, 1}) {
        lacks([&](Slot& slot) { slot.send_child[i] = true; });
        lacks([&](Slot& slot) { slot.await_child[i] = true; });
    }
    lacks([](Slot& slot) { slot.state = Slot::State::to_answer; });
}

TEST(ShadingUnit, AsksWithMemoWhatNobodyHasAskedAndWaitsForWhatIsNotKnown) {
    Slots3 s(Shadows::memo);
    Slot& slot = s.slots[0];
    slot.setup.facing = 3;
    ShadingUnit::await(slot, Shadows::memo, 1);
    EXPECT_EQ(slot.to_ask, 2u);
    EXPECT_EQ(slot.awaited, 0u);
    slot.to_ask = 0;
    s.unit.store.known[0] = 1;
    EXPECT_FALSE(s.complete(0));
    s.unit.store.known[0] = 3;
    EXPECT_TRUE(s.complete(0));
}

TEST(ShadingUnit, AwaitsEverySourceThatTheHitFacesAndItsChildren) {
    Slots3 s;
    Slot& slot = s.slots[0];
    slot.setup.facing = 3;
    slot.setup.refracts = true;
    ShadingUnit::await(slot, Shadows::per_hit, 0);
    EXPECT_EQ(slot.to_ask, 3u);
    EXPECT_EQ(slot.awaited, 3u);
    EXPECT_FALSE(slot.send_child[0] || slot.await_child[0]);
    EXPECT_TRUE(slot.send_child[1] && slot.await_child[1]);
    ShadingUnit::await(slot, Shadows::precast, 0);
    EXPECT_EQ(slot.state, Slot::State::waiting);
}

TEST(ShadingUnit, IsBusyUntilItsTimeIsOverAndAnAnswerKeepsItSo) {
    ShadingUnit unit;
    EXPECT_TRUE(unit.idle());
    unit.start(Job::direct, 0, 20);
    Wakeup wakeup;
    EXPECT_FALSE(unit.finished(19, wakeup));
    EXPECT_EQ(wakeup.next, 20u);
    EXPECT_TRUE(unit.finished(20, wakeup));
    unit.hold_answer();
    EXPECT_FALSE(unit.idle());
    unit.free();
    EXPECT_TRUE(unit.idle());
}

}  // namespace
}  // namespace raycell
