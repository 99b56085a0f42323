// Files of loaded arrays: every bit is read back, and damage is found.
#include "model/files/array_file.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include "../property.hpp"
#include "../truth/hand_made.hpp"
#include "model/files/array_check.hpp"
#include "model/loading/loading.hpp"

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

/// An array that uses every feature at rung `edge`. `cell` and `voxel` name the voxel with the most edges.
struct Sample {
    CellScene scene;
    PictureSettings settings;
    LoadedArray array;
    std::size_t cell = 0;
    std::size_t voxel = 0;
};
Sample sample() {
    Sample s;
    s.scene = hand_made::cube(4, 4, 6);
    s.scene.frame.depth_levels = 12;
    const auto object = hand_made::add_object(s.scene, hand_made::matt(0.5));
    hand_made::add_rectangle(s.scene, object, {0.3, 0.4, 2}, {3.1, 0.2, 0.5}, {-0.2, 2.9, 0.7});
    hand_made::add_rectangle(s.scene, object, {0.1, 0.2, 4}, {3.5, 0, 0}, {0, 3.5, 0});
    s.settings.depth_levels = s.scene.frame.depth_levels;
    s.settings.display = Display::gouraud;
    s.settings.voxel_capacity = 8;
    s.array = array_of(s.scene, s.settings);
    std::size_t most = 0;
    for (std::size_t c = 0; c < s.array.cells.size(); ++c) {
        const CellStore& cell = s.array.cells[c];
        for (std::size_t v = 0; v < cell.voxels.size(); ++v) {
            if (cell.voxels[v].edge_count <= most) continue;
            most = cell.voxels[v].edge_count;
            s.cell = c;
            s.voxel = v;
        }
    }
    EXPECT_GE(most, 2u);
    return s;
}

