// The time wheel and the ray store: who is woken when, and who gets a slot.
#include <map>
#include <set>

#include "cells/units/ray_store.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

Scheduler& make_scheduler() {
    expect_first_elaboration();
    static Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    return scheduler;
}

TEST(TimedScheduler, WakesInOrderOncePerCycleNearAndFar) {
    for (const std::uint64_t seed : property::seeds(1, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        Scheduler& scheduler = make_scheduler();
        property::Random random(seed);
        constexpr int count = 20;
        std::vector<std::set<Cycle>> planned(count);
        std::vector<std::vector<Cycle>> woken(count);
        std::vector<Cycle> order;
        std::vector<std::unique_ptr<Actor>> actors;
        const auto delay = [&] {
            switch (random.whole(0, 3)) {
                case 0:
                    return random.whole(1, 3);
                case 1:
                    return random.whole(4090, 4100);  // about one turn of the wheel
                case 2:
                    return random.whole(1, 4095);
                default:
                    return random.whole(4096, 30000);
            }
        };
        for (int i = 0; i < count; ++i) {
            const std::string name = "actor_" + std::to_string(i);
            actors.push_back(std::make_unique<Actor>(name.c_str(), scheduler, [&, i](Cycle now) {
                woken[std::size_t(i)].push_back(now);
                order.push_back(now);
                if (now < 100000) {
                    for (int k = random.whole(0, 2); k > 0; --k) {  // wakes itself or others, sometimes twice
                        const int whom = random.whole(0, count - 1);
                        const Cycle when = now + Cycle(delay());
                        planned[std::size_t(whom)].insert(when);
                        scheduler.wake(*actors[std::size_t(whom)], when);
                        if (random.chance(0.2)) scheduler.wake(*actors[std::size_t(whom)], when);
                    }
                    const Cycle again = now + Cycle(delay());
                    planned[std::size_t(i)].insert(again);
                    return random.chance(0.5) || woken[std::size_t(i)].size() < 20
                               ? again
                               : (planned[std::size_t(i)].erase(again), never);
                }
                return never;
            }));
        }
        for (int i = 0; i < count; ++i) {
            planned[std::size_t(i)].insert(Cycle(i + 1));
            scheduler.wake(*actors[std::size_t(i)], Cycle(i + 1));
        }
        sc_core::sc_start();
        std::uint64_t activations = 0;
        for (std::size_t i = 0; i < count; ++i) {
            // `planned` may lack a cycle that another call had planned too, so the woken cycles are a
            // superset of it.
            const std::set<Cycle> got(woken[i].begin(), woken[i].end());
            EXPECT_EQ(got.size(), woken[i].size()) << "woken twice in a cycle";
            for (const Cycle cycle : planned[i])
                EXPECT_TRUE(got.count(cycle)) << "actor " << i << ", cycle " << cycle;
            activations += woken[i].size();
        }
        EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
        EXPECT_EQ(scheduler.activations(), activations);
        EXPECT_GT(activations, 500u);
        EXPECT_EQ(sc_core::sc_time_stamp().value(), scheduler.period().value() * scheduler.now());
        EXPECT_FALSE(scheduler.limit_reached());
    }
}

TEST(TimedScheduler, RunsNoCycleBeyondItsLimit) {
    Scheduler& scheduler = make_scheduler();
    std::vector<Cycle> woken;
    Actor actor("actor", scheduler, [&](Cycle now) {
        woken.push_back(now);
        return now + 10;
    });
    scheduler.set_limit(35);
    scheduler.wake(actor, 5);
    sc_core::sc_start();
    EXPECT_EQ(woken, (std::vector<Cycle>{5, 15, 25, 35}));
    EXPECT_TRUE(scheduler.limit_reached());
    EXPECT_EQ(scheduler.now(), 35u);
}

TEST(TimedScheduler, DoesNotReportALimitThatNobodyWouldHavePassed) {
    Scheduler& scheduler = make_scheduler();
    Actor actor("actor", scheduler, [&](Cycle now) { return now < 30 ? now + 10 : never; });
    scheduler.set_limit(35);
    scheduler.wake(actor, 10);
    sc_core::sc_start();
    EXPECT_FALSE(scheduler.limit_reached());
    EXPECT_EQ(scheduler.now(), 30u);
}

TEST(TimedScheduler, StopsWhenItsWatchSaysSo) {
    Scheduler& scheduler = make_scheduler();
    std::vector<Cycle> woken;
    Actor actor("actor", scheduler, [&](Cycle now) {
        woken.push_back(now);
        return now + 1;
    });
    scheduler.set_watch([](void*, Cycle now) { return now < 8; }, nullptr);
    scheduler.wake(actor, 1);
    sc_core::sc_start();
    EXPECT_EQ(woken.back(), 7u);
    EXPECT_EQ(woken.size(), 7u);
}

TEST(TimedScheduler, LetsTimeStandStillWhenNobodyHasAnythingToDo) {
    Scheduler& scheduler = make_scheduler();
    Actor actor("actor", scheduler, [&](Cycle) { return never; });
    scheduler.wake(actor, 1000000);
    sc_core::sc_start();
    EXPECT_EQ(scheduler.now(), 1000000u);
    EXPECT_EQ(scheduler.activations(), 1u);
    scheduler.wake(actor, 1000001);  // a second phase continues from there
    sc_core::sc_start();
    EXPECT_EQ(scheduler.now(), 1000001u);
}

/// Under `reserved`, every generation that may have to wait can always get one slot; the other slots are for
/// all.
TEST(TimedRayStore, GivesSlotsByItsPolicy) {
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const int capacity = random.whole(1, 20);
        const int generations = random.whole(0, 12);
        const Slots policy = random.chance(0.5) ? Slots::reserved : Slots::free;
        RayStore store(capacity, generations, policy);
        const int groups = std::max(1, std::min(capacity, generations));
        std::map<std::uint32_t, int> held;  // slot to generation
        int peak = 0;
        for (int i = 0; i < 400; ++i) {
            if (random.chance(i / 40 % 2 ? 0.35 : 0.65)) {
                const int generation = random.whole(0, std::max(generations - 1, 0));
                std::vector<int> used(std::size_t(groups), 0);
                for (const auto& [slot, g] : held) ++used[std::size_t(std::min(g, groups - 1))];
                const int left = capacity - int(held.size());
                const int spoken_for = int(std::count(used.begin(), used.end(), 0));
                bool expected = left > 0;
                if (policy == Slots::reserved && used[std::size_t(std::min(generation, groups - 1))] > 0) {
                    expected = left > spoken_for;
                }
                const auto slot = store.allocate(generation);
                ASSERT_EQ(slot.has_value(), expected);
                if (!slot) continue;
                ASSERT_LT(*slot, std::uint32_t(capacity));
                ASSERT_EQ(held.count(*slot), 0u) << "given out twice";
                held[*slot] = generation;
                store[*slot].state = Slot::State::waiting;
            } else if (!held.empty()) {
                auto at = held.begin();
                std::advance(at, random.whole(0, int(held.size()) - 1));
                store.release(at->first, at->second);
                EXPECT_EQ(store[at->first].state, Slot::State::empty);
                held.erase(at);
            }
            peak = std::max(peak, int(held.size()));
            ASSERT_EQ(store.used(), int(held.size()));
            ASSERT_EQ(store.peak(), peak);
            ASSERT_LE(int(store.touched()), capacity);
        }
    }
}

}  // namespace
}  // namespace raycell
