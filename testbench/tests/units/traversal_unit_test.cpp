// The test of one ray in the traversal unit, without a cell.
#include "cells/units/traversal_unit.hpp"

#include "units.hpp"

namespace raycell {
namespace {

struct Test1 {
    UnitContext unit;
    BufferClasses classes = buffer_classes(Networks::half);
    RayPacket packet;
    Test1() {
        unit.store = CellStore();
        packet.ray.position = {0.5, 0.5, 5};
        set_direction(packet.ray, {1, 0, 0}, unit.context->arithmetic);
    }
    std::uint32_t run(int x) {
        return TraversalUnits::test(packet, {unit.store, {}, *unit.context, classes, x, 1}, unit.costs);
    }
};

TEST(TraversalUnit, FindsTheWayAndTheNeedOfARayInAnEmptyCell) {
    Test1 test;
    EXPECT_EQ(test.run(1), test.unit.costs.walk_step);
    EXPECT_EQ(test.packet.visit.event, Visit::Event::forward);
    EXPECT_EQ(test.packet.need.kind, Need::Kind::output);
    EXPECT_EQ(test.packet.need.side, Side::east);
    test.run(2);
    EXPECT_EQ(test.packet.need.kind, Need::Kind::response) << "over the border, with nothing beyond";
}

/// The places of the tests that are over in cycle `now`.
std::vector<std::uint32_t> finished(TraversalUnits& units, Cycle now, Wakeup& wakeup) {
    std::vector<std::uint32_t> places;
    units.finish(now, wakeup, [&](std::uint32_t place) { places.push_back(place); });
    return places;
}

TEST(TraversalUnit, KeepsARayInTestUntilItsTimeIsOver) {
    Test1 test;
    TraversalUnits units(1);
    EXPECT_TRUE(units.idle());
    units.start(test.packet, 3, 50);
    EXPECT_EQ(test.packet.stage, RayPacket::Stage::in_test);
    EXPECT_FALSE(units.free());
    Wakeup wakeup;
    EXPECT_TRUE(finished(units, 49, wakeup).empty());
    EXPECT_EQ(wakeup.next, 50u);
    EXPECT_EQ(units.packet(0), &test.packet);
    EXPECT_EQ(finished(units, 50, wakeup), std::vector<std::uint32_t>{3});
    EXPECT_EQ(test.packet.stage, RayPacket::Stage::decided);
    EXPECT_EQ(test.packet.decided, 50u);
    EXPECT_TRUE(units.idle());
}

TEST(TraversalUnit, LooksForTheNextRayBehindTheOneItTestedLast) {
    Test1 test;
    TraversalUnits units(1);
    EXPECT_EQ(units.next(), 0u);
    units.start(test.packet, 3, 50);
    EXPECT_EQ(units.next(), 4u);
    EXPECT_EQ(units.place(units.last()), 3u);
}

TEST(TraversalUnit, TestsAsManyRaysAtATimeAsThereAreUnits) {
    Test1 test;
    RayPacket second = test.packet;
    RayPacket third = test.packet;
    TraversalUnits units(2);
    units.start(test.packet, 3, 50);
    EXPECT_TRUE(units.free());
    units.start(second, 0, 40);
    EXPECT_FALSE(units.free());
    Wakeup wakeup;
    EXPECT_EQ(finished(units, 40, wakeup), std::vector<std::uint32_t>{0}) << "the later test was shorter";
    EXPECT_EQ(wakeup.next, 50u);
    units.start(third, 1, 50);
    EXPECT_EQ(units.packet(units.last()), &third);
    EXPECT_EQ(units.packet(1), &third) << "the unit that was free";
    EXPECT_EQ(finished(units, 50, wakeup), (std::vector<std::uint32_t>{3, 1}));
    EXPECT_TRUE(units.idle());
}

}  // namespace
}  // namespace raycell
