// The viewer close to the screen: primary rays cross many cells, ever more obliquely.
#include <cmath>

#include "model/picture/compare.hpp"
#include "model/truth/truth.hpp"
#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

/// A room with two balls; its walls keep a little off the cube's faces, and rays end at them.
CellScene room(double size, double distance) {
    CellScene scene = empty_scene(int(size), int(size), size, 1024);
    scene.frame.viewer_at_infinity = false;
    scene.frame.eye = {0.5137 * size, 0.4811 * size, -distance};  // no ray along an edge of the room
    const auto matt = [&](const dvec3& colour) {
        Material material;
        material.colour = colour;
        return add_object(scene, material);
    };
    const double low = 0.02;
    const double high = size - 0.02;
    const auto wall = [&](std::uint32_t object, const dvec3& a, const dvec3& b, const dvec3& c,
                          const dvec3& d) {
        add_polygon(scene, object, {a, b, c, d});
    };
    const std::uint32_t left = matt({0.9, 0.3, 0.2});
    const std::uint32_t right = matt({0.2, 0.7, 0.3});
    const std::uint32_t rest = matt({0.8, 0.8, 0.75});
    wall(left, {low, low, low}, {low, low, high}, {low, high, high}, {low, high, low});
    wall(right, {high, low, low}, {high, high, low}, {high, high, high}, {high, low, high});
    wall(rest, {low, high, low}, {low, high, high}, {high, high, high}, {high, high, low});
    wall(rest, {low, low, low}, {high, low, low}, {high, low, high}, {low, low, high});
    wall(rest, {low, low, high}, {high, low, high}, {high, high, high}, {low, high, high});
    add_ball(scene, matt({0.3, 0.4, 0.9}), size * dvec3(0.35, 0.72, 0.6), 0.25 * size, 24, 12);
    add_ball(scene, matt({0.9, 0.8, 0.2}), size * dvec3(0.72, 0.4, 0.35), 0.15 * size, 20, 10);
    scene.sources.push_back({size * dvec3(0.5, 0.08, 0.2), dvec3(0.9)});
    return scene;
}

/// Hops per primary ray; without sources there are no other rays.
double primary_hops(CellScene scene, const PictureSettings& settings) {
    scene.sources.clear();
    Loaded unlit(std::move(scene), settings);
    unlit.machine.render();
    return double(unlit.machine.rays().ray_hops) / double(unlit.machine.rays().primary);
}

/// The largest of some errors, and the viewer's distance there.
struct Worst {
    double percent = 0;
    double distance = 0;
    void add(double value, double at) {
        if (value > percent) percent = value, distance = at;
    }
};

}  // namespace

Report study_near_viewer(const Effort& effort) {
    Report report{Table({"rung", "arithmetic", "viewer_cells", "steepest_deg", "psnr_db",
                         "wrong_first_hit_percent", "hops_per_primary_ray"}),
                  "", ""};
    const double size = effort.quick ? 24 : 48;
    Worst edge_exact;
    Worst edge_20;
    Worst mask;
    Worst depth;
    for (const double distance : {1000.0, 300.0, 100.0, 48.0, 24.0, 12.0, 6.0, 3.0, 1.0, 0.3, 0.1}) {
        const CellScene scene = room(size, distance);
        const Picture truth = TruthRenderer(scene).render(1);
        for (const HitTest rung : {HitTest::edge, HitTest::mask, HitTest::depth}) {
            for (const NumberSettings& numbers : exact_and({20, 12})) {
                const PictureSettings settings = settings_for(scene, numbers, rung);
                Loaded loaded(scene, settings);
                const Accuracy accuracy = compare(loaded.machine.render(), truth);
                const double angle = std::atan((size - 1) / std::sqrt(2.0) / distance) * 180 / pi;
                const double wrong = accuracy.wrong_hit_percent;
                report.table.add({name_of(rung), name_of(numbers), distance, angle, accuracy.psnr_db, wrong,
                                  primary_hops(scene, settings)});
                const bool exact = numbers.arithmetic == Numbers::exact;
                if (rung == HitTest::edge && exact) edge_exact.add(wrong, distance);
                if (rung == HitTest::edge && !exact && numbers.word_bits == 20) edge_20.add(wrong, distance);
                if (rung == HitTest::mask && exact) mask.add(wrong, distance);
                if (rung == HitTest::depth && exact) depth.add(wrong, distance);
            }
        }
    }
    report.boundary = text(
        "wrong first hits at most: rung depth %.3g %% (viewer %g cells away), mask %.3g %% (%g cells), edge "
        "%.3g "
        "%% in exact arithmetic and %.3g %% in 20-bit words at any distance",
        depth.percent, depth.distance, mask.percent, mask.distance, edge_exact.percent, edge_20.percent);
    report.treatment =
        "documented: the paper's aliasing is there at rungs depth and mask, and grows as the viewer comes "
        "nearer; rung edge is the default. No warning";
    return report;
}

}  // namespace raycell::stability
