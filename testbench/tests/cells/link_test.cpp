// The channel between two cells, cycle by cycle.
#include <deque>
#include <set>

#include "elaboration.hpp"

namespace raycell {
namespace {

struct Bench {
    Bench() { expect_first_elaboration(); }
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    std::deque<Answer> answers;
    Message message(std::uint64_t id) {
        answers.emplace_back();
        answers.back().id = id;
        return Message(&answers.back());
    }
};

TEST(Link, ShowsAMessageAfterItsLinkCyclesAndNotBefore) {
    Bench bench;
    Link link(bench.scheduler, 1, 1);
    std::vector<Cycle> seen;
    std::vector<Cycle> woken;
    Actor sender("sender", bench.scheduler, [&](Cycle) {
        link.send(0, bench.message(1), 5);
        return never;
    });
    Actor watcher("watcher", bench.scheduler, [&](Cycle now) {
        if (link.front(0).kind != Message::Kind::none) seen.push_back(now);
        return now < 12 ? now + 1 : never;
    });
    Actor sink("sink", bench.scheduler, [&](Cycle now) {
        woken.push_back(now);
        return never;
    });
    link.connect_sink(sink);
    bench.scheduler.wake(watcher, 1);
    bench.scheduler.wake(sender, 3);
    sc_core::sc_start();
    EXPECT_EQ(seen, (std::vector<Cycle>{8, 9, 10, 11, 12}));
    EXPECT_EQ(woken, std::vector<Cycle>{8});
    EXPECT_EQ(link.arrival(0), 8u);
    EXPECT_EQ(link.occupancy(0), 1);
}

TEST(Link, OfDepthOneTakesNothingUntilTheCycleAfterItsMessageIsRead) {
    Bench bench;
    Link link(bench.scheduler, 1, 1);
    std::vector<Cycle> sent;
    std::vector<Cycle> tried;
    Actor sender("sender", bench.scheduler, [&](Cycle now) {
        tried.push_back(now);
        Cycle retry = never;
        if (!link.can_send(0, retry)) return retry;
        sent.push_back(now);
        link.send(0, bench.message(now), 2);
        return sent.size() < 3 ? now + 1 : never;
    });
    Actor reader("reader", bench.scheduler, [&](Cycle now) {
        link.pop(0);
        return now < 20 ? Cycle(20) : never;
    });
    link.connect_source(sender);
    bench.scheduler.wake(sender, 1);
    bench.scheduler.wake(reader, 10);
    sc_core::sc_start();
    EXPECT_EQ(sent, (std::vector<Cycle>{1, 11, 21}));
    // When full, the sender does not poll: it is woken in the cycle after room was made.
    EXPECT_EQ(tried, (std::vector<Cycle>{1, 2, 11, 12, 21}));
    EXPECT_EQ(link.statistics(0).peak, 1);
    EXPECT_EQ(link.statistics(0).occupied_cycles, 9u + 9u);
}

TEST(Link, HasOneSetOfWiresForAllItsClasses) {
    Bench bench;
    Link link(bench.scheduler, 3, 4);
    std::vector<Cycle> sent;
    int next = 0;
    Actor sender("sender", bench.scheduler, [&](Cycle now) {
        Cycle retry = never;
        if (!link.can_send(next, retry)) {
            EXPECT_EQ(retry, sent.back() + 7);
            return retry;
        }
        sent.push_back(now);
        link.send(next, bench.message(now), 7);
        return ++next < 3 ? now + 1 : never;
    });
    bench.scheduler.wake(sender, 1);
    sc_core::sc_start();
    EXPECT_EQ(sent, (std::vector<Cycle>{1, 8, 15}));
    EXPECT_EQ(link.busy_cycles(), 14u) << "the third is only beginning";
    bench.scheduler.set_now(22);
    EXPECT_EQ(link.busy_cycles(), 21u);
}

TEST(Link, CountsPeakAndOccupancyOverTheTimeOfEachMessage) {
    Bench bench;
    Link link(bench.scheduler, 1, 3);
    Actor sender("sender", bench.scheduler, [&](Cycle now) {
        link.send(0, bench.message(now), 1);
        return now < 3 ? now + 1 : never;
    });
    Actor reader("reader", bench.scheduler, [&](Cycle now) {
        EXPECT_EQ(link.front(0).answer->id, now - 9);
        link.pop(0);
        return now < 12 ? now + 1 : never;
    });
    bench.scheduler.wake(sender, 1);
    bench.scheduler.wake(reader, 10);
    sc_core::sc_start();
    const Link::ClassStatistics& s = link.statistics(0);
    EXPECT_EQ(s.sent, 3u);
    EXPECT_EQ(s.delivered, 3u);
    EXPECT_EQ(s.peak, 3);
    EXPECT_EQ(s.occupied_cycles, 27u);  // sent in 1, 2, 3, read in 10, 11, 12
}

/// The same traffic over two links: on one the sender runs first in every cycle, on the other the receiver.
TEST(Link, DoesNotShowWhichEndRanFirst) {
    for (const std::uint64_t seed : property::seeds(1, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        Bench bench;
        property::Random random(seed);
        constexpr Cycle last = 3000;
        struct Plan {
            bool send, pop, classes;
            int cycles;
        };
        std::vector<Plan> plans;
        for (Cycle i = 0; i <= last; ++i)
            plans.push_back({random.chance(0.6), random.chance(0.5), random.chance(0.5), random.whole(1, 3)});
        struct Pair {
            std::unique_ptr<Link> link;
            std::vector<std::uint64_t> log;
            std::uint64_t next_id = 0;
            std::set<Cycle> told;  ///< cycles in which the sender may retry, by return value or by wake
        };
        std::deque<Pair> pairs;
        std::deque<std::unique_ptr<Actor>> actors;
        for (const int depth : {1, 2, 3, 5}) {
            for (const bool sender_first : {true, false}) {
                pairs.push_back({std::make_unique<Link>(bench.scheduler, 2, depth), {}, 0, {}});
                Pair& pair = pairs.back();
                const auto send = [&pair, &bench, &plans](Cycle now) {
                    const Plan& plan = plans[now];
                    Cycle retry = never;
                    if (!plan.send) return;
                    const bool can = pair.link->can_send(plan.classes, retry);
                    pair.log.push_back(now << 8 | (can ? 1 : 2));
                    if (!can && retry != never) pair.told.insert(retry);
                    if (can) pair.link->send(plan.classes, bench.message(pair.next_id++), plan.cycles);
                };
                const auto receive = [&pair, &plans](Cycle now) {
                    if (!plans[now].pop) return;
                    for (int index = 0; index < 2; ++index) {
                        const Message front = pair.link->front(index);
                        if (front.kind == Message::Kind::none) continue;
                        pair.log.push_back(now << 8 | 8);
                        pair.log.push_back(front.answer->id);
                        pair.link->pop(index);
                    }
                };
                // Log entries of one cycle are put in a fixed order, whichever end ran first.
                const std::string name = "pair_" + std::to_string(pairs.size());
                actors.push_back(
                    std::make_unique<Actor>(name.c_str(), bench.scheduler, [=, &pair](Cycle now) {
                        std::vector<std::uint64_t> before;
                        before.swap(pair.log);
                        std::vector<std::uint64_t> first, second;
                        sender_first ? send(now) : receive(now);
                        first.swap(pair.log);
                        sender_first ? receive(now) : send(now);
                        second.swap(pair.log);
                        pair.log.swap(before);
                        for (const auto* part :
                             {sender_first ? &first : &second, sender_first ? &second : &first}) {
                            pair.log.insert(pair.log.end(), part->begin(), part->end());
                        }
                        return now < last ? now + 1 : never;
                    }));
                bench.scheduler.wake(*actors.back(), 1);
                actors.push_back(
                    std::make_unique<Actor>((name + "_source").c_str(), bench.scheduler, [&pair](Cycle now) {
                        pair.told.insert(now);
                        return never;
                    }));
                pair.link->connect_source(*actors.back());
            }
        }
        sc_core::sc_start();
        for (std::size_t i = 0; i < pairs.size(); i += 2) {
            EXPECT_EQ(pairs[i].log, pairs[i + 1].log) << "depth " << pairs[i].link->depth();
            EXPECT_EQ(pairs[i].told, pairs[i + 1].told) << "depth " << pairs[i].link->depth();
            EXPECT_GT(pairs[i].next_id, 200u);
            for (int index = 0; index < 2; ++index) {
                const auto& a = pairs[i].link->statistics(index);
                const auto& b = pairs[i + 1].link->statistics(index);
                EXPECT_EQ(a.sent, b.sent);
                EXPECT_EQ(a.delivered, b.delivered);
                EXPECT_EQ(a.occupied_cycles, b.occupied_cycles);
                EXPECT_EQ(a.peak, b.peak) << "depth " << pairs[i].link->depth();
                EXPECT_LE(a.peak, pairs[i].link->depth());
            }
        }
    }
}

TEST(Link, KeepsTheOrderOfMessagesWhateverItsDepth) {
    for (const std::uint64_t seed : property::seeds(50, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        Bench bench;
        property::Random random(seed);
        std::deque<std::unique_ptr<Link>> links;
        std::deque<std::deque<std::uint64_t>> queues;
        for (const int depth : {1, 2, 3, 4, 7}) {
            links.push_back(std::make_unique<Link>(bench.scheduler, 1, depth));
            queues.emplace_back();
        }
        std::uint64_t id = 0;
        Actor both("both", bench.scheduler, [&](Cycle now) {
            for (std::size_t i = 0; i < links.size(); ++i) {
                Cycle retry = never;
                // Bursts fill and drain the buffers, so that the ring wraps round and grows at any position.
                const double eager = now / 50 % 2 ? 0.8 : 0.2;
                if (random.chance(eager) && links[i]->can_send(0, retry)) {
                    links[i]->send(0, bench.message(id), 1);
                    queues[i].push_back(id++);
                }
                EXPECT_EQ(links[i]->occupancy(0), int(queues[i].size()));
                EXPECT_LE(links[i]->occupancy(0), links[i]->depth());
                const Message front = links[i]->front(0);
                if (front.kind == Message::Kind::none || random.chance(eager)) continue;
                EXPECT_EQ(front.answer->id, queues[i].front());
                links[i]->pop(0);
                queues[i].pop_front();
            }
            return now < 5000 ? now + 1 : never;
        });
        bench.scheduler.wake(both, 1);
        sc_core::sc_start();
        EXPECT_GT(id, 5000u);
    }
}

}  // namespace
}  // namespace raycell
