// The aging arbiter without a cell: which messages are overdue.
#include "cells/units/aging_arbiter.hpp"

#include <gtest/gtest.h>

namespace raycell {
namespace {

using Kind = AgingArbiter::Kind;
constexpr Cycle patience = AgingArbiter::patience;
constexpr Cycle epoch = AgingArbiter::epoch;

TEST(AgingArbiter, CallsOverdueWhatHadWaitedForLongerThanItsPatienceWhenTheEpochBegan) {
    const Cycle begins = patience + 5 * epoch;
    for (const Cycle now : {begins, begins + 1, begins + epoch - 1}) {
        AgingArbiter arbiter;
        AgingArbiter::Look look(arbiter, now);
        look.add(begins - patience, Kind::ray, 1);
        look.add(begins - patience - 1, Kind::ray, 2);
        look.add(now, Kind::ray, 3);
        const auto overdue = look.finish();
        ASSERT_EQ(overdue.size(), 1u);
        EXPECT_EQ(overdue[0].index, 2u);
        EXPECT_TRUE(arbiter.due(now + 1)) << "it looks in every step while there is any";
    }
}

TEST(AgingArbiter, PutsTheOldestFirstWhateverItIs) {
    AgingArbiter arbiter;
    AgingArbiter::Look look(arbiter, 20 * patience);
    look.add(30, Kind::answer, 0);
    look.add(10, Kind::ray, 7);
    look.add(20, Kind::reply, 0);
    look.add(10, Kind::ray, 4);
    const auto overdue = look.finish();
    ASSERT_EQ(overdue.size(), 4u);
    EXPECT_EQ(overdue[0].index, 4u);
    EXPECT_EQ(overdue[1].index, 7u);
    EXPECT_EQ(overdue[2].kind, Kind::reply);
    EXPECT_EQ(overdue[3].kind, Kind::answer);
}

TEST(AgingArbiter, LooksAgainWhenTheOldestCanBeOverdue) {
    AgingArbiter arbiter;
    EXPECT_FALSE(arbiter.due(patience - 1));
    EXPECT_TRUE(arbiter.due(patience));
    AgingArbiter::Look look(arbiter, patience);
    look.add(3 * epoch + 5, Kind::ray, 0);
    look.add(4 * epoch, Kind::answer, 0);
    EXPECT_TRUE(look.finish().empty());
    const Cycle next = patience + 4 * epoch;  // the first epoch after 3 epochs, 5 cycles and the patience
    EXPECT_FALSE(arbiter.due(next - 1));
    EXPECT_TRUE(arbiter.due(next));
}

TEST(AgingArbiter, WaitsForWhatIsParkedUntilItMayMove) {
    AgingArbiter arbiter;
    constexpr Cycle now = 3 * patience;
    AgingArbiter::Look look(arbiter, now);
    look.add(5, Kind::answer, 2, 1U << 14, true);
    EXPECT_TRUE(look.finish().empty());
    EXPECT_FALSE(arbiter.due(now + 1));
    arbiter.unparked(1U << 13, now + 1);
    EXPECT_FALSE(arbiter.due(now + 1)) << "another one";
    arbiter.unparked(1U << 14, now + 2);
    EXPECT_TRUE(arbiter.due(now + 2));
}

TEST(AgingArbiter, LooksAtANewHeadWhenTheNextEpochBegins) {
    AgingArbiter arbiter;
    AgingArbiter::Look(arbiter, patience).finish();
    arbiter.new_head(patience + 3);
    EXPECT_FALSE(arbiter.due(patience + epoch - 1));
    EXPECT_TRUE(arbiter.due(patience + epoch));
}

}  // namespace
}  // namespace raycell
