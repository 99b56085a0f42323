// A load message in the loading unit, without a cell.
#include "cells/units/loading_unit.hpp"

#include "units.hpp"

namespace raycell {
namespace {

/// A link that holds one message, with cycles set by hand.
struct Loads {
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    Link link{scheduler, 1, 1};
    CostTable costs;
    LoadingUnits unit{1};
    LoadItem item;
    LoadItem* work(int x, Cycle now, Wakeup& wakeup) {
        scheduler.set_now(now);
        return unit.work(link, x, costs, now, wakeup);
    }
};

/// Expects the cycles that a span at column 4 takes in a cell of column x.
void expect_work(int x, std::uint32_t CostTable::*cycles) {
    Loads loads;
    loads.item.kind = LoadItem::Kind::span;
    loads.item.span.x = 4;
    loads.item.span.last = 9;
    loads.link.send(0, Message(&loads.item), 3);
    Wakeup wakeup;
    EXPECT_EQ(loads.work(x, 2, wakeup), nullptr) << "still on the wires";
    EXPECT_EQ(wakeup.next, never);
    EXPECT_EQ(loads.work(x, 3, wakeup), nullptr);
    const Cycle over = 3 + loads.costs.*cycles;
    EXPECT_EQ(wakeup.next, over);
    EXPECT_EQ(loads.work(x, over, wakeup), &loads.item);
    EXPECT_EQ(loads.work(x, over + 7, wakeup), &loads.item) << "until it can go on";
    loads.unit.finish();
    EXPECT_EQ(loads.unit.item(), nullptr);
}

TEST(LoadingUnit, MovesASpanThatHasComeToItsColumnOnWithoutItsVoxel) {
    expect_work(4, &CostTable::load_advance);
}

TEST(LoadingUnit, PassesASpanOnThatHasNotComeYet) { expect_work(5, &CostTable::load_forward); }

TEST(LoadingUnit, MakesTheVoxelsOfTheSpansThatItKeepsOneAfterTheOther) {
    LoadingUnits unit(1);
    Wakeup wakeup;
    EXPECT_EQ(unit.kept(100, 7), 0);
    unit.keep(100, 0, 10);
    EXPECT_EQ(unit.made(), 110u);
    unit.keep(100, 0, 30);
    EXPECT_EQ(unit.made(), 210u);
    EXPECT_EQ(unit.kept(100, 30), 2);
    EXPECT_EQ(unit.kept(100, 109), 2);
    EXPECT_EQ(unit.kept(100, 110), 1);
    EXPECT_EQ(unit.kept(100, 210), 0);
    unit.keep(100, 0, 500);
    EXPECT_EQ(unit.made(), 600u) << "it was idle";
    EXPECT_EQ(wakeup.next, never);
}

TEST(LoadingUnit, KeepsNoMoreSpansThanItMayAndAsksToBeWokenWhenOneIsDone) {
    LoadingUnits unit(1);
    Wakeup wakeup;
    unit.keep(100, 0, 10);
    unit.keep(100, 0, 30);
    EXPECT_TRUE(unit.has_room(3, 100, 40, wakeup));
    EXPECT_TRUE(unit.has_room(0, 100, 40, wakeup)) << "no limit";
    EXPECT_EQ(wakeup.next, never);
    EXPECT_FALSE(unit.has_room(2, 100, 40, wakeup));
    EXPECT_EQ(wakeup.next, 110u);
    EXPECT_TRUE(unit.has_room(2, 100, 110, wakeup));
    Wakeup later;
    EXPECT_FALSE(unit.has_room(1, 100, 110, later));
    EXPECT_EQ(later.next, 210u);
}

TEST(LoadingUnit, SharesTheSpansOutBetweenItsUnits) {
    LoadingUnits unit(2);
    unit.keep(100, 0, 10);
    unit.keep(100, 0, 30);
    EXPECT_EQ(unit.made(), 130u) << "at the same time";
    unit.keep(100, 0, 40);
    EXPECT_EQ(unit.made(), 210u) << "by the one that is free first";
    EXPECT_EQ(unit.kept(100, 40), 3);
    EXPECT_EQ(unit.to_make(40), 170u + 90u);
    Wakeup wakeup;
    EXPECT_FALSE(unit.has_room(3, 100, 40, wakeup));
    EXPECT_EQ(wakeup.next, 110u);
    EXPECT_EQ(unit.kept(100, 110), 2);
    EXPECT_EQ(unit.kept(100, 130), 1);
    EXPECT_EQ(unit.kept(100, 210), 0);
    unit.keep(100, 0, 500);
    unit.keep(100, 0, 500);
    EXPECT_EQ(unit.made(), 600u) << "both were idle";
}

TEST(LoadingUnit, PutsItsVoxelsInOrderOneAfterTheOtherOnceTheyAreMade) {
    LoadingUnits unit(2);
    unit.keep(100, 30, 10);
    EXPECT_EQ(unit.made(), 140u);
    unit.keep(100, 20, 10);
    EXPECT_EQ(unit.made(), 160u) << "both are made in cycle 110";
    unit.keep(100, 5, 10);
    EXPECT_EQ(unit.made(), 215u);
    unit.keep(100, 0, 10);
    EXPECT_EQ(unit.made(), 215u) << "nothing came of this one";
    EXPECT_EQ(unit.kept(100, 109), 4) << "its place is free when it is made";
    EXPECT_EQ(unit.kept(100, 210), 0);
    unit.close();
    Wakeup wakeup;
    EXPECT_FALSE(unit.closes(214, wakeup));
    EXPECT_EQ(wakeup.next, 215u);
    EXPECT_TRUE(unit.closes(215, wakeup));
}

TEST(LoadingUnit, IsLoadedOnceWhenTheMarkHasPassedAndTheLastVoxelIsMade) {
    LoadingUnits unit(1);
    Wakeup wakeup;
    EXPECT_FALSE(unit.closes(5, wakeup)) << "no mark yet";
    unit.keep(100, 0, 10);
    unit.close();
    EXPECT_FALSE(unit.closes(20, wakeup));
    EXPECT_EQ(wakeup.next, 110u);
    EXPECT_TRUE(unit.closes(110, wakeup));
    EXPECT_FALSE(unit.closes(111, wakeup));
}

TEST(LoadingUnit, EndsASpanAtItsLastColumnAndWhatIsBroadcastAtTheRowsEnd) {
    LoadItem span;
    span.kind = LoadItem::Kind::span;
    span.span.last = 5;
    EXPECT_FALSE(LoadingUnits::ends_at(span, 4, 8));
    EXPECT_TRUE(LoadingUnits::ends_at(span, 5, 8));
    LoadItem features;
    features.kind = LoadItem::Kind::features;
    EXPECT_FALSE(LoadingUnits::ends_at(features, 5, 8));
    EXPECT_TRUE(LoadingUnits::ends_at(features, 7, 8));
}

}  // namespace
}  // namespace raycell
