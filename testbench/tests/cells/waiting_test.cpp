// Counters of cells: waiting by cause, exact to the cycle, however often a cell is woken.
#include "cells/meters/observer_list.hpp"
#include "estimates.hpp"
#include "lone_cell.hpp"
#include "testbench/common/ray_watch.hpp"

namespace raycell {
namespace {

/// A lone cell; empty unless a scene is given.
struct EmptyCell : LoneCell {
    using LoneCell::LoneCell;
    void send_answer(Link& link, int home_x, int cycles = 1) {
        Answer answer;
        answer.home_x = std::uint16_t(home_x);
        answer.home_y = 1;
        send(link, answer, cycles);
    }
    /// Returns what the cell counted. If `restless`, the cell is woken in every cycle.
    CellStatistics run(Cycle cycles, bool restless, const std::function<void(Cycle)>& script) {
        LoneCell::run(cycles, [&](Cycle now) {
            script(now);
            if (restless) scheduler.wake(cell->cell(), now + 1);
        });
        return cell->cell().statistics(scheduler.now());
    }
    Link& east_out() { return towards(Side::east); }
};

std::uint64_t cycles_of(const CellStatistics& s, Stall cause) { return s.stalls[cause]; }

std::uint64_t all_cycles(const CellStatistics& s) {
    std::uint64_t sum = 0;
    for (const std::uint64_t cycles : s.stalls) sum += cycles;
    return sum;
}

const Ray eastwards = lone_ray({0, 0.5, 5}, {1, 0, 0});

/// A ray is decided in cycle 6. The next buffer has room from cycle 51 on. An answer uses the wires from 40
/// to 70.
void full_then_busy(bool restless) {
    EmptyCell empty;
    const int index = 0;  // half: east
    const CellStatistics s = empty.run(100, restless, [&](Cycle now) {
        if (now == 1) {
            empty.send(empty.east_out(), eastwards);
            empty.send(empty.from(Side::west), eastwards);
        }
        if (now == 40) empty.send_answer(empty.east_out(), 2, 30);
        if (now == 50) empty.east_out().pop(index);
    });
    ASSERT_EQ(empty.machine.costs.walk_step, 4u);
    EXPECT_EQ(cycles_of(s, Stall::output_full), 51u - 6u);
    EXPECT_EQ(cycles_of(s, Stall::output_busy), 70u - 51u);
    EXPECT_EQ(all_cycles(s), 70u - 6u) << "nothing else";
    EXPECT_EQ(s.ray_hops, 1u);
    EXPECT_EQ(s.traversal_cycles, 4u);
}

TEST(CellWaiting, ForRoomAndThenForTheWiresIsCountedToTheCycle) { full_then_busy(false); }

TEST(CellWaiting, ForRoomAndThenForTheWiresIsTheSameInARestlessCell) { full_then_busy(true); }

TEST(CellWaiting, ForRoomThatNeverComesCountsUpToTheEnd) {
    EmptyCell empty;
    const CellStatistics s = empty.run(100, false, [&](Cycle now) {
        if (now != 1) return;
        empty.send(empty.east_out(), eastwards);
        empty.send(empty.from(Side::west), eastwards);
    });
    EXPECT_EQ(empty.scheduler.now(), 100u);
    EXPECT_EQ(cycles_of(s, Stall::output_full), 100u - 6u);
    EXPECT_EQ(all_cycles(s), 100u - 6u);
    EXPECT_EQ(s.ray_hops, 0u);
}

TEST(CellWaiting, OfTwoRaysTheSecondWaitsForTheFirstsTest) {
    EmptyCell empty;
    const CellStatistics s = empty.run(100, false, [&](Cycle now) {
        if (now != 1) return;
        empty.send(empty.from(Side::west), eastwards);
        empty.send(empty.from(Side::south), lone_ray({0.5, 1, 5}, {0, -1, 0}));
    });
    EXPECT_EQ(cycles_of(s, Stall::traversal), 4u);
    EXPECT_EQ(all_cycles(s), 4u);
    EXPECT_EQ(s.ray_hops, 2u);
}

TEST(CellWaiting, AnAnswerWaitsForRoomFromItsRoutingOn) {
    EmptyCell empty;
    const CellStatistics s = empty.run(100, false, [&](Cycle now) {
        if (now == 1) {
            empty.send_answer(empty.east_out(), 2);
            empty.send_answer(empty.from(Side::west), 2);
        }
        if (now == 30) empty.east_out().pop(empty.environment->classes.answer);
    });
    ASSERT_EQ(empty.machine.costs.route_return, 1u);
    EXPECT_EQ(cycles_of(s, Stall::answer_full), 31u - 3u);
    EXPECT_EQ(all_cycles(s), 31u - 3u);
    EXPECT_EQ(s.return_hops, 1u);
}

TEST(CellWaiting, AnAnswerThatNeverLeavesTheShadingUnitCountsUpToTheEnd) {
    CellScene wall = LoneCell::empty(10);
    hand_made::add_rectangle(wall, hand_made::add_object(wall, hand_made::glowing(dvec3(0.5))), {1, 1, 5},
                             {0, 1, 0}, {1, 0, 0});
    EmptyCell cell(estimated_machine(), wall);
    const CellStatistics s = cell.run(1000, false, [&](Cycle now) {
        if (now != 1) return;
        Ray ray = lone_ray({0.5, 1, 4.9}, glm::normalize(dvec3(0, -0.1, 1)));
        ray.home_x = 2;
        ray.home_y = 1;
        ray.fresh = false;
        cell.send(cell.from(Side::south), ray);
        cell.send_answer(cell.east_out(), 2);
    });
    ASSERT_EQ(cell.machine.buffer_depth, 1) << "one answer fills it";
    EXPECT_GT(s.shading_cycles, 0u);
    EXPECT_EQ(cycles_of(s, Stall::answer_full), 1000 - (2 + s.traversal_cycles + s.shading_cycles));
    EXPECT_EQ(all_cycles(s), cycles_of(s, Stall::answer_full));
}

TEST(CellWaiting, AHitThatFindsTheStoreFullWaitsForASlotEvenWhereThePortIsTaken) {
    CellScene wall = LoneCell::empty(10);
    hand_made::add_rectangle(wall, hand_made::add_object(wall, hand_made::glowing(dvec3(0.5))), {1, 1, 5},
                             {0, 1, 0}, {1, 0, 0});
    Source behind;  // behind the wall: hits need a slot all the same
    behind.position = {1.5, 1.5, 9};
    wall.sources.push_back(behind);
    MachineSettings machine = estimated_machine();
    machine.ray_store = 1;
    machine.recovery = Recovery::none;
    machine.link_bits = 1000;
    machine.costs.shade_setup = 100000;
    EmptyCell cell(machine, wall);
    const CellStatistics s = cell.run(1000, false, [&](Cycle now) {
        Ray ray = lone_ray({0.5, 1, 4.9}, glm::normalize(dvec3(0, -0.1, 1)));
        ray.home_x = 2;
        ray.home_y = 1;
        ray.fresh = false;
        if (now == 1 || now == 101) cell.send(cell.from(Side::south), ray);
        // Verdicts for the slot arrive, one in every cycle.
        Answer verdict;
        verdict.home_x = verdict.home_y = 1;
        verdict.ray_kind = RayKind::shadow;
        verdict.kind = Answer::Kind::lit;
        Cycle retry = never;
        Link& west = cell.from(Side::west);
        if (now > 90 && west.can_send(cell.environment->classes.answer, retry)) cell.send(west, verdict);
    });
    EXPECT_EQ(cycles_of(s, Stall::store_port), 0u);
    EXPECT_GT(cycles_of(s, Stall::no_slot), 800u);
    EXPECT_EQ(all_cycles(s), cycles_of(s, Stall::no_slot));
}

TEST(CellWaiting, AFreeWayIsNoWaiting) {
    EmptyCell empty;
    const CellStatistics s = empty.run(100, true, [&](Cycle now) {
        if (now == 1) empty.send(empty.from(Side::west), eastwards);
        if (now == 1) empty.send_answer(empty.from(Side::south), 0);
    });
    EXPECT_EQ(all_cycles(s), 0u);
    EXPECT_EQ(s.ray_hops + s.return_hops, 2u);
}

TEST(CellWaiting, AWholeRunCountsTheSameWhenItsCellsAreWokenForNothing) {
    expect_first_elaboration();
    const std::uint64_t seed = property::seeds(1, 1).front();
    SCOPED_TRACE(property::rerun(seed));
    property::Random random(seed);
    PictureSettings settings;
    settings.width = settings.height = 16;
    MachineSettings machine;
    machine.ray_store = 5;
    const auto placed = place_own_scene("facing_mirrors", settings);
    Machine calm("calm", placed->scene, settings, machine, placed->exterior.get());
    Machine woken("woken", placed->scene, settings, machine, placed->exterior.get());
    const RunResult expected = calm.run();
    Environment& env = woken.environment();
    env.scheduler.set_sampler([&](Cycle now) {
        if (env.phase != Phase::trace || env.meters.counters.pixels_done == 256) return;
        for (int i = 0; i < 8; ++i) {
            const int cell = random.whole(0, 255);
            env.scheduler.wake(woken.array().cell(cell % 16, cell / 16), now + 1);
        }
    });
    const RunResult result = woken.run();
    EXPECT_EQ(result.schedule_hash, expected.schedule_hash);
    EXPECT_EQ(result.trace_cycles, expected.trace_cycles);
    EXPECT_GT(env.scheduler.activations(), calm.environment().scheduler.activations() + 1000);
    std::uint64_t waited = 0;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const CellStatistics a = calm.array().cell(x, y).statistics(calm.environment().scheduler.now());
            const CellStatistics b = woken.array().cell(x, y).statistics(env.scheduler.now());
            ASSERT_EQ(a.stalls, b.stalls) << x << ", " << y;
            ASSERT_EQ(a.slot_cycles, b.slot_cycles);
            waited += all_cycles(a);
        }
    }
    EXPECT_GT(waited, 10000u);
}

