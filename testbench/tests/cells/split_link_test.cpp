// A link in halves against a whole link: neither end can tell the difference.
#include "cells/channels/split_link.hpp"

#include <algorithm>
#include <random>

#include "elaboration.hpp"
#include "pipeline/ranks/rank_exchange.hpp"

namespace raycell {
namespace {

using Event = std::tuple<Cycle, char, std::uint64_t>;  ///< cycle, what, ray

/// A sender and a reader of two classes, and the events they saw. They pause at random, but in the same
/// cycles for the same seed.
class Ends {
  public:
    Ends(const std::string& name, Scheduler& scheduler, LinkOut& out, LinkIn& in, MessagePools& from,
         MessagePools& to, std::uint64_t seed)
        : sender((name + "_sender").c_str(), scheduler,
                 [&, this](Cycle now) { return send(out, from, now); }),
          reader((name + "_reader").c_str(), scheduler, [&, this](Cycle now) { return read(in, to, now); }),
          sends_(seed),
          reads_(seed + 1) {}

    Actor sender;
    Actor reader;
    std::vector<Event> events;

  private:
    static constexpr std::uint64_t rays = 400;

    Cycle send(LinkOut& out, MessagePools& pools, Cycle now) {
        Cycle retry = never;
        if (next_ == rays) return never;
        const int index = int(next_ % 2);
        if (!out.can_send(index, retry)) return retry;
        RayPacket* packet = pools.rays.take();
        packet->ray.id = next_;
        packet->ray.position = {0.5, 0.25, double(next_)};
        packet->launched = now;
        packet->hops = std::uint32_t(next_ * 3);
        out.send(index, Message(packet), 1 + int(sends_() % 4));
        events.emplace_back(now, 's', next_++);
        return now + 1 + (sends_() % 3 == 0 ? sends_() % 20 : 0);
    }
    Cycle read(LinkIn& in, MessagePools& pools, Cycle now) {
        for (int index = 0; index < 2; ++index) {
            const Message message = in.front(index);
            if (message.kind != Message::Kind::ray || now < rested_) continue;
            const RayPacket& packet = *message.ray;
            EXPECT_EQ(packet.ray.position.z, double(packet.ray.id));
            EXPECT_EQ(packet.hops, packet.ray.id * 3);
            EXPECT_LT(packet.launched, now);
            events.emplace_back(now, 'r', packet.ray.id);
            pools.rays.give_back(message.ray);
            in.pop(index);
            rested_ = now + reads_() % 12;
        }
        return in.occupancy(0) + in.occupancy(1) > 0 ? std::max(rested_, now + 1) : never;
    }

    std::mt19937_64 sends_;
    std::mt19937_64 reads_;
    std::uint64_t next_ = 0;
    Cycle rested_ = 0;
};

/// The exchange at the end of every cycle: each half learns what the other did.
struct Meeting {
    Scheduler* scheduler;
    SplitLinks* here;
    SplitLinks* there;
    MessagePools* here_pools;
    MessagePools* there_pools;

