// Deadlocks made on purpose, each with a near-miss: the proof finds the first and not the second.
#include "knot_check.hpp"
#include "stuck.hpp"

namespace raycell {
namespace {

using Change = std::function<void(PictureSettings&, MachineSettings&)>;

/// Number of nodes of each kind in all knots.
std::map<std::string, int> kinds_in_knots(const WaitGraph& graph) {
    std::map<std::string, int> kinds;
    for (const auto& knot : graph.knots()) {
        for (const WaitGraph::Index i : knot) ++kinds[name_of(graph.nodes()[i].kind)];
    }
    return kinds;
}

void expect_proved(const Stuck& stuck) {
    ASSERT_EQ(name_of(stuck.result.verdict), std::string("deadlock"));
    const WaitGraph& graph = stuck.result.waits;
    ASSERT_TRUE(graph.deadlocked());
    std::vector<knot_check::Node> nodes;
    for (const WaitGraph::Node& n : graph.nodes()) {
        nodes.push_back({n.moves, n.all, {n.waits_for.begin(), n.waits_for.end()}});
        EXPECT_FALSE(n.holds.empty()) << "an idle place never counts: " << n.what;
        EXPECT_LE(n.since, stuck.result.ended);
        for (const WaitGraph::Index other : n.waits_for) ASSERT_LT(other, graph.nodes().size());
    }
    std::set<std::pair<int, int>> cells;
    for (const auto& knot : graph.knots()) {
        EXPECT_EQ(knot_check::objection(nodes, {knot.begin(), knot.end()}), "");
        for (const WaitGraph::Index i : knot) cells.emplace(graph.nodes()[i].x, graph.nodes()[i].y);
    }
    EXPECT_EQ(cells, (std::set<std::pair<int, int>>(stuck.result.knot_cells.begin(),
                                                    stuck.result.knot_cells.end())));
    EXPECT_LE(stuck.result.knot_formed, stuck.result.ended);
    // At a standstill, everything left is in a knot or waits for one.
    for (const WaitGraph::Node& n : graph.nodes())
        EXPECT_NE(n.state, WaitGraph::State::live) << n.what << n.wants;
}

TEST(Knot, OfSharedBuffersIsARingOfBuffersAlone) {
    Stuck stuck("facing_mirrors",
                [](PictureSettings&, MachineSettings& m) { m.networks = Networks::shared; });
    expect_proved(stuck);
    EXPECT_EQ(kinds_in_knots(stuck.result.waits).size(), 1u);
    EXPECT_GT(kinds_in_knots(stuck.result.waits)["buffer"], 0);
    EXPECT_GT(stuck.result.waits.tails(), 0u) << "others wait for the ring without being of it";
}

TEST(Knot, OfSplitBuffersIsARingOfBuffersAlone) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) { m.networks = Networks::split; });
    expect_proved(stuck);
    EXPECT_EQ(kinds_in_knots(stuck.result.waits).size(), 1u);
}

TEST(Knot, OfSharedBuffersIsNotThereWithBuffersDeepEnough) {
    Stuck near_miss("facing_mirrors", [](PictureSettings&, MachineSettings& m) {
        m.networks = Networks::shared;
        m.buffer_depth = 64;
    });
    EXPECT_EQ(name_of(near_miss.result.verdict), std::string("completed"));
    EXPECT_TRUE(near_miss.result.waits.nodes().empty());
}

const Change one_slot = [](PictureSettings&, MachineSettings& m) {
    m.ray_store = 1;
    m.recovery = Recovery::none;
};

TEST(Knot, OfFullRayStoresIsMadeOfSlotsAndTheirChildren) {
    Stuck stuck("facing_mirrors", one_slot);
    expect_proved(stuck);
    const auto kinds = kinds_in_knots(stuck.result.waits);
    EXPECT_TRUE(kinds.count("slot"));
    EXPECT_TRUE(kinds.count("child") || kinds.count("buffer"));
}

TEST(Knot, OfFullRayStoresIsNotThereWithASlotMoreThanItTakes) {
    Stuck near_miss("facing_mirrors", [](PictureSettings&, MachineSettings& m) {
        m.ray_store = 24;
        m.recovery = Recovery::none;
    });
    EXPECT_EQ(name_of(near_miss.result.verdict), std::string("completed"));
}

TEST(Knot, OfBothIsFoundWhereSlotsAndBuffersAreShort) {
    Stuck stuck("still_life", [](PictureSettings&, MachineSettings& m) {
        m.networks = Networks::split;
        m.ray_store = 2;
        m.recovery = Recovery::none;
        m.slots = Slots::free;
    });
    expect_proved(stuck);
    const auto kinds = kinds_in_knots(stuck.result.waits);
    EXPECT_TRUE(kinds.count("slot"));
    EXPECT_TRUE(kinds.count("buffer"));
}

TEST(Knot, IsNotSeenInALivelock) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) { m.ray_store = 1; });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("livelock"));
    EXPECT_FALSE(stuck.result.waits.deadlocked());
    EXPECT_TRUE(stuck.result.knot_cells.empty());
}

TEST(Knot, IsNotSeenInCongestionThatTheCycleLimitCut) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) { m.max_cycles = 52260; });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("cycle_limit"));
    EXPECT_FALSE(stuck.result.waits.nodes().empty()) << "there was traffic";
    EXPECT_FALSE(stuck.result.waits.deadlocked());
}

