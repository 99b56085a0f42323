// The host of the cells, modules or tiles, must not affect anything that a run reports (invariants 2 and 4).
#include "elaboration.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {
namespace {

/// Ways of hosting an array of about 12x12 cells, one for each that could fail in its own way.
std::vector<Granularity> every_granularity() {
    return {
        {false, {}, 64},                                // one tile
        {true, {}, 64},                                 // modules
        {false, {}, 1},                                 // one tile per cell
        {false, {}, 5},                                 // tiles cut off at the array's borders
        {false, {{3, 6, 4, 7}}, 5},                     // modules across the corners of tiles
        {false, {{0, 0, 0, 11}, {0, 11, 11, 11}}, 64},  // modules along two borders, tiles along the others
        {false, {{0, 11, 0, 11}}, 64}                   // modules, with a tile that has no cell
    };
}

void expect_equal_counters(const Counters& a, const Counters& b) {
    EXPECT_EQ(a.rays_sent, b.rays_sent);
    EXPECT_EQ(a.rays_destroyed, b.rays_destroyed);
    EXPECT_EQ(a.answers_delivered, b.answers_delivered);
    EXPECT_EQ(a.load_hops, b.load_hops);
    EXPECT_EQ(a.rays.ray_hops, b.rays.ray_hops);
    EXPECT_EQ(a.rays.return_hops, b.rays.return_hops);
    EXPECT_EQ(a.slot_cycles, b.slot_cycles);
    EXPECT_EQ(a.traversal_cycles, b.traversal_cycles);
    EXPECT_EQ(a.shading_cycles, b.shading_cycles);
}

void expect_equal_graphs(const WaitGraph& a, const WaitGraph& b) {
    ASSERT_EQ(a.nodes().size(), b.nodes().size());
    for (std::size_t i = 0; i < a.nodes().size(); ++i) {
        const WaitGraph::Node& m = a.nodes()[i];
        const WaitGraph::Node& n = b.nodes()[i];
        EXPECT_EQ(std::tie(m.x, m.y, m.side, m.what, m.holds, m.wants, m.since, m.waits_for, m.state),
                  std::tie(n.x, n.y, n.side, n.what, n.holds, n.wants, n.since, n.waits_for, n.state));
    }
    EXPECT_EQ(a.knots(), b.knots());
}

void expect_equal_runs(const RunResult& a, const RunResult& b) {
    EXPECT_EQ(a.verdict, b.verdict);
    EXPECT_EQ(a.schedule_hash, b.schedule_hash);
    EXPECT_EQ(image_hash(a.picture), image_hash(b.picture));
    EXPECT_EQ(a.load_cycles, b.load_cycles);
    EXPECT_EQ(a.precast_cycles, b.precast_cycles);
    EXPECT_EQ(a.trace_cycles, b.trace_cycles);
    EXPECT_EQ(a.ended, b.ended);
    EXPECT_EQ(a.ray_store_peak, b.ray_store_peak);
    expect_equal_counters(a.counters, b.counters);
    ASSERT_EQ(a.buffers.size(), b.buffers.size());
    for (std::size_t i = 0; i < a.buffers.size(); ++i) {
        EXPECT_EQ(a.buffers[i].peak, b.buffers[i].peak);
        EXPECT_EQ(a.buffers[i].mean, b.buffers[i].mean);
    }
    for (std::size_t i = 0; i < a.picture.pixels.size(); ++i) {
        EXPECT_EQ(a.picture.pixels[i].cycle, b.picture.pixels[i].cycle);
        EXPECT_EQ(a.picture.pixels[i].hops, b.picture.pixels[i].hops);
    }
    EXPECT_EQ(a.report, b.report);
    expect_equal_graphs(a.waits, b.waits);
    ASSERT_EQ(a.time_outs.size(), b.time_outs.size());
    for (std::size_t i = 0; i < a.time_outs.size(); ++i) {
        EXPECT_EQ(a.time_outs[i].false_alarms, b.time_outs[i].false_alarms);
        EXPECT_EQ(a.time_outs[i].knot_alarms, b.time_outs[i].knot_alarms);
    }
}

void expect_equal_cells(Machine& a, Machine& b) {
    for (std::size_t i = 0; i < a.array().cells().size(); ++i) {
        const CellStatistics m = a.array().cells()[i].statistics(a.environment().scheduler.now());
        const CellStatistics n = b.array().cells()[i].statistics(b.environment().scheduler.now());
        EXPECT_EQ(std::tie(m.ray_hops, m.return_hops, m.slot_cycles, m.stalls),
                  std::tie(n.ray_hops, n.return_hops, n.slot_cycles, n.stalls));
    }
}

/// Runs one machine under every host; all are built before the first run.
template <typename Make>
RunResult expect_one_run(const Make& make) {
    expect_first_elaboration();
    std::vector<std::unique_ptr<Machine>> machines;
    for (const Granularity& granularity : every_granularity()) {
        machines.push_back(make("machine_" + std::to_string(machines.size()), granularity));
    }
    const RunResult first = machines.front()->run();
    EXPECT_EQ(machines.front()->array().module(3, 4), nullptr);
    for (std::size_t i = 1; i < machines.size(); ++i) {
        SCOPED_TRACE("granularity " + std::to_string(i));
        const RunResult other = machines[i]->run();
        expect_equal_runs(first, other);
        expect_equal_cells(*machines.front(), *machines[i]);
        EXPECT_EQ(machines[i]->environment().scheduler.activations(),
                  machines.front()->environment().scheduler.activations());
    }
    EXPECT_NE(machines[4]->array().module(3, 4), nullptr);
    EXPECT_EQ(machines[4]->array().module(2, 4), nullptr);
    return first;
}

struct Case {
    const char* scene;
    Verdict verdict;
    std::function<void(PictureSettings&, MachineSettings&)> change;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.scene << ' ' << name_of(c.verdict);
}

class EveryGranularity : public ::testing::TestWithParam<Case> {};

TEST_P(EveryGranularity, IsTheSameRun) {
    PictureSettings settings;
    MachineSettings machine;
    settings.width = settings.height = 12;
    GetParam().change(settings, machine);
    const auto placed = place_own_scene(GetParam().scene, settings);
    const RunResult result = expect_one_run([&](const std::string& name, const Granularity& granularity) {
        return std::make_unique<Machine>(name.c_str(), placed->scene, settings, machine,
                                         placed->exterior.get(), nullptr, granularity);
    });
    EXPECT_EQ(result.verdict, GetParam().verdict);
}

INSTANTIATE_TEST_SUITE_P(
    Machines, EveryGranularity,
    ::testing::Values(
        Case{"cornell", Verdict::completed, [](PictureSettings&, MachineSettings&) {}},
        Case{"still_life", Verdict::completed,
             [](PictureSettings& p, MachineSettings& m) {
                 p.shadows = Shadows::memo, p.width = 13, m.stall = 0.3, m.buffer_depth = 3;
             }},
        Case{"still_life", Verdict::completed,
             [](PictureSettings& p, MachineSettings& m) {
                 p.shadows = Shadows::precast, m.networks = Networks::quadrant, m.link_bits = 300;
             }},
        Case{"still_life", Verdict::completed,
             [](PictureSettings& p, MachineSettings&) { p.stage = RunStage::load; }},
        Case{"cornell", Verdict::completed,
             [](PictureSettings& p, MachineSettings& m) {
                 p.pixels_wide = 36, p.pixels_high = 24, m.own_rays = 3, m.stall = 0.2;
             }},
        Case{"facing_mirrors", Verdict::completed,
             [](PictureSettings& p, MachineSettings& m) {
                 p.exterior = ExteriorMode::none, m.ray_store = 5, m.slots = Slots::nested, m.stall = 0.1;
             }},
        Case{"facing_mirrors", Verdict::cycle_limit,
             [](PictureSettings&, MachineSettings& m) { m.max_cycles = 4000, m.networks = Networks::split; }},
        Case{"facing_mirrors", Verdict::livelock,
             [](PictureSettings&, MachineSettings& m) { m.ray_store = 1, m.slots = Slots::free; }},
        Case{"facing_mirrors", Verdict::deadlock,
             [](PictureSettings&, MachineSettings& m) { m.ray_store = 1, m.recovery = Recovery::none; }}));

class EveryGranularityOfTraffic : public ::testing::TestWithParam<Networks> {};

TEST_P(EveryGranularityOfTraffic, IsTheSameRun) {
    TrafficSettings traffic_settings;
    traffic_settings.sources = 1;
    const SyntheticTraffic traffic(traffic_settings);
    const PictureSettings settings = traffic_picture(14, 12, 3);
    const CellScene scene = traffic_scene(settings, traffic_settings);
    MachineSettings machine;
    machine.networks = GetParam();
    expect_one_run([&](const std::string& name, const Granularity& granularity) {
        return std::make_unique<Machine>(name.c_str(), scene, settings, machine, nullptr, &traffic,
                                         granularity);
    });
}

INSTANTIATE_TEST_SUITE_P(Networks, EveryGranularityOfTraffic,
                         ::testing::Values(Networks::half, Networks::quadrant, Networks::split,
                                           Networks::shared));

}  // namespace
}  // namespace raycell
