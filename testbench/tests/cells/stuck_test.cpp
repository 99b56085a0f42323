// Runs that can't end: they stop with a verdict and a report (design, section 5).
#include "stuck.hpp"

#include "../truth/hand_made.hpp"

namespace raycell {
namespace {

TEST(TimedVerdict, OfSharedBuffersOfOneMessageBetweenFacingMirrorsIsDeadlock) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) {
        m.networks = Networks::shared;
        m.ray_store = 8;
    });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("deadlock"));
    stuck.expect_report();
    stuck.expect_conserved();
    EXPECT_LT(stuck.result.counters.pixels_done, 24u * 24u);
}

TEST(TimedVerdict, OfSplitBuffersOfOneMessageInAStillLifeIsDeadlock) {
    Stuck stuck("still_life", [](PictureSettings&, MachineSettings& m) { m.networks = Networks::split; });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("deadlock"));
    stuck.expect_report();
    stuck.expect_conserved();
}

TEST(TimedVerdict, OfOneSlotWithoutRecoveryIsDeadlock) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) {
        m.ray_store = 1;
        m.recovery = Recovery::none;
    });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("deadlock"));
    stuck.expect_report();
    stuck.expect_conserved();
    EXPECT_EQ(stuck.result.counters.rays_destroyed, 0u);
}

TEST(TimedVerdict, OfOneSlotThatATreeComesBackToIsLivelock) {
    Stuck stuck("facing_mirrors", [](PictureSettings&, MachineSettings& m) { m.ray_store = 1; });
    EXPECT_EQ(name_of(stuck.result.verdict), std::string("livelock"));
    EXPECT_FALSE(stuck.result.report.empty());
    EXPECT_GT(stuck.result.counters.rays_destroyed, 0u);
    EXPECT_GT(stuck.result.in_flight.rays, 0u);
    stuck.expect_conserved();
}

TEST(TimedVerdict, WithHalvesReservedSlotsAndOnePerGenerationIsCompletedWithThatPicture) {
    Stuck safe("facing_mirrors",
               [](PictureSettings& s, MachineSettings& m) { m.ray_store = s.max_depth + 1; });
    EXPECT_EQ(name_of(safe.result.verdict), std::string("completed"));
    EXPECT_TRUE(safe.result.report.empty());
    UntimedMachine untimed(safe.placed->scene, safe.settings, safe.placed->exterior.get());
    EXPECT_EQ(image_hash(safe.result.picture), image_hash(untimed.render()));
}

TEST(TimedVerdict, BeyondTheLimitOfCyclesIsCycleLimit) {
    Stuck stopped("still_life", [](PictureSettings&, MachineSettings& m) { m.max_cycles = 300; });
    EXPECT_EQ(name_of(stopped.result.verdict), std::string("cycle_limit"));
    EXPECT_LE(stopped.timed->environment().scheduler.now(), 300u);
    EXPECT_EQ(stopped.result.trace_cycles, 0u);
    EXPECT_GT(stopped.result.in_flight.loads, 0u);
    stopped.expect_conserved();
}

TEST(TimedVerdict, BeyondTheLimitOfCyclesWhileTracingIsCycleLimit) {
    // A walk step this slow is not over when the limit comes; loading does not use it.
    Stuck stopped("facing_mirrors", [](PictureSettings& s, MachineSettings& m) {
        s.width = s.height = 8;
        m.costs.walk_step = 1000000;
        m.max_cycles = 1000000;
    });
    EXPECT_GT(stopped.result.load_cycles, 0u);
    EXPECT_LT(stopped.result.load_cycles, 1000000u);
    EXPECT_EQ(name_of(stopped.result.verdict), std::string("cycle_limit"));
    EXPECT_EQ(stopped.result.counters.pixels_done, 0u);
    EXPECT_LE(stopped.timed->environment().scheduler.now(), 1000000u);
    EXPECT_EQ(stopped.result.in_flight.rays, 64u) << "every cell's own";
    stopped.expect_conserved();
}

TEST(TimedVerdict, OfARunCutShortNamesTheFewExteriorProcessorsThereAreAndSinceWhenEachIsDone) {
    constexpr int latency = 100;
    Stuck stopped("still_life", [](PictureSettings&, MachineSettings& m) {
        m.exterior_processors = 2;
        m.exterior_latency = latency;
        m.max_cycles = 210400;
    });
    ASSERT_EQ(name_of(stopped.result.verdict), std::string("cycle_limit"));
    EXPECT_GT(stopped.result.exterior.items, 100u) << "each was used many times";
    std::set<std::string> names;
    for (const WaitGraph::Node& node : stopped.result.waits.nodes()) {
        if (node.kind != WaitGraph::Kind::processor) continue;
        names.insert(node.what);
        EXPECT_GT(node.since + 2 * latency, stopped.result.ended);
    }
    EXPECT_EQ(names, (std::set<std::string>{"exterior processor 0", "exterior processor 1"}));
}

TEST(TimedVerdict, ALimitThatIsJustLongEnoughIsNoLimit) {
    expect_first_elaboration();
    const CellScene scene = hand_made::cube(1, 1, 8);
    PictureSettings settings;
    settings.width = settings.height = 1;
    settings.exterior = ExteriorMode::none;
    // Loading an empty scene into one cell: the set-up is ready in cycle 2, arrives in 13 (217 bits, 11
    // cycles), leaves precomputation in 14, arrives in 25, leaves the row in 26, arrives in 37 and is taken
    // in
    // 38. The end mark leaves the row in 39, when the cell's only buffer place is empty, arrives in 40 and is
    // taken in 41. The primary ray takes a walk step of 4 from 42 on and returns background in 46.
    MachineSettings exact = estimated_machine();
    exact.max_cycles = 46;
    MachineSettings short_by_one = estimated_machine();
    short_by_one.max_cycles = 45;
    Machine second("exact", scene, settings, exact, nullptr);
    Machine third("short_by_one", scene, settings, short_by_one, nullptr);
    EXPECT_EQ(name_of(second.run().verdict), std::string("completed"));
    EXPECT_EQ(name_of(third.run().verdict), std::string("cycle_limit"));
}

TEST(TimedVerdict, OfCellsTooSmallForTheirVoxelsIsCapacityAndNamesHowMany) {
    Stuck small("cornell", [](PictureSettings& s, MachineSettings&) {
        s.width = s.height = 8;
        s.voxel_capacity = 1;
    });
    EXPECT_EQ(name_of(small.result.verdict), std::string("capacity"));
    EXPECT_GT(small.result.storage.overflowed, 0u);
    EXPECT_LE(small.result.storage.max_voxels, 1u);
}

}  // namespace
}  // namespace raycell
