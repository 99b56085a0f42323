// The order in which polygons are loaded: nothing but ties may depend on it.
#include <algorithm>
#include <numeric>

#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr double size = 20;  ///< of the cube, cells

/// Triangles of several objects, anywhere; of `twins` every one lies there twice, in two objects.
CellScene make_scene(int triangles, bool twins, Random& random) {
    CellScene scene = empty_scene(int(size), int(size), size, 256);
    for (int object = 0; object < 4; ++object) {
        Material m;
        m.colour = {random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1)};
        m.diffuse = 0.7;
        m.specular = random.chance(0.5) ? 0.4 : 0;
        add_object(scene, m);
    }
    Source source;
    source.position = {random.uniform(2, 18), random.uniform(2, 18), 1};
    source.intensity = dvec3(1);
    scene.sources.push_back(source);
    for (int i = 0; i < triangles; ++i) {
        const dvec3 centre{random.uniform(4, 16), random.uniform(4, 16), random.uniform(4, 16)};
        std::vector<dvec3> corners;
        for (int c = 0; c < 3; ++c) corners.push_back(centre + random.uniform(1, 4) * random.direction());
        const auto object = std::uint32_t(1 + i % 4);
        add_polygon(scene, object, corners);
        if (twins) add_polygon(scene, 1 + object % 4, corners);
    }
    return scene;
}

/// The scene with its polygons loaded in another order; each gets the id of its new place, as geometry would
/// give it.
CellScene shuffled(const CellScene& scene, Random& random) {
    CellScene other = scene;
    for (std::size_t i = other.polygons.size(); i-- > 1;)
        std::swap(other.polygons[i], other.polygons[std::size_t(random.uniform(0, double(i) + 0.999))]);
    for (std::size_t i = 0; i < other.polygons.size(); ++i) other.polygons[i].id = std::uint32_t(i);
    return other;
}

struct Outcome {
    Share pixels;  ///< that differ
    Share cells;   ///< whose number of voxels differs
};

Outcome measure(bool twins, HitTest rung, const NumberSettings& numbers, const Effort& effort) {
    Random random(effort.seed);
    Outcome outcome;
    for (int i = 0; i < effort.samples(40); ++i) {
        const CellScene scene = make_scene(25, twins, random);
        UntimedMachine first(scene, settings_for(scene, numbers, rung), nullptr);
        const Picture picture = first.render();
        const CellScene other = shuffled(scene, random);
        UntimedMachine second(other, settings_for(other, numbers, rung), nullptr);
        const Picture again = second.render();
        for (std::size_t p = 0; p < picture.pixels.size(); ++p)
            outcome.pixels.add(picture.pixels[p].colour != again.pixels[p].colour);
        for (std::size_t c = 0; c < first.cells().size(); ++c)
            outcome.cells.add(first.cells()[c].voxels.size() != second.cells()[c].voxels.size());
    }
    return outcome;
}

}  // namespace

Report study_loading_order(const Effort& effort) {
    Report report{
        Table({"surfaces", "rung", "arithmetic", "pixels", "other_pixels_percent", "other_cells_percent"}),
        "", ""};
    double apart_edge = 0;
    double apart_other = 0;
    double twin_edge = 0;
    double cells = 0;
    for (const bool twins : {false, true}) {
        for (const HitTest rung : all_rungs) {
            for (const NumberSettings& numbers : exact_and({20, 12})) {
                const Outcome o = measure(twins, rung, numbers, effort);
                report.table.add({twins ? "each twice" : "apart", name_of(rung), name_of(numbers),
                                  o.pixels.all(), o.pixels.percent(), o.cells.percent()});
                cells = std::max(cells, o.cells.percent());
                double& worst = twins ? twin_edge : rung == HitTest::edge ? apart_edge : apart_other;
                if (!twins || rung == HitTest::edge) worst = std::max(worst, o.pixels.percent());
            }
        }
    }
    report.boundary = text(
        "surfaces apart, rung edge: %.2g %% of the pixels differ, at other rungs up to %.2g %%; where every "
        "surface lies "
        "there twice, up to %.2g %% at edge. Cells whose number of voxels differs: %.2g %%",
        apart_edge, apart_other, twin_edge, cells);
    report.treatment =
        "documented: of surfaces met at the same distance the lowest polygon id counts, in the order of the "
        "scene's file, "
        "for the truth too; lanes of the feed keep the order of every cell's voxels, so no picture depends "
        "on them";
    return report;
}

}  // namespace raycell::stability
