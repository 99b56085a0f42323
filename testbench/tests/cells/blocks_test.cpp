// Cells that own a block of pixels: the picture does not depend on how many cells there are.
#include "elaboration.hpp"
#include "model/picture/compare.hpp"

namespace raycell {
namespace {

PictureSettings exact(int cells, int pixels) {
    PictureSettings settings;
    settings.width = settings.height = cells;
    settings.pixels_wide = settings.pixels_high = pixels;
    settings.numbers.arithmetic = Numbers::exact;
    settings.normal_offset = 0;
    return settings;
}

class Blocks : public ::testing::TestWithParam<const char*> {};

TEST_P(Blocks, InExactArithmeticGiveThePictureOfAsManyCellsAsPixels) {
    constexpr int pixels = 64;
    const auto render = [](const PictureSettings& settings) {
        const auto placed = place_own_scene(GetParam(), settings);
        return UntimedMachine(placed->scene, settings, placed->exterior.get()).render();
    };
    const Picture whole = render(exact(pixels, 0));
    for (const int cells : {1, 2, 4, 8, 16, 32}) {
        SCOPED_TRACE(std::to_string(cells) + " cells each way");
        const Picture picture = render(exact(cells, pixels));
        ASSERT_EQ(picture.width, pixels);
        ASSERT_EQ(picture.height, pixels);
        const Accuracy accuracy = compare(picture, whole);
        std::cout << GetParam() << " of " << cells << "x" << cells << " cells: " << accuracy.psnr_db
                  << " dB\n";
        EXPECT_GT(accuracy.psnr_db, 150);
        EXPECT_EQ(accuracy.wrong_hit_percent, 0);
    }
}

TEST_P(Blocks, NeedNotBeSquareAndAreMetByTheTruthAtTheSamePixels) {
    PictureSettings settings = exact(8, 0);
    settings.height = 6;
    settings.pixels_wide = 40;
    settings.pixels_high = 18;
    const auto placed = place_own_scene(GetParam(), settings);
    const Picture picture = UntimedMachine(placed->scene, settings, placed->exterior.get()).render();
    const TruthRenderer polygons(placed->scene, {settings.max_depth, settings.min_weight, false,
                                                 TruthOf::polygons, placed->truth.get()});
    const Picture truth = polygons.render();
    ASSERT_EQ(picture.pixels.size(), std::size_t(40 * 18));
    EXPECT_GT(compare(picture, truth).psnr_db, 150);
}

INSTANTIATE_TEST_SUITE_P(OfOwnScenes, Blocks, ::testing::Values("cornell", "facing_mirrors", "still_life"));

TEST(TimedBlocks, GiveTheUntimedPictureWhateverTheNumberOfOwnRays) {
    expect_first_elaboration();
    PictureSettings settings;
    settings.width = 8;
    settings.height = 6;
    settings.pixels_wide = 32;
    settings.pixels_high = 18;
    const auto placed = place_own_scene("cornell", settings);
    const std::uint64_t golden =
        image_hash(UntimedMachine(placed->scene, settings, placed->exterior.get()).render());
    std::vector<std::unique_ptr<Machine>> machines;
    for (const int own_rays : {1, 2, 5, most_own_rays}) {
        MachineSettings machine;
        machine.own_rays = own_rays;
        machine.wire_check = true;  // the number of an own ray is in the messages
        machines.push_back(std::make_unique<Machine>(("own_" + std::to_string(own_rays)).c_str(),
                                                     placed->scene, settings, machine,
                                                     placed->exterior.get()));
    }
    for (const auto& machine : machines) {
        const RunResult result = machine->run();
        EXPECT_EQ(name_of(result.verdict), std::string("completed"));
        EXPECT_EQ(image_hash(result.picture), golden);
        EXPECT_EQ(result.counters.rays.primary, 32u * 18);
        EXPECT_EQ(result.counters.pixels_done, 32u * 18);
        EXPECT_GT(machine->longest_tree().cycles, 0u) << "each pixel's tree can be traced once more";
    }
}

TEST(TimedBlocks, ShowTheirNearestVoxelsAfterLoading) {
    expect_first_elaboration();
    PictureSettings settings = exact(6, 24);
    settings.stage = RunStage::load;
    PictureSettings gouraud = settings;
    gouraud.display = Display::gouraud;
    const auto placed = place_own_scene("still_life", settings);
    Machine first("phong", placed->scene, settings, {}, nullptr);
    Machine second("gouraud", placed->scene, gouraud, {}, nullptr);
    const Picture picture = first.run().picture;
    EXPECT_EQ(image_hash(picture), image_hash(UntimedMachine(placed->scene, settings, nullptr).render()));
    EXPECT_EQ(image_hash(second.run().picture),
              image_hash(UntimedMachine(placed->scene, gouraud, nullptr).render()));
    // A pixel shows the same surface from any number of cells.
    PictureSettings plain = exact(24, 0);
    plain.stage = RunStage::load;
    const auto fine = place_own_scene("still_life", plain);
    EXPECT_GT(compare(picture, UntimedMachine(fine->scene, plain, nullptr).render()).psnr_db, 150);
}

}  // namespace
}  // namespace raycell
