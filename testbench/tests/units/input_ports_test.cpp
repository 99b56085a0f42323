// The input ports without a cell: links in, with cycles set by hand.
#include "cells/units/input_ports.hpp"

#include "units.hpp"

namespace raycell {
namespace {

struct Sink : Client {
    void activate() override {}
    std::uint32_t& pending() { return pending_; }
};

struct Ports {
    explicit Ports(Networks networks) : classes(buffer_classes(networks)) {
        for (int side = 0; side < side_count; ++side) {
            links.push_back(std::make_unique<Link>(scheduler, classes.count, 2));
            links.back()->connect_sink(sink);
            ports.connect(Side(side), *links.back());
        }
        ports.elaborate(classes);
    }
    Link& from(Side side) { return *links[std::size_t(side)]; }
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    BufferClasses classes;
    Sink sink;
    std::vector<std::unique_ptr<Link>> links;
    InputPorts ports;
};

TEST(InputPorts, HaveABufferOfRaysPerSideAndDirectionInHalves) {
    // A horizontal link carries rays of one class, a vertical link of both.
    EXPECT_EQ(Ports(Networks::half).ports.ray_inputs(), 6u);
}

TEST(InputPorts, ShowARayWhenItHasArrivedAndReadItOut) {
    Ports p(Networks::half);
    RayPacket first;
    RayPacket second;
    Link& south = p.from(Side::south);
    south.send(0, Message(&first), 3);
    const std::uint32_t bit = p.sink.pending();
    ASSERT_EQ(__builtin_popcount(bit), 1) << "one ray input holds something, on the wires as yet";
    EXPECT_EQ(p.ports.with_rays(bit), bit);
    const auto input = std::size_t(__builtin_ctz(bit));
    EXPECT_EQ(p.ports.side_of(input), std::size_t(Side::south));
    EXPECT_EQ(p.ports.ray(input, 2), nullptr);
    EXPECT_EQ(p.ports.ray(input, 3), &first);
    EXPECT_EQ(p.ports.head_since(input), 3u);
    p.scheduler.set_now(3);
    south.send(0, Message(&second), 3);
    bool more = false;
    EXPECT_EQ(p.ports.pop_ray(input, 8, more), 0u);
    EXPECT_TRUE(more);
    EXPECT_EQ(p.ports.ray(input, 8), &second);
    EXPECT_EQ(p.ports.head_since(input), 8u) << "it arrived in cycle 6, behind the other";
    EXPECT_EQ(p.ports.pop_ray(input, 9, more), bit) << "empty now";
    EXPECT_FALSE(more);
}

TEST(InputPorts, KeepAnswersApartBySide) {
    Ports p(Networks::split);
    Answer answer;
    p.from(Side::west).send(p.classes.answer, Message(&answer), 2);
    const auto west = std::size_t(Side::west);
    EXPECT_EQ(p.sink.pending(), InputPorts::answer_bit(west));
    EXPECT_EQ(p.ports.answer(west, 1), nullptr);
    EXPECT_EQ(p.ports.answer(west, 2), &answer);
    EXPECT_EQ(p.ports.answer_arrival(west), 2u);
    bool more = true;
    EXPECT_EQ(p.ports.pop_answer(west, 2, more), InputPorts::answer_bit(west));
    EXPECT_FALSE(more);
}

TEST(InputPorts, InOneBufferForAllShowARayOrAnAnswerWhicheverIsFirst) {
    Ports p(Networks::shared);
    Answer answer;
    RayPacket ray;
    p.from(Side::east).send(0, Message(&answer), 1);
    p.from(Side::east).send(0, Message(&ray), 1);
    const auto east = std::size_t(Side::east);
    EXPECT_EQ(p.ports.ray_inputs(), 4u);
    EXPECT_EQ(p.ports.answer(east, 5), &answer);
    EXPECT_EQ(p.ports.ray(0, 5), nullptr);
    bool more = false;
    EXPECT_EQ(p.ports.pop_answer(east, 5, more), 0u);
    EXPECT_TRUE(more);
    EXPECT_EQ(p.ports.answer(east, 5), nullptr);
    EXPECT_EQ(p.ports.ray(0, 5), &ray);
}

}  // namespace
}  // namespace raycell
