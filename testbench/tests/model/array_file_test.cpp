// Loaded arrays as files: every bit comes back, and damage is found.
#include "model/array_file.hpp"

#include <cstdio>
#include <memory>

#include "../property.hpp"
#include "../truth/hand_made.hpp"
#include "model/loading.hpp"

namespace raycell {
namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

CellScene scene_of(std::uint64_t seed) {
    property::Random random(seed);
    CellScene scene = hand_made::cube(random.whole(1, 6), random.whole(1, 6), random.uniform(1, 9));
    scene.frame.depth_levels = 12;
    for (int i = random.whole(0, 5); i > 0; --i) {
        const auto object = hand_made::add_object(scene, hand_made::matt(0.5));
        const dvec3 corner{random.uniform(-1, 5), random.uniform(-1, 5), random.uniform(0, 8)};
        hand_made::add_rectangle(scene, object, corner, hand_made::random_direction(random.engine()) * 3.0,
                                 hand_made::random_direction(random.engine()) * 2.0);
    }
    return scene;
}

LoadedArray array_of(const CellScene& scene, const PictureSettings& settings) {
    LoadedArray array;
    array.key = loading_key(scene, settings, MachineSettings());
    array.cells = load_array(scene, settings, Arithmetic(settings.numbers, extent_of(scene.frame)));
    array.counts = {1, 2, ~std::uint64_t(0)};
    return array;
}

std::string bytes_of(const LoadedArray& array) {
    const File file(std::tmpfile());
    write_array(file.get(), array);
    std::string bytes(std::size_t(std::ftell(file.get())), '\0');
    std::rewind(file.get());
    EXPECT_EQ(std::fread(bytes.data(), 1, bytes.size(), file.get()), bytes.size());
    return bytes;
}

LoadedArray array_from(const std::string& bytes) {
    const File file(std::tmpfile());
    std::fwrite(bytes.data(), 1, bytes.size(), file.get());
    std::rewind(file.get());
    return read_array(file.get(), "array");
}

TEST(ArrayFile, EveryBitComesBack) {
    for (const std::uint64_t seed : property::seeds(1, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        PictureSettings settings;
        settings.hit = HitTest(seed % 5);
        if (seed % 3 == 0) settings.numbers.arithmetic = Numbers::exact;
        const CellScene scene = scene_of(seed);
        const LoadedArray array = array_of(scene, settings);
        const std::string bytes = bytes_of(array);
        const LoadedArray again = array_from(bytes);
        EXPECT_EQ(again.key, array.key);
        EXPECT_EQ(again.counts, array.counts);
        ASSERT_EQ(again.cells.size(), array.cells.size());
        EXPECT_EQ(bytes_of(again), bytes);
        for (std::size_t i = 0; i < array.cells.size(); ++i) {
            ASSERT_EQ(again.cells[i].voxels.size(), array.cells[i].voxels.size());
            for (std::size_t v = 0; v < array.cells[i].voxels.size(); ++v) {
                const Voxel& a = array.cells[i].voxels[v];
                const Voxel& b = again.cells[i].voxels[v];
                EXPECT_EQ(a.plane.n, b.plane.n);
                EXPECT_EQ(a.mask, b.mask);
                EXPECT_EQ(a.window, b.window);
                EXPECT_EQ(a.far_level, b.far_level);
                EXPECT_EQ(a.normal.dv, b.normal.dv);
                EXPECT_EQ(a.point, b.point);
            }
        }
    }
}

TEST(ArrayFile, DamageIsFoundWhereverItIs) {
    const std::string bytes = bytes_of(array_of(scene_of(3), PictureSettings()));
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        std::string damaged = bytes;
        const auto at = std::size_t(random.whole(0, int(bytes.size()) - 1));
        if (random.chance(0.3)) {
            damaged.resize(at);
        } else if (random.chance(0.2)) {
            damaged += 'x';
        } else {
            damaged[at] = char(damaged[at] ^ 1 << random.whole(0, 7));
        }
        EXPECT_THROW(array_from(damaged), std::runtime_error) << "at " << at;
    }
    EXPECT_THROW(array_from(""), std::runtime_error);
}

TEST(ArrayFile, TheKeyTellsApartWhatLoadingDependsOn) {
    const CellScene scene = scene_of(3);
    const PictureSettings picture;
    const MachineSettings machine;
    const std::uint64_t key = loading_key(scene, picture, machine);
    EXPECT_EQ(loading_key(scene, picture, machine), key);
    CellScene moved = scene;
    moved.polygons.at(0).vertices.at(0).x += 1e-9;
    EXPECT_NE(loading_key(moved, picture, machine), key);
    PictureSettings other = picture;
    other.numbers.word_bits = 21;
    EXPECT_NE(loading_key(scene, other, machine), key);
    MachineSettings narrow = machine;
    narrow.link_bits = 19;
    EXPECT_NE(loading_key(scene, picture, narrow), key);
    MachineSettings tracing = machine;
    tracing.ray_store = 3;
    tracing.networks = Networks::quadrant;
    tracing.costs.walk_step = 9;
    other = picture;
    other.max_depth = 9;
    EXPECT_EQ(loading_key(scene, other, tracing), key) << "what only tracing depends on";
}

}  // namespace
}  // namespace raycell
