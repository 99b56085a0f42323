// The router without a cell: two links out, with cycles set by hand.
#include "cells/units/router.hpp"

#include "units.hpp"

namespace raycell {
namespace {

struct Source : Client {
    void activate() override {}
    std::uint32_t& room_made() { return room_made_; }
};

struct Outputs {
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    Link east{scheduler, 1, 1};
    Link south{scheduler, 1, 1};
    Source source;
    Router router;
    RayPacket packet;
    Wakeup wakeup;
    Outputs() {
        east.connect_source(source);
        south.connect_source(source);
        router.connect(Side::east, east);
        router.connect(Side::south, south);
        router.elaborate();
    }
    Link::Room ask(Side side, std::uint32_t bits, Cycle now) {
        scheduler.set_now(now);
        return router.ask(side, 0, bits, wakeup);
    }
};

TEST(Router, SendsAnAnswerAlongXAndThenAlongY) {
    Answer answer;
    answer.home_x = 5;
    answer.home_y = 2;
    EXPECT_EQ(Router::way_home(answer, 3, 9), Side::east);
    EXPECT_EQ(Router::way_home(answer, 7, 2), Side::west);
    EXPECT_EQ(Router::way_home(answer, 5, 1), Side::south);
    EXPECT_EQ(Router::way_home(answer, 5, 4), Side::north);
}

TEST(Router, RunsAgainWhenTheWiresAreFree) {
    Outputs o;
    Link deep(o.scheduler, 1, 2);
    o.router.connect(Side::west, deep);
    EXPECT_EQ(o.ask(Side::west, 1, 10), Link::Room::free);
    o.router.link(Side::west)->send(0, Message(&o.packet), 5);
    EXPECT_EQ(o.ask(Side::west, 1, 12), Link::Room::wires_busy);
    EXPECT_EQ(o.wakeup.next, 15u);
    EXPECT_EQ(o.router.parked(), 0u);
    EXPECT_EQ(o.ask(Side::west, 1, 15), Link::Room::free);
}

TEST(Router, ParksWhoFindsNoRoomUntilThereIsSome) {
    Outputs o;
    ASSERT_EQ(o.ask(Side::east, 1, 10), Link::Room::free);
    o.router.link(Side::east)->send(0, Message(&o.packet), 1);
    EXPECT_EQ(o.ask(Side::east, 4, 20), Link::Room::full);
    EXPECT_EQ(o.ask(Side::east, 32, 20), Link::Room::full);
    EXPECT_EQ(o.router.parked(), 36u);
    EXPECT_EQ(o.wakeup.next, never) << "nobody asks again before there is room";
    o.scheduler.set_now(30);
    o.east.pop(0);
    EXPECT_EQ(o.source.room_made(), 1U << unsigned(Side::east));
    EXPECT_EQ(o.router.unpark(o.source.room_made()), 36u);
    EXPECT_EQ(o.router.parked(), 0u);
    EXPECT_EQ(o.source.room_made(), 0u);
    EXPECT_EQ(o.ask(Side::east, 4, 31), Link::Room::free);
}

TEST(Router, LetsThoseWaitWhoAreParkedOnAnotherOutput) {
    Outputs o;
    for (const Side side : {Side::east, Side::south}) {
        ASSERT_EQ(o.ask(side, 0, 10), Link::Room::free);
        o.router.link(side)->send(0, Message(&o.packet), 1);
    }
    o.ask(Side::east, 4, 20);
    o.ask(Side::south, 8, 20);
    o.scheduler.set_now(30);
    o.east.pop(0);
    EXPECT_EQ(o.router.unpark(o.source.room_made()), 4u);
    EXPECT_EQ(o.router.parked(), 8u);
}

}  // namespace
}  // namespace raycell
