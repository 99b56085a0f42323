// Where the cube stands does not depend on how many pixels a cell has.
#include <cmath>

#include "model/tracing/tracing.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

Scene any_scene(Random& random) {
    Scene scene;
    View view;
    view.from = hand_made::random_point(random.engine(), -20, 20);
    view.at = view.from + random.uniform(5, 30) * hand_made::random_direction(random.engine());
    view.up = hand_made::random_direction(random.engine());
    view.angle = random.uniform(5, 90);
    scene.view = view;
    scene.materials.push_back(Material());
    for (int i = 0; i < 6; ++i) {
        const dvec3 centre = view.at + hand_made::random_point(random.engine(), -4, 4);
        scene.primitives.push_back({0, SpherePrimitive{centre, random.uniform(0.05, 2), false}});
    }
    return scene;
}

TEST(Blocks, LeaveTheCubeThePolygonsAndThePrimaryRaysWhereTheyAre) {
    for (const std::uint64_t seed : property::seeds(1, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Scene scene = any_scene(random);
        const int scale = 1 << random.whole(1, 4);
        PictureSettings coarse;
        coarse.numbers.arithmetic = random.chance(0.5) ? Numbers::exact : Numbers::fixed;
        coarse.numbers.word_bits = random.whole(16, 32);
        coarse.width = random.whole(2, 6);
        coarse.height = random.whole(2, 6);
        coarse.pixels_wide = scale * coarse.width;
        coarse.pixels_high = scale * coarse.height;
        PictureSettings fine = coarse;
        fine.width = coarse.pixels_wide;
        fine.height = coarse.pixels_high;
        const Frame blocks = place_frame(scene, coarse);
        const Frame plain = place_frame(scene, fine);
        EXPECT_EQ(plain.block(), 1);
        EXPECT_EQ(blocks.block(), scale * scale);
        EXPECT_EQ(blocks.cell_width, scale * plain.cell_width);
        EXPECT_EQ(blocks.depth * scale, plain.depth);
        EXPECT_EQ(blocks.eye * double(scale), plain.eye);
        const CellScene a = place_scene(scene, blocks, coarse);
        const CellScene b = place_scene(scene, plain, fine);
        ASSERT_EQ(a.polygons.size(), b.polygons.size()) << "the chord error is one of pixels";
        for (std::size_t i = 0; i < a.polygons.size(); ++i)
            ASSERT_EQ(a.polygons[i].vertices[0] * double(scale), b.polygons[i].vertices[0]);
        for (int row = 0; row < plain.height; ++row) {
            for (int column = 0; column < plain.width; ++column) {
                const dvec2 at = blocks.place_in_pixel(column, row);
                EXPECT_EQ(blocks.primary_ray(at.x, at.y).direction,
                          plain.primary_ray(column + 0.5, row + 0.5).direction);
            }
        }
    }
}

TEST(Blocks, HaveEachPixelOfThePictureOnceAndItsPrimaryRayStartsInItsCell) {
    for (const std::uint64_t seed : property::seeds(100, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        PictureSettings settings;
        settings.width = random.whole(1, 5);
        settings.height = random.whole(1, 5);
        settings.pixels_wide = settings.width * random.whole(1, 7);
        settings.pixels_high = settings.height * random.whole(1, 7);
        settings.numbers.word_bits = random.whole(8, 32);
        const Scene world = any_scene(random);
        const CellScene scene = place_scene(world, place_frame(world, settings), settings);
        const Context context(scene, settings);
        const Frame& frame = scene.frame;
        std::vector<int> seen(std::size_t(settings.pixels_wide) * std::size_t(settings.pixels_high), 0);
        for (int y = 0; y < frame.height; ++y) {
            for (int x = 0; x < frame.width; ++x) {
                for (int pixel = 0; pixel < frame.block(); ++pixel) {
                    const Ray ray = primary_ray(context, x, y, pixel);
                    const std::size_t index = pixel_of(ray.id);
                    ASSERT_EQ(index, frame.pixel_index(x, y, pixel));
                    ++seen.at(index);
                    EXPECT_EQ(ray.home_x, x);
                    EXPECT_EQ(ray.home_y, y);
                    EXPECT_GT(ray.position.x, 0);
                    EXPECT_LT(ray.position.x, 1);
                    const dvec2 centre = frame.place_in_pixel(int(index % std::size_t(settings.pixels_wide)),
                                                              int(index / std::size_t(settings.pixels_wide)));
                    const double last_bit = std::ldexp(1.0, 2 - settings.numbers.word_bits);
                    EXPECT_NEAR(x + ray.position.x, centre.x, last_bit);
                    EXPECT_NEAR(y + ray.position.y, centre.y, last_bit);
                }
            }
        }
        for (const int times : seen) EXPECT_EQ(times, 1);
    }
}

TEST(Blocks, AreRefusedWhereThePixelsAreNoWholeMultipleOfTheCells) {
    PictureSettings settings;
    settings.width = 16;
    settings.height = 8;
    settings.pixels_wide = 40;
    settings.pixels_high = 8;
    try {
        array_frame(settings);
        FAIL() << "40 columns by 16 cells";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "--pixels 40x8: expected a whole multiple of --cells 16x8 each way; the two "
                     "multiples may differ");
    }
    settings.pixels_wide = 48;
    EXPECT_EQ(array_frame(settings).block_width, 3);
    EXPECT_EQ(array_frame(settings).block_height, 1);
}

}  // namespace
}  // namespace raycell
