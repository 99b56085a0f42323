// The injector of the cell's own rays, without a cell.
#include "cells/units/injector.hpp"

#include <gtest/gtest.h>

#include <array>

namespace raycell {
namespace {

TEST(Injector, SendsThePrimaryRayOnceAndAgainAfterItWasPostponed) {
    const MachineSettings machine;
    Injector injector(1);
    EXPECT_FALSE(injector.unfinished());
    injector.begin_phase(0, 1);
    EXPECT_TRUE(injector.unfinished());
    Wakeup wakeup;
    ASSERT_EQ(injector.primary_due(1, wakeup), 0u);
    EXPECT_TRUE(injector.primary_sent(0, 1)) << "for the first time";
    EXPECT_FALSE(injector.primary_due(2, wakeup));
    EXPECT_EQ(wakeup.next, never);
    EXPECT_TRUE(injector.unfinished()) << "its answer is still to come";

    injector.primary_postponed(0, machine, 3, 100);
    const Cycle again = 100 + Retry::backoff(machine, 3, 0);
    EXPECT_FALSE(injector.primary_due(again - 1, wakeup));
    EXPECT_EQ(wakeup.next, again);
    ASSERT_EQ(injector.primary_due(again, wakeup), 0u);
    EXPECT_FALSE(injector.primary_sent(0, again)) << "not for the first time";
    injector.primary_answered(0);
    EXPECT_FALSE(injector.unfinished());
}

TEST(Injector, SendsThePrimaryRayNotBeforeItsStart) {
    Injector injector(1);
    injector.begin_phase(0, 1, 70);
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

TEST(Injector, HasNoMoreRaysOfItsBlockUnderWayThanItMayAndSendsEachPixelsRayOnce) {
    Injector injector(3);
    injector.begin_phase(0, 5);
    Wakeup wakeup;
    std::vector<int> pixels;
    std::vector<unsigned> under_way;
    for (Cycle now = 1; injector.unfinished(); ++now) {
        ASSERT_LT(now, 100u);
        while (const auto number = injector.primary_due(now, wakeup)) {
            ASSERT_TRUE(injector.primary_sent(*number, now));
            pixels.push_back(injector.sample(*number));
            under_way.push_back(*number);
        }
        EXPECT_LE(under_way.size(), 3u);
        injector.primary_answered(under_way.front());
        under_way.erase(under_way.begin());
    }
    EXPECT_EQ(pixels, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Injector, SendsNothingFromItsStopOnBeforeItIsToldToGoOn) {
    Injector injector(2);
    injector.begin_phase(0, 20);
    injector.go_on(0, 2);
    Wakeup wakeup;
    const auto send = [&] {
        const auto number = injector.primary_due(1, wakeup);
        if (!number) return -1;
        injector.primary_sent(*number, 0);
        const int sample = injector.sample(*number);
        injector.primary_answered(*number);
        return sample;
    };
    EXPECT_EQ(send(), 0);
    EXPECT_EQ(send(), 1);
    EXPECT_EQ(send(), -1);
    EXPECT_TRUE(injector.unfinished());
    injector.go_on(18, 26);
    EXPECT_EQ(send(), 18);
    EXPECT_EQ(send(), 19);
    EXPECT_EQ(send(), -1) << "the phase has no more";
    EXPECT_FALSE(injector.unfinished());
}

TEST(Injector, MakesTheNextPixelsRayBeforeItSendsIt) {
    Injector injector(2);
    injector.begin_phase(0, 2);
    Wakeup wakeup;
    ASSERT_TRUE(injector.primary_sent(*injector.primary_due(1, wakeup), 40));
    EXPECT_FALSE(injector.primary_due(39, wakeup));
    EXPECT_EQ(wakeup.next, 40u);
    EXPECT_EQ(injector.primary_due(40, wakeup), 1u);
}

TEST(Injector, SendsPostponedRaysInTurnAndBeginsNoPixelBeforeTheyAreAnswered) {
    const MachineSettings machine;
    Injector injector(3);
    injector.begin_phase(0, 4);
    Wakeup wakeup;
    for (unsigned number = 0; number < 3; ++number) injector.primary_sent(number, 0);
    for (unsigned number = 0; number < 2; ++number) injector.primary_postponed(number, machine, number, 10);
    injector.primary_answered(2);
    constexpr Cycle late = 100000;
    ASSERT_EQ(injector.primary_due(late, wakeup), 0u);
    EXPECT_FALSE(injector.primary_sent(0, late));
    injector.primary_postponed(0, machine, 0, late);
    ASSERT_EQ(injector.primary_due(2 * late, wakeup), 1u) << "0 had its turn";
    injector.primary_sent(1, 2 * late);
    injector.primary_answered(1);
    ASSERT_EQ(injector.primary_due(2 * late, wakeup), 0u);
    injector.primary_sent(0, 2 * late);
    injector.primary_answered(0);
    ASSERT_TRUE(injector.primary_due(2 * late, wakeup)) << "now the last pixel";
}

TEST(Injector, IsUnfinishedWhileARayStandsInItsRegister) {
    Injector injector(1);
    RayPacket packet;
    injector.load(packet);
    EXPECT_EQ(injector.ray(), &packet);
    EXPECT_TRUE(injector.unfinished());
    injector.left();
    EXPECT_EQ(injector.ray(), nullptr);
    EXPECT_FALSE(injector.unfinished());
}

TEST(Injector, GivesEveryPairOfVoxelAndSourceOnceInAPhase) {
    Injector injector(1);
    for (int phase = 0; phase < 2; ++phase) {
        injector.begin_phase(0, 0);
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
    injector.begin_phase(0, 0);
    EXPECT_FALSE(injector.next_precast(3, 0)) << "no sources";
}

}  // namespace
}  // namespace raycell
