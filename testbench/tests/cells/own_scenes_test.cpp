// The project's own scenes on the untimed machine.
#include "elaboration.hpp"

namespace raycell {
namespace {

class OwnScene : public ::testing::TestWithParam<const char*> {};

TEST_P(OwnScene, HasTheSamePictureWithMemoAsWithPrecastShadows) {
    PictureSettings settings;
    settings.width = 40;
    settings.height = 32;
    const auto placed = place_own_scene(GetParam(), settings);
    settings.shadows = Shadows::precast;
    UntimedMachine precast(placed->scene, settings, placed->exterior.get());
    const auto expected = image_hash(precast.render());
    settings.shadows = Shadows::memo;
    UntimedMachine memo(placed->scene, settings, placed->exterior.get());
    EXPECT_EQ(image_hash(memo.render()), expected);
    EXPECT_LE(memo.rays().shadow, precast.rays().precast);
}

TEST_P(OwnScene, CountsEveryHopForItsPixelAndEveryRayOnce) {
    PictureSettings settings;
    settings.width = 32;
    settings.height = 40;
    const auto placed = place_own_scene(GetParam(), settings);
    UntimedMachine machine(placed->scene, settings, placed->exterior.get());
    const Picture picture = machine.render();
    std::uint64_t hops = 0;
    for (const Pixel& pixel : picture.pixels) hops += pixel.hops;
    EXPECT_EQ(hops, machine.rays().ray_hops + machine.rays().return_hops);
    EXPECT_EQ(machine.rays().primary, picture.pixels.size());
    for (const Pixel& pixel : picture.pixels) {
        EXPECT_TRUE(std::isfinite(pixel.colour.x) && std::isfinite(pixel.colour.y) &&
                    std::isfinite(pixel.colour.z));
        EXPECT_EQ(pixel.polygon == no_polygon, std::isinf(pixel.depth));
    }
}

TEST_P(OwnScene, SeesTheSameFirstPolygonsAsTheTruth) {
    PictureSettings settings;
    settings.width = settings.height = 48;
    settings.numbers.arithmetic = Numbers::exact;
    const auto placed = place_own_scene(GetParam(), settings);
    UntimedMachine machine(placed->scene, settings, placed->exterior.get());
    const Picture picture = machine.render();
    TruthSettings of_polygons;
    of_polygons.of = TruthOf::polygons;
    of_polygons.beyond = placed->truth.get();
    const Picture truth = TruthRenderer(placed->scene, of_polygons).render();
    int wrong = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Pixel& a = picture.pixels[i];
        const Pixel& b = truth.pixels[i];
        // A ray exactly through an edge, as on the diagonals of cornell, may hit either of its polygons.
        wrong += a.polygon != b.polygon && !(std::abs(a.depth - b.depth) < 1e-6);
    }
    EXPECT_EQ(wrong, 0) << "of " << picture.pixels.size() << " pixels";
}

INSTANTIATE_TEST_SUITE_P(Scene, OwnScene, ::testing::Values("cornell", "facing_mirrors", "still_life"));

}  // namespace
}  // namespace raycell
