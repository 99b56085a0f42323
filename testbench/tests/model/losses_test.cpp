// Losses by fixed-point words, by cause.
#include "model/machine/losses.hpp"

#include "model/loading/loading.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

Losses losses_in(const CellScene& scene, int word_bits) {
    PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
    settings.numbers.word_bits = word_bits;
    return losses_of(Context(scene, settings));
}

TEST(Losses, CountWhatOfASceneIsBeyondItsFormat) {
    CellScene scene = shapes::empty_cube(8, 8, 16, 64);
    Material bright;
    bright.colour = {5, 0, 0};
    Material dense;
    dense.transmit = 0.5;
    dense.ior = 9;
    Material opaque = dense;  // the index does not matter where nothing is transmitted
    opaque.transmit = 0;
    scene.objects = {Material(), bright, dense, opaque};
    scene.sources = {{{0, 0, 0}, dvec3(1)}, {{0, 0, 0}, dvec3(30)}};
    const Losses losses = losses_in(scene, 20);
    EXPECT_EQ(losses.features, 1u);
    EXPECT_EQ(losses.indices, 1u);
    EXPECT_EQ(losses.lights, 1u);
    PictureSettings exact = shapes::settings_for(scene, HitTest::edge, Numbers::exact);
    const Losses none = losses_of(Context(scene, exact));
    EXPECT_EQ(none.features + none.indices + none.lights + none.single_normals, 0u);
    EXPECT_EQ(none.drift, 0);
}

TEST(Losses, OfADirectionsLastBitGrowWithTheDepthAndHalveWithEveryBit) {
    const CellScene shallow = shapes::empty_cube(8, 8, 16, 64);
    const CellScene deep = shapes::empty_cube(8, 8, 64, 64);
    EXPECT_DOUBLE_EQ(losses_in(deep, 20).drift, 4 * losses_in(shallow, 20).drift);
    EXPECT_DOUBLE_EQ(losses_in(deep, 19).drift, 2 * losses_in(deep, 20).drift);
}

TEST(Losses, NamePolygonsWithASingleNormalJustWhereTheVoxelHasOne) {
    for (const double width : {1e-5, 1e-4, 4e-4, 1e-3, 1e-2, 0.1}) {
        CellScene scene = shapes::empty_cube(4, 4, 8, 64);
        const dvec3 at(1.53, 1.47, 4.2);
        scene.polygons.push_back(make_triangle(0, 0, {at, at + dvec3(width, 0, 0), at + dvec3(0, width, 0)},
                                               {dvec3(0, 0, -1), dvec3(1, 0, 0), dvec3(0, 1, 0)}));
        const PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
        const Context context(scene, settings);
        const auto cells = load_array(scene, settings, context.arithmetic);
        const CellStore& store = cells[1 * 4 + 1];
        if (store.voxels.empty()) continue;  // the triangle falls between two words
        const NormalField& field = store.voxels[0].normal;
        const bool single = field.du == dvec3(0) && field.dv == dvec3(0);
        EXPECT_EQ(losses_of(context).single_normals, single ? 1u : 0u) << width;
    }
}

}  // namespace
}  // namespace raycell
