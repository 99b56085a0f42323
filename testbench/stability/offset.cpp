// Shadow rays against the normal offset: acne where it is too small, light leaks where it is too large.
#include "model/truth/truth.hpp"
#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr double size = 48;

/// A ball of facets stands on a tilted floor and sinks into it by a twentieth of a cell; two sources.
CellScene ball_on_floor() {
    CellScene scene = empty_scene(int(size), int(size), size, 1024);
    const dvec3 up = glm::normalize(dvec3(0.1, -0.9, -0.5));
    const dvec3 centre{22, 22, 24};
    const double radius = 10;
    add_ball(scene, 0, centre, radius, 48, 24);
    add_ball(scene, 0, {36.3, 30.2, 14.7}, 4.1, 24, 12);
    add_cross_section(scene, 0, centre - (radius - 0.05) * up, up);
    scene.sources.push_back({{-10, -30, -20}, dvec3(0.7)});
    scene.sources.push_back({{60, -15, -40}, dvec3(0.7)});
    return scene;
}

struct Verdicts {
    Share wrongly_shadowed;  ///< of what the truth says is lit
    Share wrongly_lit;       ///< of what the truth says is in shadow
    std::int64_t wrong() const { return wrongly_shadowed.some() + wrongly_lit.some(); }
    std::int64_t all() const { return wrongly_shadowed.all() + wrongly_lit.all(); }
};

/// Shadow rays from the first hits of rays along z through random points; the truth starts from its own hit.
Verdicts judge(const Loaded& loaded, const TruthRenderer& truth, const Effort& effort) {
    Random random(effort.seed);
    Verdicts verdicts;
    const Context& context = loaded.context();
    for (int i = 0; i < effort.samples(20000); ++i) {
        const dvec3 origin{random.uniform(0, size), random.uniform(0, size), 0};
        const auto seen = walk(loaded, start_ray(loaded, origin, {0, 0, 1}));
        const auto true_hit = truth.intersect(origin, {0, 0, 1}, no_polygon);
        if (!seen || !true_hit || true_hit->polygon != seen->polygon) continue;
        const CellStore& store = loaded.cell(seen->x, seen->y);
        const HitSetup setup = set_up_hit(context, store, seen->ray, seen->hit, seen->x, seen->y);
        for (std::size_t s = 0; s < context.lights.rays.size(); ++s) {
            if (!(setup.facing >> s & 1)) continue;
            const dvec3 way = loaded.scene.sources[s].position - true_hit->position;
            const double distance = glm::length(way);
            const bool dark = truth.occluded(true_hit->position, way / distance, seen->polygon, distance);
            const Ray ray = shadow_ray(context, store, seen->ray, seen->hit, setup, s, seen->x, seen->y);
            const bool blocked = walk(loaded, {ray, seen->x, seen->y}).has_value();
            (dark ? verdicts.wrongly_lit : verdicts.wrongly_shadowed).add(dark != blocked);
        }
    }
    return verdicts;
}

}  // namespace

Report study_offset(const Effort& effort) {
    Report report{Table({"arithmetic", "offset_cells", "is_default", "held_offset_cells", "verdicts",
                         "wrongly_shadowed_percent", "wrongly_lit_percent"}),
                  "", ""};
    const CellScene scene = ball_on_floor();
    const TruthRenderer truth(scene);
    for (const NumberSettings& numbers : exact_and({20, 16, 12})) {
        double default_wrong = 0;
        double default_offset = 0;
        double least_wrong = 100;
        double least_offset = 0;
        for (const double offset : {-1.0, 0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
            PictureSettings settings = settings_for(scene, numbers);
            settings.normal_offset = offset;
            const Loaded loaded(scene, settings);
            const double held = loaded.context().normal_offset;
            const Verdicts verdicts = judge(loaded, truth, effort);
            report.table.add({name_of(numbers), offset < 0 ? held : offset, std::int64_t(offset < 0), held,
                              verdicts.all(), verdicts.wrongly_shadowed.percent(),
                              verdicts.wrongly_lit.percent()});
            const double wrong = 100.0 * double(verdicts.wrong()) / double(verdicts.all());
            if (offset < 0) {
                default_wrong = wrong;
                default_offset = held;
            } else if (wrong < least_wrong) {
                least_wrong = wrong;
                least_offset = offset;
            }
        }
        report.boundary +=
            text("%s%s: %.3g %% of verdicts wrong with the default %.2g cells, least %.3g %% with %g",
                 report.boundary.empty() ? "" : "; ", name_of(numbers).c_str(), default_wrong, default_offset,
                 least_wrong, least_offset);
    }
    report.treatment =
        "limit and default: --normal-offset takes 0 to 1 cells; the default suits the arithmetic (1e-8 "
        "cells, "
        "or 8 last bits of a word). A ray can't hit the polygon that it leaves, nor a neighbour within 64 "
        "last "
        "bits of its start, so an offset of 0 is no acne";
    return report;
}

}  // namespace raycell::stability