    static Cycle meet(void* self, Cycle) {
        auto& m = *static_cast<Meeting*>(self);
        const Bytes to_there = m.here->out();
        const Bytes to_here = m.there->out();
        m.here->clear(*m.here_pools);
        m.there->clear(*m.there_pools);
        m.there->deliver(to_there.data(), to_there.size(), *m.there_pools);
        m.here->deliver(to_here.data(), to_here.size(), *m.here_pools);
        return m.scheduler->next();
    }
};

void expect_like_whole(int depth, double stall) {
    expect_first_elaboration();
    const std::uint64_t seed = 20;
    Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    MessagePools pools;
    MessagePools far_pools;
    Link whole(scheduler, 2, depth);
    SplitLinks here;
    SplitLinks there;
    Link& source = here.make_source(scheduler, 2, depth);
    Link& sink = there.make_sink(scheduler, 2, depth);
    if (stall > 0) {
        whole.set_stall(stall, 5, 7);
        source.set_stall(stall, 5, 7);
    }
    Ends one("one", scheduler, whole, whole, pools, pools, seed);
    Ends two("two", scheduler, source, sink, pools, far_pools, seed);
    whole.connect_source(one.sender);
    whole.connect_sink(one.reader);
    source.connect_source(two.sender);
    sink.connect_sink(two.reader);
    Meeting meeting{&scheduler, &here, &there, &pools, &far_pools};
    scheduler.set_meeting(&Meeting::meet, &meeting);
    scheduler.wake(one.sender, 1);
    scheduler.wake(two.sender, 1);
    scheduler.begin();
    sc_core::sc_start();

    for (Ends* ends : {&one, &two})
        std::sort(ends->events.begin(), ends->events.end());  // ends run in any order
    EXPECT_EQ(one.events.size(), 800u) << "400 rays, sent and read";
    EXPECT_EQ(one.events, two.events) << "seed " << seed;
    for (int index = 0; index < 2; ++index) {
        const auto a = whole.statistics(index);
        const auto b = sink.statistics(index);
        EXPECT_EQ(a.sent, b.sent);
        EXPECT_EQ(a.delivered, b.delivered);
        EXPECT_EQ(a.peak, b.peak);
        EXPECT_EQ(a.occupied_cycles, b.occupied_cycles);
        EXPECT_EQ(source.occupancy(index), 0);
    }
    EXPECT_EQ(whole.busy_cycles(), sink.busy_cycles());
    EXPECT_EQ(pools.rays.in_use(), 0u) << "what went over is the other rank's";
    EXPECT_EQ(far_pools.rays.in_use(), 0u);
}

TEST(SplitLink, OfDepthOneIsLikeAWholeOne) { expect_like_whole(1, 0); }
TEST(SplitLink, OfDepthThreeIsLikeAWholeOne) { expect_like_whole(3, 0); }
TEST(SplitLink, WithRandomStallsIsLikeAWholeOne) { expect_like_whole(2, 0.4); }

TEST(SplitLink, RefusesRecordsThatNoRankCanHaveSent) {
    expect_first_elaboration();
    Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    MessagePools pools;
    SplitLinks split;
    split.make_source(scheduler, 1, 1);
    const auto deliver = [&](std::vector<std::uint32_t> words, std::size_t size) {
        split.deliver(reinterpret_cast<const std::byte*>(words.data()), size, pools);
    };
    EXPECT_THROW(deliver({1U << 8 | 1U}, 4), std::logic_error) << "there is no half 1";
    EXPECT_THROW(deliver({15U}, 4), std::logic_error) << "no such kind";
    EXPECT_THROW(deliver({2U}, 4), std::logic_error) << "a ray without the ray";
    EXPECT_THROW(deliver({1U}, 3), std::logic_error) << "not even a word";
}

TEST(TimedScheduler, GoesThroughCyclesThatOnlyOthersHaveWithoutWakingAnybody) {
    expect_first_elaboration();
    struct World {
        Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
        std::vector<Cycle> others = {2, 3, 7, 9, 12};
        std::vector<Cycle> watched;
        std::size_t next = 0;
        static Cycle meet(void* self, Cycle mine) {
            auto& w = *static_cast<World*>(self);
            while (w.next < w.others.size() && w.others[w.next] <= w.scheduler.now()) ++w.next;
            return std::min(mine, w.next < w.others.size() ? w.others[w.next] : never);
        }
        static bool watch(void* self, Cycle now) {
            static_cast<World*>(self)->watched.push_back(now);
            return true;
        }
    } world;
    std::vector<std::pair<Cycle, std::uint64_t>> ran;
    Actor actor("actor", world.scheduler, [&](Cycle now) {
        ran.emplace_back(now, sc_core::sc_time_stamp().value() / world.scheduler.period().value());
        return now == 4 ? Cycle(9) : never;
    });
    world.scheduler.set_meeting(&World::meet, &world);
    world.scheduler.set_watch(&World::watch, &world);
    world.scheduler.wake(actor, 4);
    world.scheduler.begin();
    sc_core::sc_start();
    EXPECT_EQ(ran, (std::vector<std::pair<Cycle, std::uint64_t>>{{4, 4}, {9, 9}}))
        << "(cycle, SystemC's time)";
    EXPECT_EQ(world.watched, (std::vector<Cycle>{2, 3, 4, 7, 9, 12}));
    EXPECT_EQ(world.scheduler.now(), 12u);
}

TEST(Ranks, HaveEveryRowOnceAndNoneHasNone) {
    for (int height = 1; height < 80; ++height) {
        for (int count = 1; count <= height; ++count) {
            const std::vector<int> rows = even_bands(count, height);
            const int bands = int(rows.size()) - 1;
            ASSERT_EQ(bands % count, 0) << "all ranks have equally many";
            ASSERT_GE(bands, count);
            EXPECT_EQ(rows.front(), 0);
            EXPECT_EQ(rows.back(), height);
            for (std::size_t band = 0; band + 1 < rows.size(); ++band) {
                const int has = rows[band + 1] - rows[band];
                EXPECT_GT(has, 0) << count << " ranks, " << height << " rows";
                EXPECT_LE(has, (height + bands - 1) / bands) << count << " ranks, " << height << " rows";
            }
        }
        EXPECT_THROW(even_bands(height + 1, height), std::invalid_argument);
    }
}

}  // namespace
}  // namespace raycell
