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
    array.key = loading_key(scene, settings);
    array.timing = loading_timing(MachineSettings());
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
        EXPECT_EQ(again.timing, array.timing);
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

/// Every setting that voxels depend on, changed alone.
TEST(ArrayFile, TheKeyTellsApartWhatVoxelsDependOn) {
    const CellScene scene = scene_of(3);
    const PictureSettings picture;
    const std::uint64_t key = loading_key(scene, picture);
    EXPECT_EQ(loading_key(scene, picture), key);
    const auto changed = [&](auto change) {
        PictureSettings other = picture;
        change(other);
        return loading_key(scene, other);
    };
    EXPECT_NE(changed([](PictureSettings& p) { p.hit = HitTest::mask; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.normals = Normals::voxel; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.display = Display::gouraud; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.voxel_capacity = 9; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.numbers.word_bits = 21; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.numbers.arithmetic = Numbers::exact; }), key);
    EXPECT_NE(changed([](PictureSettings& p) { p.numbers.rounding = Rounding::truncate; }), key);
    const auto other_scene = [&](auto change) {
        CellScene other = scene;
        change(other);
        return loading_key(other, picture);
    };
    EXPECT_NE(other_scene([](CellScene& s) { s.frame.depth_levels *= 2; }), key);
    EXPECT_NE(other_scene([](CellScene& s) { s.frame.width += 1; }), key);
    EXPECT_NE(other_scene([](CellScene& s) { s.frame.depth += 1e-9; }), key);
    EXPECT_NE(other_scene([](CellScene& s) { s.polygons.at(0).vertices.at(0).x += 1e-9; }), key);
    EXPECT_NE(other_scene([](CellScene& s) { s.objects.at(0).shine += 1; }), key);
    EXPECT_NE(other_scene([](CellScene& s) { s.sources.emplace_back(); }), key);

    EXPECT_EQ(changed([](PictureSettings& p) {
                  p.max_depth = 9, p.min_weight = 0.1, p.shadows = Shadows::memo, p.stage = RunStage::load;
                  p.exterior = ExteriorMode::none, p.normal_offset = 0.1;
                  p.numbers.operators.root = Iteration::table;
              }),
              key)
        << "what only tracing depends on";
}

TEST(ArrayFile, TheTimingTellsApartWhatItsCyclesDependOn) {
    const std::uint64_t timing = loading_timing(MachineSettings());
    const auto changed = [](auto change) {
        MachineSettings other;
        change(other);
        return loading_timing(other);
    };
    EXPECT_NE(changed([](MachineSettings& m) { m.link_bits = 19; }), timing);
    EXPECT_NE(changed([](MachineSettings& m) { m.buffer_depth = 2; }), timing);
    EXPECT_NE(changed([](MachineSettings& m) { m.costs.load_voxel = 13; }), timing);
    EXPECT_NE(changed([](MachineSettings& m) { m.costs.geometry_polygon = 41; }), timing);
    EXPECT_EQ(changed([](MachineSettings& m) {
                  m.ray_store = 3, m.networks = Networks::quadrant, m.costs.walk_step = 9, m.seed = 7;
              }),
              timing)
        << "what only tracing depends on";
}

}  // namespace
}  // namespace raycell