TEST(Knot, ThatHasFormedIsSeenThoughTheCycleLimitCameFirst) {
    // In the run of OfSharedBuffersIsARingOfBuffersAlone, other messages move until cycle 53717.
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) {
        m.networks = Networks::shared;
        m.max_cycles = 52700;
    });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("deadlock"));
    ASSERT_TRUE(stuck.result.waits.deadlocked());
    EXPECT_LE(stuck.result.knot_formed, 52700u);
}

TEST(TimeOut, AlarmsInACellOfEveryKnotOfBuffersWhatIsProvedLocked) {
    Stuck stuck("facing_mirrors",
                [](PictureSettings&, MachineSettings& m) { m.networks = Networks::shared; });
    ASSERT_TRUE(stuck.result.waits.deadlocked());
    std::uint64_t false_before = ~std::uint64_t(0);
    for (const TimeOutResult& each : stuck.result.time_outs) {
        EXPECT_EQ(each.knot_cells, stuck.result.knot_cells.size());
        EXPECT_EQ(each.knot_alarms, each.knot_cells) << "a buffer of the ring waits in each of its cells";
        EXPECT_EQ(each.missed_knots, 0u);
        EXPECT_LE(each.false_alarms, false_before) << "longer time-outs are more patient";
        // Other traffic through the knot's cells may delay the alarm until nothing moves any more.
        EXPECT_LE(each.first_alarm_delay,
                  std::int64_t(each.cycles + stuck.result.ended - stuck.result.knot_formed));
        false_before = each.false_alarms;
    }
    EXPECT_GT(stuck.result.time_outs.front().false_alarms, 0u) << "16 cycles are too hasty";
}

TEST(TimeOut, MissesCellsInWhichOnlyASlotWaitsButNoKnotOfFullRayStores) {
    Stuck stuck("still_life", [](PictureSettings&, MachineSettings& m) {
        m.ray_store = 6;
        m.recovery = Recovery::none;
    });
    ASSERT_TRUE(stuck.result.waits.deadlocked());
    for (const TimeOutResult& each : stuck.result.time_outs) {
        EXPECT_LT(each.knot_alarms, each.knot_cells) << "a slot that waits is no message that can't move on";
        EXPECT_EQ(each.missed_knots, 0u) << "its child is somewhere";
    }
}

TEST(Ledger, CountsWhatWasDestroyedWhereAndWhose) {
    Stuck run("facing_mirrors",
              [](PictureSettings& s, MachineSettings& m) { m.ray_store = s.max_depth + 1; });
    ASSERT_EQ(name_of(run.result.verdict), std::string("completed"));
    const Ledger& ledger = run.result.ledger;
    EXPECT_GT(ledger.destroyed(), 0u) << "else this tests nothing";
    EXPECT_EQ(ledger.destroyed(), run.result.counters.rays_destroyed);
    EXPECT_EQ(ledger.entries().size(), ledger.destroyed());
    std::vector<std::uint64_t> of_pixel(run.result.picture.pixels.size(), 0);
    std::uint64_t hops = 0;
    for (const Ledger::Entry& e : ledger.entries()) {
        ++of_pixel[pixel_of(e.ray)];
        EXPECT_GE(e.cycle, e.launched);
        EXPECT_GE(e.hops, unsigned(std::abs(e.x - e.home_x) + std::abs(e.y - e.home_y)));
        hops += e.hops + unsigned(std::abs(e.x - e.home_x) + std::abs(e.y - e.home_y));
    }
    EXPECT_EQ(hops, ledger.wasted_hops());
    for (std::size_t i = 0; i < of_pixel.size(); ++i)
        EXPECT_EQ(run.result.picture.pixels[i].postponed, of_pixel[i]);
}

struct StallCase {
    double probability;
    Shadows shadows;
    Networks networks;
};
class RandomStall : public ::testing::TestWithParam<StallCase> {};

TEST_P(RandomStall, ChangesTheScheduleAndNeverThePicture) {
    expect_first_elaboration();
    const StallCase& each = GetParam();
    PictureSettings settings;
    settings.width = 20;
    settings.height = 14;
    settings.shadows = each.shadows;
    const auto placed = place_own_scene("still_life", settings);
    UntimedMachine untimed(placed->scene, settings, placed->exterior.get());
    const std::uint64_t golden = image_hash(untimed.render());
    std::set<std::uint64_t> schedules;
    std::vector<std::unique_ptr<Machine>> machines;
    for (const std::uint64_t seed : {0, 1, 2}) {  // 0: no stalls
        MachineSettings machine;
        machine.networks = each.networks;
        machine.stall = seed == 0 ? 0 : each.probability;
        machine.seed = seed;
        const std::string name = "machine_" + std::to_string(seed);
        machines.push_back(std::make_unique<Machine>(name.c_str(), placed->scene, settings, machine,
                                                     placed->exterior.get()));
    }
    for (const auto& machine : machines) {
        const RunResult result = machine->run();
        ASSERT_EQ(name_of(result.verdict), std::string("completed"));
        EXPECT_EQ(image_hash(result.picture), golden);
        schedules.insert(result.schedule_hash);
    }
    EXPECT_EQ(schedules.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(Often, RandomStall,
                         ::testing::Values(StallCase{0.01, Shadows::per_hit, Networks::half},
                                           StallCase{0.3, Shadows::precast, Networks::half},
                                           StallCase{0.3, Shadows::memo, Networks::quadrant},
                                           StallCase{0.9, Shadows::per_hit, Networks::quadrant}));

}  // namespace
}  // namespace raycell