TEST(RayWatchOrder, EventsOfACycleComeByCellWhateverCellRanFirst) {
    expect_first_elaboration();
    PictureSettings settings;
    settings.width = settings.height = 4;
    const MachineSettings machine;
    const auto placed = place_own_scene("cornell", settings);
    Machine idle("machine", placed->scene, settings, machine, placed->exterior.get());
    const auto told = [&](const std::vector<int>& order) {
        std::ostringstream text;
        RayWatch watch(text, machine.networks, 4, 4);
        for (int i = 0; i < 16; ++i) watch.watch_pixel(std::uint64_t(i));
        CellObserverList list;
        list.add(watch);
        for (const int i : order) {
            const Cell& cell = idle.array().cell(i % 4, i / 4);
            Ray ray;
            ray.id = std::uint64_t(i) << 32;
            list.launched(cell, 7, ray, nullptr);
            list.cell_event(cell, 7, CellEvent::launch, ray.id, 0);
            list.cell_event(cell, 7, CellEvent::test, ray.id, std::uint32_t(Visit::Event::forward));
        }
        for (const int i : order) {
            const Cell& cell = idle.array().cell(i % 4, i / 4);
            list.cell_event(cell, 9, CellEvent::send, std::uint64_t(i) << 32,
                            std::uint32_t(Side::south) << 8);
            list.stalled(cell, 9, std::uint64_t(i) << 32, Stall::output_full, 2);
        }
        watch.finish(9);
        return text.str();
    };
    const std::string expected = told({2, 5, 11});
    EXPECT_NE(expected.find("hops south, class ray_east; waited 2 cycles (output_full)"), std::string::npos);
    EXPECT_NE(expected.find("watched: 3 rays, 3 hops"), std::string::npos);
    for (const std::vector<int>& order : {std::vector<int>{11, 5, 2}, {5, 2, 11}, {11, 2, 5}}) {
        EXPECT_EQ(told(order), expected);
    }
}

}  // namespace
}  // namespace raycell
