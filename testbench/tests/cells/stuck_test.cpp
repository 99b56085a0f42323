// Runs that can't end: they stop all the same, with a verdict and a report (design, section 5).
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

struct Stuck {
    explicit Stuck(const std::string& scene,
                   const std::function<void(PictureSettings&, MachineSettings&)>& change) {
        expect_first_elaboration();
        settings.width = settings.height = 24;
        change(settings, machine);
        placed = place_own_scene(scene, settings);
        timed =
            std::make_unique<Machine>("machine", placed->scene, settings, machine, placed->exterior.get());
        result = timed->run();
    }
    /// What is not delivered is still there: no message got lost on the way into the deadlock.
    void expect_conserved() {
        const Counters& c = result.counters;
        const std::uint64_t open = c.rays_sent - c.rays_answered - c.rays_silent - c.rays_destroyed;
        const std::uint64_t there = timed->environment().pools.rays.in_use();
        EXPECT_GE(open, there);
        EXPECT_LE(open,
                  there + std::uint64_t(machine.exterior_processors));  // those hold answers that can't leave
        EXPECT_EQ(c.answers_sent - c.answers_delivered, timed->environment().pools.answers.in_use());
        EXPECT_EQ(c.loads_sent, c.loads_delivered);
    }
    void expect_report() {
        ASSERT_FALSE(result.report.empty());
        Cycle before = 0;
        for (const std::string& line : result.report) {
            EXPECT_TRUE(line.find("cell (") == 0 || line.find("link ") == 0) << line;
            const auto at = line.find("since cycle ");
            ASSERT_NE(at, std::string::npos) << line;
            const Cycle since = std::stoull(line.substr(at + 12));
            EXPECT_GE(since, before) << "oldest first";
            before = since;
        }
        EXPECT_LE(before, timed->environment().scheduler.now());
    }
    PictureSettings settings;
    MachineSettings machine;
    std::unique_ptr<PlacedScene> placed;
    std::unique_ptr<Machine> timed;
    RunResult result;
};

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
}

TEST(TimedVerdict, BeyondTheLimitOfCyclesWhileTracingIsCycleLimit) {
    // A traverse this slow is not through when the limit comes; loading does not use it.
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
}

TEST(TimedVerdict, ALimitThatIsJustLongEnoughIsNoLimit) {
    expect_first_elaboration();
    const CellScene scene = hand_made::cube(1, 1, 8);
    PictureSettings settings;
    settings.width = settings.height = 1;
    settings.exterior = ExteriorMode::none;
    // Loading an empty scene into one cell: the set-up is ready in 2, arrives in 8 (111 bits, 6 cycles),
    // leaves precomputation in 9, arrives in 15, leaves the row in 16, arrives in 22, is taken in 23. The end
    // mark leaves the row in 24, when the cell's only place is empty, arrives in 25, is taken in 26. Then the
    // primary ray: from 27 on a walk step of 4, background in 31.
    MachineSettings exact;
    exact.max_cycles = 31;
    MachineSettings short_by_one;
    short_by_one.max_cycles = 30;
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
