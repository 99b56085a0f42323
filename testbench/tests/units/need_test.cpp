// What a tested ray needs next: each case once.
#include "units.hpp"

namespace raycell {
namespace {

struct NeedOf : ::testing::Test {
    UnitContext unit;
    BufferClasses classes = buffer_classes(Networks::half);
    Ray ray;
    Visit visit;

    NeedOf() { set_direction(ray, {1, 0, 0}, unit.context->arithmetic); }
    Need at(int x, int y) { return need_of(ray, visit, unit.store, x, y, classes, *unit.context); }
    void goes(Side side) {
        visit.event = Visit::Event::forward;
        visit.crossing.side = side;
    }
};

TEST_F(NeedOf, ARayThatGoesOnIsAnOutputAndTheClassOfItsBuffer) {
    goes(Side::north);
    const Need east = at(1, 1);
    EXPECT_EQ(east.kind, Need::Kind::output);
    EXPECT_EQ(east.side, Side::north);
    EXPECT_EQ(int(east.index), 0);
    EXPECT_FALSE(east.leaves);
    set_direction(ray, {-1, 0, 0}, unit.context->arithmetic);
    EXPECT_EQ(int(at(1, 1).index), 1) << "westwards";
}

TEST_F(NeedOf, ARayOverTheBorderIsAnOutputWhereTheSceneGoesOnBeyond) {
    unit.scene.beyond[face_right] = true;
    unit.settings.exterior = ExteriorMode::host;
    goes(Side::east);
    EXPECT_EQ(at(2, 1).kind, Need::Kind::output);
    EXPECT_TRUE(at(2, 1).leaves);
    EXPECT_FALSE(at(1, 1).leaves);
}

TEST_F(NeedOf, ARayOverTheBorderWithNothingBeyondIsAnAnswer) {
    goes(Side::east);
    const Need primary = at(2, 1);
    EXPECT_EQ(primary.kind, Need::Kind::response);
    EXPECT_EQ(primary.answer, Answer::Kind::intensity);
    EXPECT_TRUE(primary.lost);
    ray.kind = RayKind::shadow;
    EXPECT_EQ(at(2, 1).answer, Answer::Kind::lit);
    ray.kind = RayKind::precast;
    EXPECT_EQ(at(2, 1).kind, Need::Kind::nothing) << "no news is good news";
    EXPECT_TRUE(at(2, 1).lost);
}

TEST_F(NeedOf, AHitIsASlotOnlyIfItMayHaveToWait) {
    visit.event = Visit::Event::hit;
    visit.hit.voxel = 0;
    EXPECT_EQ(at(1, 1).kind, Need::Kind::shading_unit);
    visit.hit.voxel = 1;
    EXPECT_EQ(at(1, 1).kind, Need::Kind::slot);
    ray.generation = std::uint8_t(unit.settings.max_depth);
    EXPECT_EQ(at(1, 1).kind, Need::Kind::shading_unit) << "a mirror's last generation has no child";
}

TEST_F(NeedOf, AShadowRayIsTheAnswerThatItFound) {
    ray.kind = RayKind::shadow;
    visit.event = Visit::Event::hit;
    EXPECT_EQ(at(1, 1).answer, Answer::Kind::blocked);
    visit.event = Visit::Event::reaches_source;
    EXPECT_EQ(at(1, 1).answer, Answer::Kind::lit);
    EXPECT_EQ(at(1, 1).kind, Need::Kind::response);
    EXPECT_FALSE(at(1, 1).lost);
    ray.kind = RayKind::precast;
    EXPECT_EQ(at(1, 1).kind, Need::Kind::nothing);
    visit.event = Visit::Event::hit;
    EXPECT_EQ(at(1, 1).kind, Need::Kind::response) << "bad news is told";
}

TEST_F(NeedOf, ARayThatLeavesTheCubeWalksToTheBorderOrEnds) {
    visit.event = Visit::Event::leaves_cube;
    set_direction(ray, {0, 0, 1}, unit.context->arithmetic);
    EXPECT_EQ(at(1, 1).kind, Need::Kind::response);
    EXPECT_TRUE(at(1, 1).lost);
    unit.scene.beyond[face_back] = true;
    unit.settings.exterior = ExteriorMode::host;
    EXPECT_EQ(at(1, 1).kind, Need::Kind::border_walk);
}

}  // namespace
}  // namespace raycell
