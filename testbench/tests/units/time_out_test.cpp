// The time-out: for how long nothing has moved while something wants to.
#include "cells/units/time_out.hpp"

#include <gtest/gtest.h>

namespace raycell {
namespace {

TEST(TimeOut, CountsFromTheFirstCycleInWhichSomethingIsBlockedUntilAnythingMoves) {
    Pool<TimeOut::Counts> counts;
    TimeOut time_out;
    EXPECT_EQ(time_out.since(), never);
    time_out.step(false, true, 100, counts);
    time_out.step(false, true, 150, counts);
    EXPECT_EQ(time_out.since(), 100u);
    time_out.step(true, false, 164, counts);
    EXPECT_EQ(time_out.since(), never);
    EXPECT_EQ(time_out.ended(6), 1u) << "64 cycles: an alarm at 2^6";
    EXPECT_EQ(time_out.ended(7), 0u);
}

TEST(TimeOut, BeginsAnewWhereOneThingMovesAndAnotherIsStillBlocked) {
    Pool<TimeOut::Counts> counts;
    TimeOut time_out;
    time_out.step(false, true, 100, counts);
    time_out.step(true, true, 140, counts);
    EXPECT_EQ(time_out.since(), 140u);
    time_out.step(false, false, 150, counts);
    EXPECT_EQ(time_out.since(), never) << "nothing wants to move any more";
    EXPECT_EQ(time_out.ended(5), 1u);
}

}  // namespace
}  // namespace raycell
