// A user's own cells in a running array: picture and cycles equal those of the array's own cells.
#include "testbench/own_cell/own_cell.hpp"

#include "elaboration.hpp"

namespace raycell {
namespace {

/// Runs a scene with own cells in all places without voxels, on each kind of network.
class OwnCells : public ::testing::TestWithParam<std::tuple<const char*, Networks, int, int>> {};

TEST_P(OwnCells, InPlaceOfEmptyOnesChangeNeitherThePictureNorAnyCycle) {
    expect_first_elaboration();
    const auto& [scene, networks, depth, block] = GetParam();
    PictureSettings settings;
    settings.width = settings.height = 24;
    settings.pixels_wide = settings.pixels_high = 24 * block;
    MachineSettings machine;
    machine.own_rays = 2;
    machine.networks = networks;
    machine.buffer_depth = depth;
    machine.ray_store = 5;  // some rays are postponed and sent again
    const auto placed = place_own_scene(scene, settings);
    const UntimedMachine untimed(placed->scene, settings, placed->exterior.get());
    int own = 0;
    Granularity granularity;
    granularity.own_cells = [&](const char* name, Environment& environment, int x, int y) {
        std::unique_ptr<CellSocket> cell;
        const CellStore& store = untimed.cells()[std::size_t(y * 24 + x)];
        if (store.voxels.empty() && store.overflowed == 0) {
            cell = std::make_unique<OwnCell>(name, environment, x, y);
            ++own;
        }
        return cell;
    };
    Machine plain("plain", placed->scene, settings, machine, placed->exterior.get());
    Machine mixed("mixed", placed->scene, settings, machine, placed->exterior.get(), nullptr, granularity);
    const RunResult expected = plain.run();
    const RunResult result = mixed.run();
    EXPECT_GT(own, 50) << "else this tests little";
    EXPECT_LT(own, 24 * 24);
    EXPECT_EQ(name_of(result.verdict), std::string("completed"));
    EXPECT_EQ(image_hash(result.picture), image_hash(expected.picture));
    EXPECT_EQ(result.load_cycles, expected.load_cycles);
    EXPECT_EQ(result.trace_cycles, expected.trace_cycles);
    EXPECT_EQ(result.counters.rays.ray_hops, expected.counters.rays.ray_hops);
    EXPECT_EQ(result.counters.rays.return_hops, expected.counters.rays.return_hops);
    EXPECT_EQ(result.counters.rays_sent, expected.counters.rays_sent);
    EXPECT_EQ(result.counters.rays_destroyed, expected.counters.rays_destroyed);
    EXPECT_GT(result.counters.rays.exterior, 0u);
    for (std::size_t i = 0; i < expected.picture.pixels.size(); ++i)
        ASSERT_EQ(result.picture.pixels[i].cycle, expected.picture.pixels[i].cycle) << "pixel " << i;
}

INSTANTIATE_TEST_SUITE_P(OnScenes, OwnCells,
                         ::testing::Combine(::testing::Values("still_life", "facing_mirrors"),
                                            ::testing::Values(Networks::half, Networks::quadrant),
                                            ::testing::Values(1, 3), ::testing::Values(1)));
INSTANTIATE_TEST_SUITE_P(OfBlocksOfPixels, OwnCells,
                         ::testing::Combine(::testing::Values("still_life"),
                                            ::testing::Values(Networks::half), ::testing::Values(1),
                                            ::testing::Values(2)));

}  // namespace
}  // namespace raycell
