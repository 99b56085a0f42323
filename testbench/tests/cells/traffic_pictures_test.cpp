// Synthetic traffic through the timed machine: the untimed picture, conserved messages and a verdict.
#include "elaboration.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {
namespace {

struct Drawn {
    TrafficSettings traffic;
    PictureSettings picture;
    MachineSettings machine;
    bool must_end = true;  ///< design, section 5: `half` or `quadrant`, enough reserved slots, `postpone`
    std::string text;
};

Drawn draw(std::uint64_t seed) {
    property::Random random(seed);
    Drawn drawn;
    TrafficSettings& t = drawn.traffic;
    t.hit_probability = random.uniform(0.02, 0.7);
    t.reflected = random.chance(0.4) ? 1 : random.uniform(0, 1);
    t.refracted = random.chance(0.6) ? 0 : random.uniform(0, 0.5);
    t.sources = random.chance(0.5) ? 0 : random.whole(1, 3);
    t.directions = Directions(random.whole(0, 3));
    t.turn_back = random.uniform(0, 1);
    t.seed = seed;
    const int width = random.chance(0.15) ? 1 : random.whole(2, 20);
    const int height = random.chance(0.15) ? 1 : random.whole(2, 20);
    drawn.picture = traffic_picture(width, height, random.whole(0, 4));
    MachineSettings& m = drawn.machine;
    property::Random blocks(seed + 5000000);  // of its own, so that the other draws stay what they were
    if (blocks.chance(0.4)) {
        drawn.picture.pixels_wide = width * blocks.whole(1, 3);
        drawn.picture.pixels_high = height * blocks.whole(1, 3);
        m.own_rays = blocks.whole(1, 5);
    }
    m.seed = seed;
    m.buffer_depth = random.whole(1, 4);
    m.link_bits = random.chance(0.3) ? random.whole(1, 8) : random.whole(9, 300);
    m.networks = random.chance(0.5) ? Networks::half : Networks::quadrant;
    const int least = std::max(drawn.picture.max_depth + (t.sources > 0 ? 1 : 0), 1);
    m.ray_store = random.chance(0.5) ? least : random.whole(least, 12);
    if (random.chance(0.4)) {
        drawn.must_end = false;
        m.networks = Networks(random.whole(0, 3));
        m.slots = Slots(random.whole(0, 1));
        m.recovery = Recovery(random.whole(0, 1));
        m.ray_store = random.whole(1, 8);
        m.max_cycles = 1000000;
    }
    for (const auto& [name, member] : CostTable::entries()) {
        if (random.chance(0.3)) m.costs.*member = std::uint32_t(random.whole(1, 60));
    }
    drawn.text = std::to_string(width) + "x" + std::to_string(height) + ", " +
                 std::to_string(drawn.picture.block()) + " pixels a cell, hits " +
                 std::to_string(t.hit_probability) + ", generations " +
                 std::to_string(drawn.picture.max_depth) + ", sources " + std::to_string(t.sources) +
                 ", directions " + std::to_string(int(t.directions)) + ", M " + std::to_string(m.ray_store) +
                 ", buffers " + std::to_string(m.buffer_depth) + ", networks " +
                 std::to_string(int(m.networks)) + ", recovery " + std::to_string(int(m.recovery));
    return drawn;
}

void expect_finished_pixels_equal(const Picture& picture, const Picture& golden) {
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (picture.pixels[i].cycle == 0) continue;
        ASSERT_EQ(picture.pixels[i].colour, golden.pixels[i].colour) << "pixel " << i;
        ASSERT_EQ(picture.pixels[i].polygon, golden.pixels[i].polygon) << "pixel " << i;
    }
}

class TimedTraffic : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(TimedTraffic, GivesTheUntimedPictureAndConservesMessages) {
    expect_first_elaboration();
    const std::uint64_t seed = property::seeds(GetParam(), 1)[0];
    const Drawn drawn = draw(seed);
    SCOPED_TRACE(drawn.text + "; " + property::rerun(seed));
    const SyntheticTraffic traffic(drawn.traffic);
    const CellScene scene = traffic_scene(drawn.picture, drawn.traffic);
    UntimedMachine untimed(scene, drawn.picture, nullptr, &traffic);
    const Picture golden = untimed.render();
    Machine timed("machine", scene, drawn.picture, drawn.machine, nullptr, &traffic);
    const RunResult result = timed.run();
    const Counters& c = result.counters;
    expect_finished_pixels_equal(result.picture, golden);
    EXPECT_LE(result.ray_store_peak, drawn.machine.ray_store);
    if (result.verdict != Verdict::completed) {
        EXPECT_FALSE(drawn.must_end) << name_of(result.verdict);
        EXPECT_EQ(c.rays_sent - c.rays_answered - c.rays_silent - c.rays_destroyed,
                  timed.environment().pools.rays.in_use())
            << "what is not answered is still there";
        EXPECT_EQ(c.answers_sent - c.answers_delivered, timed.environment().pools.answers.in_use());
        return;
    }
    EXPECT_EQ(image_hash(result.picture), image_hash(golden));
    EXPECT_EQ(c.rays_sent, c.rays_answered + c.rays_destroyed);
    EXPECT_EQ(c.answers_sent, c.answers_delivered);
    const RayCounts& a = c.rays;
    const RayCounts& b = untimed.rays();
    EXPECT_EQ(a.primary, b.primary);
    EXPECT_EQ(a.reflected, b.reflected);
    EXPECT_EQ(a.refracted, b.refracted);
    EXPECT_EQ(a.shadow, b.shadow);
    EXPECT_EQ(a.lost, b.lost);
    if (c.rays_destroyed == 0) {
        EXPECT_EQ(a.ray_hops, b.ray_hops);
        EXPECT_EQ(a.return_hops, b.return_hops);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, TimedTraffic, ::testing::Range<std::uint64_t>(1, 61));

}  // namespace
}  // namespace raycell
