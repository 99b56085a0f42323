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
    LoadingUnit unit;
    LoadItem item;
    LoadItem* work(int x, Cycle now, Wakeup& wakeup) {
        scheduler.set_now(now);
        return unit.work(link, x, costs, HitTest::mask, now, wakeup);
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

TEST(LoadingUnit, MakesTheVoxelOfASpanThatHasComeToItsColumn) { expect_work(4, &CostTable::load_mask); }

TEST(LoadingUnit, PassesASpanOnThatHasNotComeYet) { expect_work(5, &CostTable::load_forward); }

TEST(LoadingUnit, EndsASpanAtItsLastColumnAndWhatIsBroadcastAtTheRowsEnd) {
    LoadItem span;
    span.kind = LoadItem::Kind::span;
    span.span.last = 5;
    EXPECT_FALSE(LoadingUnit::ends_at(span, 4, 8));
    EXPECT_TRUE(LoadingUnit::ends_at(span, 5, 8));
    LoadItem features;
    features.kind = LoadItem::Kind::features;
    EXPECT_FALSE(LoadingUnit::ends_at(features, 5, 8));
    EXPECT_TRUE(LoadingUnit::ends_at(features, 7, 8));
}

}  // namespace
}  // namespace raycell
