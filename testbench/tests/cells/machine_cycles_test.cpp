// Cycle counts of small machines, derived by hand from the cost table and the bits of the messages.
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {
namespace {

/// A row of cells seen by a viewer at infinity. A source in the last cell lights a square in the middle of
/// cell 0, at depth 4. Only one shadow ray and its verdict travel, over all cells.
struct Row {
    explicit Row(int cells, double source_y = 0.5) {
        expect_first_elaboration();
        scene = hand_made::cube(cells, 1, 8);
        scene.frame.depth_levels = 64;
        scene.objects.push_back(hand_made::matt(0.8));
        hand_made::add_rectangle(scene, 0, {0.25, 0.25, 4}, {0, 0.5, 0}, {0.5, 0, 0});
        scene.sources.push_back({{cells - 0.5, source_y, 2}, dvec3(1)});
        settings.width = cells;
        settings.height = 1;
        settings.depth_levels = 64;
        settings.exterior = ExteriorMode::none;
    }
    RunResult run() {
        Machine built("machine", scene, settings, machine, nullptr);
        return built.run();
    }
    CellScene scene;
    PictureSettings settings;
    MachineSettings machine = estimated_machine();
};

/// Bits of a shadow ray: type 3, place (x and y one word each, z 3 bits more for depths to 8), direction 3
/// words, two reciprocals of a word and a 6-bit exponent, reach 1 word, polygon 20, address 13 (home 3 + 0,
/// slot 3 + 1, child 6), flags 3.
constexpr int shadow_ray_bits = 3 + (2 * 20 + 23) + 3 * 20 + 2 * 26 + 20 + 20 + 13 + 3;
/// Bits of a verdict: type 3, address 13.
constexpr int verdict_bits = 3 + 13;

TEST(TimedCycles, AShadowRayAndItsVerdictTakeTheCyclesOfTheCostTable) {
    Row row(8);
    const RunResult result = row.run();
    ASSERT_EQ(result.verdict, Verdict::completed);
    const int ray_link = (shadow_ray_bits + 19) / 20;
    const int verdict_link = (verdict_bits + 19) / 20;
    ASSERT_EQ(ray_link, 12);
    ASSERT_EQ(verdict_link, 1);
    // The primary ray starts in cycle 1. One voxel: walk 4, run 2, edge test 8, four edges of 2.
    int t = 1 + (4 + 2 + 8 + 4 * 2);
    // Set-up 20, linear normal 7 + 1/sqrt 5, view of one source 11 + 1/sqrt 5, start of its ray 2 · 1/x 4.
    t += 20 + 12 + 16 + 8;
    // The shadow ray passes the voxel that it leaves: walk 4, run 2. Then the link.
    t += (4 + 2) + ray_link;
    // Six empty cells: walk 4 and the link; in the eighth cell the ray ends after its walk step.
    t += 6 * (4 + ray_link) + 4;
    // The verdict starts there. Six cells route it (1) and send it on; cell 0 routes (1) and delivers it.
    t += verdict_link + 6 * (1 + verdict_link) + 1;
    // Intensity 6 and one lit source 20; cell 0 is the pixel's own.
    t += 6 + 20;
    EXPECT_EQ(result.picture.at(0, 0).cycle, std::uint32_t(t));
    EXPECT_EQ(result.picture.at(0, 0).hops, 14u);
    // All other pixels see background: one walk step.
    for (int x = 1; x < 8; ++x) EXPECT_EQ(result.picture.at(x, 0).cycle, 5u);
    EXPECT_EQ(result.counters.rays.shadow, 1u);
    EXPECT_EQ(result.counters.rays.ray_hops, 7u);
    EXPECT_EQ(result.counters.rays.return_hops, 7u);
}

/// Raises the route cycles from 1 to 11 to count them: one for each of the seven inputs that the verdict
/// passes.
TEST(TimedCycles, EveryHopOfAReturnCostsTheRouteCyclesOfTheTable) {
    Row row(8);
    row.machine.costs.route_return = 11;
    const RunResult result = row.run();
    const int before_the_way_back = 1 + 22 + 56 + (6 + 12) + 6 * 16 + 4;
    EXPECT_EQ(result.picture.at(0, 0).cycle, std::uint32_t(before_the_way_back + 1 + 6 * (11 + 1) + 11 + 26));
}

TEST(TimedCycles, APrecastRayTakesAWalkStepAndItsLinkCyclesPerHop) {
    Row row(8);
    row.settings.shadows = Shadows::precast;
    const RunResult result = row.run();
    ASSERT_EQ(result.verdict, Verdict::completed);
    // The ray's address names a voxel in 10 bits instead of a slot in 4: 240 bits, 12 cycles on the link.
    // In cell 0, from cycle 1: walk 4 and run 2; then the link 12. Six cells of 4 + 12; the eighth ends the
    // ray silently after 4.
    EXPECT_EQ(result.precast_cycles, Cycle(1 + 6 + 12 + 6 * 16 + 4));
    EXPECT_EQ(result.counters.rays_silent, 1u);
    EXPECT_EQ(result.counters.rays.precast, 1u);
    // A hit that waits for nothing and sends nothing takes no slot: test 22, set-up 48, shading 26.
    EXPECT_EQ(result.picture.at(0, 0).cycle, 1u + 22u + 48u + 26u);
    EXPECT_EQ(result.ray_store_peak, 0);
}

TEST(TimedCycles, NarrowLinksTakeLonger) {
    Row row(8);
    row.settings.shadows = Shadows::precast;
    row.machine.link_bits = 7;  // 240 bits: 35 cycles
    const RunResult result = row.run();
    EXPECT_EQ(result.precast_cycles, Cycle(1 + 6 + 35 + 6 * (4 + 35) + 4));
}

/// Loads one polygon over the whole row; no source.
struct Loading : Row {
    explicit Loading(int cells) : Row(cells) {
        scene.sources.clear();
        scene.polygons.clear();
        hand_made::add_rectangle(scene, 0, {0.25, 0.25, 4}, {0, 0.5, 0}, {cells - 0.5, 0, 0});
        settings.stage = RunStage::load;
    }
    /// Cycle in which the last cell has made its voxel and loading is complete.
    Cycle expected() const {
        const int columns = 2 * int(std::ceil(std::log2(settings.width)));
        // Link cycles of 217 bits (type 3, viewer 103, faces 6, background 60, levels 38, sources 7) and of
        // 104 (type 3, features 101).
        const int setup = 11;
        // Geometry starts in cycle 1. The set-up is ready in 2 and sent. The features wait for the wires
        // until 13 and arrive at 19. The polygon, taken up in 14, needs 1 + 40 and leaves in 55. It has type
        // 3, id 20, plane and slack 147, normals 324, a count of 16 and 4 corners of 3 loading words of 36:
        // 942 bits, 48 cycles.
        const int polygon_arrives = 2 + setup + 1 + 1 + 40 + 48;
        EXPECT_EQ(polygon_arrives, 103);
        // What its trapezes share leaves a cycle later: 3 + 20 + 147 + 324 = 494 bits, 25 cycles. The trapeze
        // is ready 20 cycles after that and waits for the wires; it has 3 + columns + 3 + 432 bits.
        const int trapeze_arrives = polygon_arrives + 1 + 25 + (438 + columns + 19) / 20;
        // The row cuts its span in 8 cycles; a span is 3 + 20 + columns + 147 + 324 + 435 bits.
        const int span_link = (929 + columns + 19) / 20;
        const int span_arrives = trapeze_arrives + 8 + span_link;
        // Each cell keeps the span for its voxel and passes it on after 1 cycle.
        const int span_kept = span_arrives + (settings.width - 1) * (1 + span_link) + 1;
        // The last one makes its voxel in 12 cycles and puts it in order in one. The end-of-scene mark is
        // there before: it is sent in the cycle after that in which the last buffer was emptied and takes one
        // cycle on the wires and one in the cell.
        return Cycle(span_kept + 12 + 1);
    }
};

TEST(TimedCycles, OneSpanIsLoadedCellByCellInOneCell) {
    Loading row(1);
    const Cycle expected = row.expected();
    const RunResult result = row.run();
    EXPECT_EQ(result.load_cycles, expected);
    EXPECT_EQ(result.storage.voxels, 1u);
}

TEST(TimedCycles, OneSpanIsLoadedCellByCellInEight) {
    Loading row(8);
    const Cycle expected = row.expected();
    const RunResult result = row.run();
    EXPECT_EQ(result.load_cycles, expected);
    EXPECT_EQ(result.storage.voxels, 8u);
    EXPECT_EQ(result.distribution.items, 1u);
    EXPECT_EQ(result.precomputation.items, 1u);
    EXPECT_EQ(result.geometry.items, 1u);
    // Set-up, features, span and end mark, each over seven links.
    EXPECT_EQ(result.counters.load_hops, 4u * 7u);
    EXPECT_EQ(result.counters.loads_sent, 4u);
    EXPECT_EQ(result.counters.loads_delivered, 4u);
}

TEST(TimedCycles, OneSpanIsLoadedCellByCellInThirty) {
    Loading row(30);
    const Cycle expected = row.expected();
    EXPECT_EQ(row.run().load_cycles, expected);
}

}  // namespace
}  // namespace raycell
