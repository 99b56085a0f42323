// Invariants 1 and 2: the timed machine's picture equals the untimed one's, bit for bit, for all settings
// that only affect time.
#include "elaboration.hpp"

namespace raycell {
namespace {

struct Drawn {
    std::string scene;
    PictureSettings settings;
    MachineSettings machine;
    bool must_end = true;  ///< whether design section 5 promises that the run ends
    std::string text;      ///< for messages
};

Drawn draw(std::uint64_t seed) {
    property::Random random(seed);
    Drawn drawn;
    const char* const scenes[] = {"cornell", "facing_mirrors", "still_life"};
    drawn.scene = scenes[random.whole(0, 2)];
    PictureSettings& s = drawn.settings;
    s.width = random.chance(0.15) ? 1 : random.whole(2, 24);
    s.height = random.chance(0.15) ? 1 : random.whole(2, 20);
    s.depth_levels = random.whole(1, 1024);
    s.viewer = random.chance(0.2) ? ViewerMode::infinity : ViewerMode::scene;
    s.hit = HitTest(random.whole(0, 4));
    s.normals = Normals(random.whole(0, 1));
    s.shadows = Shadows(random.whole(0, 2));
    s.exterior = ExteriorMode(random.whole(0, 1));
    s.max_depth = random.whole(0, 5);
    s.min_weight = random.chance(0.5) ? 1.0 / 256 : 0;
    s.voxel_capacity = random.chance(0.15) ? random.whole(1, 6) : 0;
    s.stage = random.chance(0.05) ? RunStage::load : RunStage::trace;
    s.display = random.chance(0.1) ? Display::gouraud : Display::phong;
    NumberSettings& n = s.numbers;
    n.arithmetic = random.chance(0.25) ? Numbers::exact : Numbers::fixed;
    n.word_bits = random.whole(8, 32);
    n.rounding = Rounding(random.whole(0, 1));
    n.operators.reciprocal = Iteration(random.whole(0, 2));
    n.operators.root = Iteration(random.whole(0, 2));
    n.operators.power = PowerMethod(random.whole(0, 2));
    n.operators.reciprocal_table = 1 << random.whole(2, 12);
    n.operators.root_table = 1 << random.whole(2, 12);
    n.operators.power_table = 1 << random.whole(2, 12);
    MachineSettings& m = drawn.machine;
    m.buffer_depth = random.whole(1, 4);
    m.networks = random.chance(0.5) ? Networks::half : Networks::quadrant;
    m.slots = Slots::reserved;
    m.recovery = Recovery::postpone;
    m.link_bits = random.chance(0.3) ? random.whole(1, 8) : random.whole(9, 300);
    m.exterior_processors = random.whole(1, 70);
    m.exterior_latency = random.whole(1, 400);
    m.seed = std::uint64_t(random.whole(1, 1000));
    for (const auto& [name, member] : CostTable::entries()) {
        if (random.chance(0.3)) m.costs.*member = std::uint32_t(random.whole(1, 60));
    }
    CellScene lights;  // the number of generations that may have to wait depends on whether there are sources
    lights.sources.resize(1);
    const int least = std::max(waiting_generations(Context(lights, s)), 1);
    m.ray_store = random.whole(least, 16);
    if (random.chance(0.4)) m.ray_store = least;
    m.feed_lanes = random.whole(1, 20);
    m.feed_bits = random.whole(1, 300);
    m.load_queue = random.chance(0.5) ? 0 : random.whole(1, 4);
    if (random.chance(0.3)) m.start_within = std::uint32_t(random.whole(1, 5000));
    if (random.chance(0.25)) {  // no promise: it may get stuck, but if it ends, the picture is the same
        drawn.must_end = false;
        m.networks = Networks(random.whole(0, 3));
        m.slots = Slots(random.whole(0, 1));
        m.recovery = Recovery(random.whole(0, 1));
        m.ray_store = random.whole(1, 16);
    }
    property::Random blocks(seed + 5000000);  // of its own, so that the other draws stay what they were
    if (blocks.chance(0.3)) {
        s.pixels_wide = s.width * blocks.whole(1, 3);
        s.pixels_high = s.height * blocks.whole(1, 3);
        m.own_rays = blocks.whole(1, 5);
    }
    drawn.text = drawn.scene + " at " + std::to_string(s.width) + "x" + std::to_string(s.height) + ", " +
                 std::to_string(s.block()) + " pixels a cell, M " + std::to_string(m.ray_store) +
                 ", buffers " + std::to_string(m.buffer_depth) + ", networks " +
                 std::to_string(int(m.networks)) + ", hit " + std::to_string(int(s.hit)) + ", shadows " +
                 std::to_string(int(s.shadows)) + ", exterior " + std::to_string(int(s.exterior)) +
                 ", generations " + std::to_string(s.max_depth) + ", arithmetic " +
                 std::to_string(int(n.arithmetic)) + " of " + std::to_string(n.word_bits) + " bits";
    return drawn;
}

class TimedPicture : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(TimedPicture, EqualsTheUntimedOneBitForBit) {
    expect_first_elaboration();
    const std::uint64_t seed = property::seeds(GetParam(), 1)[0];
    const Drawn drawn = draw(seed);
    SCOPED_TRACE(drawn.text + "; " + property::rerun(seed));
    const auto placed = place_own_scene(drawn.scene, drawn.settings);
    UntimedMachine untimed(placed->scene, drawn.settings, placed->exterior.get());
    const Picture golden = untimed.render();
    Machine timed("machine", placed->scene, drawn.settings, drawn.machine, placed->exterior.get());
    const RunResult result = timed.run();
    if (!drawn.must_end && (result.verdict == Verdict::deadlock || result.verdict == Verdict::livelock)) {
        EXPECT_FALSE(result.report.empty());
        return;
    }
    EXPECT_EQ(name_of(result.verdict), std::string(result.storage.overflowed > 0 ? "capacity" : "completed"));
    EXPECT_EQ(image_hash(result.picture), image_hash(golden));
    EXPECT_EQ(result.storage.voxels, untimed.loaded().voxels);
    EXPECT_EQ(result.storage.overflowed, untimed.loaded().overflowed);
    EXPECT_LE(result.ray_store_peak, drawn.machine.ray_store);
    // Invariant 3: no message is lost.
    const Counters& c = result.counters;
    EXPECT_EQ(c.rays_sent, c.rays_answered + c.rays_silent + c.rays_destroyed);
    EXPECT_EQ(c.answers_sent, c.answers_delivered);
    EXPECT_EQ(c.loads_sent, c.loads_delivered);
    for (const Link& link : timed.array().links()) {
        for (int index = 0; index < link.classes(); ++index) {
            EXPECT_EQ(link.statistics(index).sent, link.statistics(index).delivered);
            EXPECT_LE(link.statistics(index).peak, drawn.machine.buffer_depth);
        }
    }
    // Without a postponement, the rays and their hops are the same too.
    const RayCounts& a = c.rays;
    const RayCounts& b = untimed.rays();
    EXPECT_EQ(a.primary, b.primary);
    EXPECT_EQ(a.reflected, b.reflected);
    EXPECT_EQ(a.refracted, b.refracted);
    EXPECT_EQ(a.shadow, b.shadow);
    EXPECT_EQ(a.precast, b.precast);
    EXPECT_EQ(a.lost, b.lost);
    EXPECT_EQ(a.exterior, b.exterior);
    if (c.rays_destroyed == 0) {
        EXPECT_EQ(a.ray_hops, b.ray_hops);
        EXPECT_EQ(a.return_hops, b.return_hops);
    }
}

INSTANTIATE_TEST_SUITE_P(Seed, TimedPicture, ::testing::Range<std::uint64_t>(1, 61));
// Regression: other rays for the same output went before the ray at the head of a buffer for ever.
INSTANTIATE_TEST_SUITE_P(Starvation, TimedPicture, ::testing::Values<std::uint64_t>(1130));

TEST(TimedSchedule, IsTheSameOnEveryRun) {
    // One elaboration per process: both machines are built before the first one runs.
    expect_first_elaboration();
    Drawn drawn = draw(7);
    drawn.scene = "still_life";
    drawn.settings = PictureSettings();
    drawn.settings.width = 16;
    drawn.settings.height = 12;
    const auto placed = place_own_scene(drawn.scene, drawn.settings);
    std::unique_ptr<Machine> first, second;
    first = std::make_unique<Machine>("first", placed->scene, drawn.settings, drawn.machine,
                                      placed->exterior.get());
    second = std::make_unique<Machine>("second", placed->scene, drawn.settings, drawn.machine,
                                       placed->exterior.get());
    const RunResult a = first->run();
    const RunResult b = second->run();
    EXPECT_EQ(a.schedule_hash, b.schedule_hash);
    EXPECT_EQ(a.trace_cycles, b.trace_cycles);
    EXPECT_EQ(image_hash(a.picture), image_hash(b.picture));
}

}  // namespace
}  // namespace raycell
