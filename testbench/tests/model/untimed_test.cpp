// The untimed machine on scenes made by hand.
#include "model/machine/untimed.hpp"

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

PictureSettings settings_of(const CellScene& scene) {
    return shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
}

TEST(Untimed, MemoAndPrecastGiveTheSamePictureBitForBitAtEveryRung) {
    for (const std::uint64_t seed : property::seeds(1, 25)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const CellScene scene = shapes::still_life(random);
        PictureSettings settings = settings_of(scene);
        settings.hit = HitTest(random.whole(0, 4));
        settings.normals = Normals(random.whole(0, 1));
        if (random.chance(0.3)) settings.numbers.arithmetic = Numbers::exact;
        settings.numbers.word_bits = random.whole(8, 32);
        settings.shadows = Shadows::precast;
        const auto precast = image_hash(UntimedMachine(scene, settings, nullptr).render());
        settings.shadows = Shadows::memo;
        EXPECT_EQ(image_hash(UntimedMachine(scene, settings, nullptr).render()), precast)
            << "rung " << int(settings.hit);
    }
}

TEST(Untimed, EveryRayEndsAndEveryHopIsCountedForItsPixel) {
    for (const std::uint64_t seed : property::seeds(100, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const CellScene scene = shapes::still_life(random);
        PictureSettings settings = settings_of(scene);
        settings.shadows = random.chance(0.5) ? Shadows::per_hit : Shadows::memo;
        if (random.chance(0.3)) settings.numbers.arithmetic = Numbers::exact;
        UntimedMachine machine(scene, settings, nullptr);
        const Picture picture = machine.render();
        const RayCounts& rays = machine.rays();
        std::uint64_t hops = 0;
        for (const Pixel& pixel : picture.pixels) hops += pixel.hops;
        EXPECT_EQ(rays.primary, picture.pixels.size());
        EXPECT_EQ(hops, rays.ray_hops + rays.return_hops);
        EXPECT_LE(rays.lost, rays.primary + rays.reflected + rays.refracted + rays.shadow);
        EXPECT_EQ(rays.exterior, 0u);
        EXPECT_EQ(rays.precast, 0u);
        EXPECT_EQ(machine.loaded().voxels, [&] {
            std::uint64_t sum = 0;
            for (const CellStore& cell : machine.cells()) sum += cell.voxels.size();
            return sum;
        }());
    }
}

TEST(Untimed, AnEmptySceneIsBackground) {
    CellScene scene = shapes::empty_cube(5, 3, 4, 16);
    scene.background = {0.25, 0.5, 0.75};
    const PictureSettings settings = settings_of(scene);  // must outlive the machine
    UntimedMachine machine(scene, settings, nullptr);
    for (const Pixel& pixel : machine.render().pixels) {
        EXPECT_EQ(pixel.colour, scene.background);
        EXPECT_EQ(pixel.polygon, no_polygon);
        EXPECT_EQ(pixel.depth, std::numeric_limits<double>::infinity());
    }
    EXPECT_EQ(machine.rays().lost, 15u);
}

TEST(Untimed, APolygonFacingTheViewerIsSeenWhereItIs) {
    CellScene scene = shapes::empty_cube(6, 4, 8, 64);
    hand_made::add_rectangle(scene, 0, {1, 1, 3}, {3, 0, 0}, {0, 2, 0});
    const PictureSettings settings = settings_of(scene);  // must outlive the machine
    UntimedMachine machine(scene, settings, nullptr);
    const Picture picture = machine.render();
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 6; ++x) {
            const bool covered = x >= 1 && x < 4 && y >= 1 && y < 3;
            EXPECT_EQ(picture.at(x, y).polygon, covered ? 0u : no_polygon) << x << ", " << y;
            if (covered) {
                EXPECT_NEAR(picture.at(x, y).depth, 3, 1e-12);
            }
        }
    }
}

TEST(Untimed, DepthAndWeightLimitTheTree) {
    // Two facing mirrors across the view: a primary ray that enters at a slant bounces until a limit cuts it.
    CellScene scene = shapes::empty_cube(8, 8, 40, 400);
    scene.frame.viewer_at_infinity = false;
    scene.frame.eye = {-8, 4, -20};
    scene.objects[0] = hand_made::mirror(0.5);
    hand_made::add_rectangle(scene, 0, {7.5, -0.0, 0.5}, {0, 8, 0}, {0, 0, 39});
    hand_made::add_rectangle(scene, 0, {0.25, 0, 0.5}, {0, 8, 0}, {0, 0, 39});
    PictureSettings settings = settings_of(scene);
    std::uint64_t before = 0;
    for (int depth = 0; depth <= 3; ++depth) {
        settings.max_depth = depth;
        settings.min_weight = 0;
        UntimedMachine machine(scene, settings, nullptr);
        machine.render();
        if (depth == 0) {
            EXPECT_EQ(machine.rays().reflected, 0u);
        } else {
            EXPECT_GT(machine.rays().reflected, before) << "depth " << depth;
        }
        before = machine.rays().reflected;
    }
    settings.max_depth = 62;
    settings.min_weight = 0.25;  // 0.5 and 0.25 are sent, 0.125 is not
    UntimedMachine by_weight(scene, settings, nullptr);
    by_weight.render();
    settings.max_depth = 2;
    settings.min_weight = 0;
    UntimedMachine by_depth(scene, settings, nullptr);
    by_depth.render();
    EXPECT_EQ(by_weight.rays().reflected, by_depth.rays().reflected);
}

TEST(Untimed, TheHostExteriorNeedsATracer) {
    CellScene scene = shapes::empty_cube(2, 2, 2, 4);
    PictureSettings settings = settings_of(scene);
    settings.exterior = ExteriorMode::host;
    EXPECT_THROW(UntimedMachine(scene, settings, nullptr), std::invalid_argument);
}

TEST(Untimed, TheDisplayAfterLoadingShowsTheNearestVoxel) {
    for (const Display display : {Display::phong, Display::gouraud}) {
        CellScene scene = shapes::empty_cube(6, 4, 8, 64);
        hand_made::add_rectangle(scene, 0, {0, 0, 6}, {6, 0, 0}, {0, 4, 0});
        hand_made::add_rectangle(scene, 0, {1, 1, 3}, {3, 0, 0}, {0, 2, 0});
        scene.sources.push_back({{3, 2, -100}, dvec3(1)});
        PictureSettings settings = settings_of(scene);
        settings.stage = RunStage::load;
        settings.display = display;
        UntimedMachine machine(scene, settings, nullptr);
        const Picture picture = machine.render();
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 6; ++x) {
                const bool covered = x >= 1 && x < 4 && y >= 1 && y < 3;
                EXPECT_EQ(picture.at(x, y).polygon, covered ? 1u : 0u);
                // Lit from straight ahead: ambient and nearly all of the diffuse term.
                EXPECT_NEAR(picture.at(x, y).colour.x, 0.8 * 1.1, 2e-3);
            }
        }
        EXPECT_EQ(machine.rays().primary, 0u);
    }
}

}  // namespace
}  // namespace raycell