/// The error message of check_array for the sample after `change`, written with a valid checksum; empty if
/// none.
std::string said_of(const std::function<void(Sample&, CellStore&, Voxel&)>& change) {
    Sample s = sample();
    CellStore& cell = s.array.cells[s.cell];
    change(s, cell, cell.voxels[s.voxel]);
    try {
        check_array(array_from(bytes_of(s.array)), s.scene, s.settings, "array");
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(ArrayCheck, TakesEveryArrayThatWasLoaded) {
    EXPECT_EQ(said_of([](Sample&, CellStore&, Voxel&) {}), "");
    for (const std::uint64_t seed : property::seeds(1, 120)) {
        SCOPED_TRACE(property::rerun(seed));
        PictureSettings settings;
        settings.depth_levels = 12;
        settings.hit = HitTest(seed % 5);
        settings.normals = seed % 2 ? Normals::linear : Normals::voxel;
        if (seed % 3 == 0) settings.numbers.arithmetic = Numbers::exact;
        settings.numbers.word_bits = 8 + int(seed % 25);
        if (seed % 7 == 0) settings.voxel_capacity = 2;
        if (seed % 4 == 0) settings.display = Display::gouraud;
        const CellScene scene = scene_of(seed);
        EXPECT_NO_THROW(check_array(array_of(scene, settings), scene, settings, "array"));
    }
}

TEST(ArrayCheck, RefusesEveryFieldThatTracingCannotRelyOnThoughItsChecksumIsRight) {
    const double nan = std::nan("");
    const double infinite = INFINITY;
    const struct {
        const char* said;
        std::function<void(Sample&, CellStore&, Voxel&)> change;
    } cases[] = {
        {"object 1; expected less than 1", [](Sample&, CellStore&, Voxel& v) { v.object = 1; }},
        {"object 4294967295", [](Sample&, CellStore&, Voxel& v) { v.object = ~0u; }},
        {"polygon 2; expected less than 2", [](Sample&, CellStore&, Voxel& v) { v.polygon = 2; }},
        {"levels -1 to", [](Sample&, CellStore&, Voxel& v) { v.near_level = -1; }},
        {"expected an interval from 0 to 12", [](Sample&, CellStore&, Voxel& v) { v.far_level = 13; }},
        {"levels 3 to 3", [](Sample&, CellStore&, Voxel& v) { v.near_level = v.far_level = 3; }},
        {"near is not finite", [=](Sample&, CellStore&, Voxel& v) { v.near = nan; }},
        {"far is not finite", [=](Sample&, CellStore&, Voxel& v) { v.far = infinite; }},
        {"base is not finite", [=](Sample&, CellStore&, Voxel& v) { v.base = nan; }},
        {"near is beyond far", [](Sample&, CellStore&, Voxel& v) { v.near = v.far + 1; }},
        {"is no word", [](Sample&, CellStore&, Voxel& v) { v.near = 1e-20; }},
        {"is no word", [](Sample&, CellStore&, Voxel& v) { v.far = 1e300; }},
        {"plane is not finite", [=](Sample&, CellStore&, Voxel& v) { v.plane.n.x = nan; }},
        {"plane is not finite", [=](Sample&, CellStore&, Voxel& v) { v.plane.c = infinite; }},
        {"dropped axis 3; expected at most 2", [](Sample&, CellStore&, Voxel& v) { v.drop = 3; }},
        {"parallel to its dropped axis", [](Sample&, CellStore&, Voxel& v) { v.plane.n[v.drop] = 0; }},
        {"normal is not finite", [=](Sample&, CellStore&, Voxel& v) { v.normal.base.y = nan; }},
        {"normal is not finite", [=](Sample&, CellStore&, Voxel& v) { v.normal.du.z = nan; }},
        {"normal is not finite", [=](Sample&, CellStore&, Voxel& v) { v.normal.dv.x = nan; }},
        {"point is not finite", [=](Sample&, CellStore&, Voxel& v) { v.point.z = nan; }},
        {"area is no area", [](Sample&, CellStore&, Voxel& v) { v.area = -1; }},
        {"area is no area", [=](Sample&, CellStore&, Voxel& v) { v.area = nan; }},
        {"end of the window 33", [](Sample&, CellStore&, Voxel& v) { v.window[1] = 33; }},
        {"end of the window 0", [](Sample&, CellStore&, Voxel& v) { v.window[3] = 0; }},
        {"beginning of the window", [](Sample&, CellStore&, Voxel& v) { v.window[2] = v.window[3]; }},
        {"first edge", [](Sample&, CellStore&, Voxel& v) { v.first_edge = ~0u; }},
        {"first edge", [](Sample&, CellStore& c, Voxel& v) { v.first_edge = std::uint32_t(c.edges.size()); }},
        {"number of edges", [](Sample&, CellStore&, Voxel& v) { v.edge_count = ~0u; }},
        {"number of pieces 0", [](Sample&, CellStore&, Voxel& v) { v.pieces = 0; }},
        {"number of pieces", [](Sample&, CellStore&, Voxel& v) { v.pieces = v.edge_count + 1; }},
        {"number of pieces", [](Sample&, CellStore&, Voxel& v) { v.edge_count = 0; }},
        {"piece of an edge", [](Sample&, CellStore& c, Voxel& v) { c.edges[v.first_edge].piece = v.pieces; }},
        {"pieces are not in order",
         [](Sample&, CellStore& c, Voxel& v) { v.pieces = 2, c.edges[v.first_edge].piece = 1; }},
        {"edge is not finite", [=](Sample&, CellStore& c, Voxel& v) { c.edges[v.first_edge].b = nan; }},
        {"number of edges", [](Sample&, CellStore& c, Voxel&) { c.edges.resize(1); }},
        {"number of intensities", [](Sample&, CellStore& c, Voxel&) { c.intensities.pop_back(); }},
        {"number of intensities", [](Sample&, CellStore& c, Voxel&) { c.intensities.emplace_back(); }},
        {"intensity is not finite", [=](Sample&, CellStore& c, Voxel&) { c.intensities[0].x = nan; }},
        {"number of voxels 9; expected at most 8",
         [](Sample&, CellStore& c, Voxel& v) {
             const Voxel same = v;
             c.voxels.resize(9, same), c.intensities.resize(9);
         }},
    };
    for (const auto& one : cases) {
        SCOPED_TRACE(one.said);
        const std::string said = said_of(one.change);
        EXPECT_NE(said.find(one.said), std::string::npos) << said;
        EXPECT_EQ(said.rfind("array: is damaged: cell ", 0), 0u) << said;
    }
}

/// Changes each setting that voxels depend on, one at a time.
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
    EXPECT_NE(changed([](MachineSettings& m) { m.buffer_depth = 1; }), timing);
    EXPECT_NE(changed([](MachineSettings& m) { m.loading_units = 1; }), timing);
    for (const auto& [name, member] : CostTable::entries()) {
        const std::string stage = name.substr(0, name.find('_'));
        const bool loads =
            stage == "load" || stage == "geometry" || stage == "precomputation" || stage == "distribution";
        const auto cost = member;
        EXPECT_EQ(changed([&](MachineSettings& m) { ++(m.costs.*cost); }) != timing, loads) << name;
    }
    EXPECT_EQ(changed([](MachineSettings& m) {
                  m.ray_store = 3, m.networks = Networks::quadrant, m.seed = 7, m.start_within = 100;
              }),
              timing)
        << "what only tracing depends on";
}

}  // namespace
}  // namespace raycell
