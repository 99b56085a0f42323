// The injector of the cell's own rays, without a cell.
#include "cells/units/injector.hpp"

#include <gtest/gtest.h>

#include <array>

namespace raycell {
namespace {

TEST(Injector, SendsThePrimaryRayOnceAndAgainAfterItWasPostponed) {
    const MachineSettings machine;
    Injector injector;
    EXPECT_FALSE(injector.unfinished());
    injector.begin_phase(true);
    EXPECT_TRUE(injector.unfinished());
    Wakeup wakeup;
    ASSERT_TRUE(injector.primary_due(1, wakeup));
    EXPECT_TRUE(injector.primary_sent()) << "for the first time";
    EXPECT_FALSE(injector.primary_due(2, wakeup));
    EXPECT_EQ(wakeup.next, never);
    EXPECT_TRUE(injector.unfinished()) << "its answer is still to come";

    injector.primary_postponed(machine, 3, 100);
    const Cycle again = 100 + Retry::backoff(machine, 3, 0);
    EXPECT_FALSE(injector.primary_due(again - 1, wakeup));
    EXPECT_EQ(wakeup.next, again);
    ASSERT_TRUE(injector.primary_due(again, wakeup));
    EXPECT_FALSE(injector.primary_sent()) << "not for the first time";
    injector.primary_answered();
    EXPECT_FALSE(injector.unfinished());
}

TEST(Injector, SendsThePrimaryRayNotBeforeItsStart) {
    Injector injector;
    injector.begin_phase(true, 70);
    Wakeup wakeup;
    EXPECT_FALSE(injector.primary_due(69, wakeup));
    EXPECT_EQ(wakeup.next, 70u);
    EXPECT_TRUE(injector.unfinished());
    EXPECT_TRUE(injector.primary_due(70, wakeup));
}

TEST(Injector, StartsAreSpreadEvenlyAndOtherwiseForEverySeed) {
    MachineSettings machine;
    EXPECT_EQ(Retry::first_start(machine, 5), 0u) << "all at once";
    machine.start_within = 1000;
    std::array<int, 10> tenths{};
    int equal = 0;
    for (std::uint64_t pixel = 0; pixel < 10000; ++pixel) {
        machine.seed = 1;
        const Cycle start = Retry::first_start(machine, pixel << 32);
        ASSERT_LT(start, 1000u);
        ++tenths[start / 100];
        machine.seed = 2;
        equal += start == Retry::first_start(machine, pixel << 32);
    }
    for (const int tenth : tenths) EXPECT_NEAR(tenth, 1000, 150);
    EXPECT_LT(equal, 50);
}

TEST(Injector, IsUnfinishedWhileARayStandsInItsRegister) {
    Injector injector;
    RayPacket packet;
    injector.load(packet);
    EXPECT_EQ(injector.ray(), &packet);
    EXPECT_TRUE(injector.unfinished());
    injector.left();
    EXPECT_EQ(injector.ray(), nullptr);
    EXPECT_FALSE(injector.unfinished());
}

TEST(Injector, GivesEveryPairOfVoxelAndSourceOnceInAPhase) {
    Injector injector;
    for (int phase = 0; phase < 2; ++phase) {
        injector.begin_phase(false);
        for (std::uint32_t voxel = 0; voxel < 3; ++voxel) {
            for (std::size_t source = 0; source < 2; ++source) {
                const auto next = injector.next_precast(3, 2);
                ASSERT_TRUE(next);
                EXPECT_EQ(next->voxel, voxel);
                EXPECT_EQ(next->source, source);
            }
        }
        EXPECT_FALSE(injector.next_precast(3, 2));
    }
    injector.begin_phase(false);
    EXPECT_FALSE(injector.next_precast(3, 0)) << "no sources";
}

}  // namespace
}  // namespace raycell
