// The slots of the ray store: which generations get one, and whose release lets another ray in.
#include "cells/units/ray_store.hpp"

#include <gtest/gtest.h>

namespace raycell {
namespace {

/// Number of rays of a generation that get a slot, one after the other.
int takes(RayStore& store, int generation) {
    int count = 0;
    while (store.allocate(generation)) ++count;
    return count;
}

TEST(RayStore, KeepsWithReservedOneSlotForEachGenerationAndSharesTheRest) {
    RayStore store(6, 4, Slots::reserved);  // two slots are free for all
    EXPECT_EQ(takes(store, 0), 3);
    for (const int generation : {1, 2, 3}) {
        EXPECT_TRUE(store.has_room(generation));
        EXPECT_EQ(takes(store, generation), 1) << generation;
    }
    EXPECT_EQ(store.used(), 6);
    EXPECT_EQ(store.peak(), 6);
}

TEST(RayStore, LetsTheDeepestGenerationsShareTheLastSlotWhereThereAreTooFew) {
    RayStore store(2, 4, Slots::reserved);
    EXPECT_EQ(takes(store, 3), 1);
    EXPECT_FALSE(store.has_room(2)) << "they share it";
    EXPECT_EQ(takes(store, 0), 1);
}

TEST(RayStore, LeavesWithNestedOneForEachDeeperGenerationWhichMayTakeAll) {
    RayStore deep(6, 4, Slots::nested);
    EXPECT_EQ(takes(deep, 3), 6);
    RayStore store(6, 4, Slots::nested);
    EXPECT_EQ(takes(store, 0), 3);
    EXPECT_EQ(takes(store, 1), 1);
    EXPECT_EQ(takes(store, 2), 1);
    EXPECT_EQ(takes(store, 3), 1);
}

TEST(RayStore, GivesWithFreeToWhoeverComes) {
    RayStore store(3, 4, Slots::free);
    EXPECT_EQ(takes(store, 0), 3);
    EXPECT_FALSE(store.has_room(3));
    EXPECT_TRUE(store.would_help(0, 3));
}

TEST(RayStore, KnowsWhoseSlotWouldLetAnotherIn) {
    RayStore store(5, 4, Slots::reserved);  // one slot is free for all
    ASSERT_EQ(takes(store, 0), 2);
    ASSERT_EQ(takes(store, 1), 1);
    EXPECT_TRUE(store.would_help(0, 1)) << "a borrowed one";
    EXPECT_TRUE(store.would_help(1, 1)) << "its own generation's";
    ASSERT_EQ(takes(store, 2), 1);
    EXPECT_FALSE(store.would_help(2, 1)) << "the only one of another";
}

TEST(RayStore, GivesASlotBackEmptyAndFirst) {
    RayStore store(3, 1, Slots::free);
    const auto first = store.allocate(0);
    const auto second = store.allocate(0);
    ASSERT_TRUE(first && second);
    store[*first].awaited = 5;
    store[*first].state = Slot::State::waiting;
    store[*second].state = Slot::State::waiting;
    store[*second].since = 10;
    EXPECT_EQ(store.waiting_cycles(30), 30u + 20u);
    store.release(*first, 0);
    EXPECT_EQ(store.used(), 1);
    EXPECT_EQ(store.waiting_cycles(30), 20u);
    EXPECT_EQ(store.allocate(0), first);
    EXPECT_EQ(store[*first].awaited, 0u);
    EXPECT_EQ(store.touched(), 2u);
}

}  // namespace
}  // namespace raycell
