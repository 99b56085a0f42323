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
        return TraversalUnit::test(packet, {unit.store, {}, *unit.context, classes, x, 1}, unit.costs);
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

TEST(TraversalUnit, KeepsARayInTestUntilItsTimeIsOver) {
    Test1 test;
    TraversalUnit unit;
    EXPECT_EQ(unit.packet(), nullptr);
    unit.start(test.packet, 3, 50);
    EXPECT_EQ(test.packet.stage, RayPacket::Stage::in_test);
    Wakeup wakeup;
    EXPECT_FALSE(unit.finish(49, wakeup));
    EXPECT_EQ(wakeup.next, 50u);
    EXPECT_EQ(unit.packet(), &test.packet);
    EXPECT_TRUE(unit.finish(50, wakeup));
    EXPECT_EQ(test.packet.stage, RayPacket::Stage::decided);
    EXPECT_EQ(test.packet.decided, 50u);
    EXPECT_EQ(unit.packet(), nullptr);
}

TEST(TraversalUnit, LooksForTheNextRayBehindTheOneItTestedLast) {
    Test1 test;
    TraversalUnit unit;
    EXPECT_EQ(unit.next(), 0u);
    unit.start(test.packet, 3, 50);
    EXPECT_EQ(unit.next(), 4u);
    EXPECT_EQ(unit.place(), 3u);
}

}  // namespace
}  // namespace raycell
