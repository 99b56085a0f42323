// What the units' operations take, from the cost table.
#include <bitset>

#include "model/tracing/tracing.hpp"

namespace raycell {

std::uint32_t visit_cycles(const Visit& visit, const PictureSettings& settings, const CostTable& costs) {
    const Comparisons& made = visit.comparisons;
    const HitTest test = settings.hit;
    // Every test has a division, for the distance at which the ray meets the plane or enters the run.
    const std::uint32_t own = test == HitTest::plane  ? costs.compare_plane
                              : test == HitTest::mask ? costs.compare_mask
                              : test == HitTest::edge ? costs.compare_edge
                                                      : costs.enter_run;
    const std::uint32_t run = test == HitTest::depth ? costs.compare_depth : costs.compare_interval;
    const std::uint32_t reciprocal = costs.reciprocal(settings.numbers.operators);
    const std::uint32_t leaving = visit.leaves && costs.leave_cube > 0 ? costs.leave_cube + reciprocal : 0;
    return costs.walk_step + leaving + made.runs * run + made.tests * (own + reciprocal) +
           made.edges * costs.per_edge;
}

namespace {

/// Cycles of the view of one light of a source; `way`: those of its direction without the root.
std::uint32_t view_cycles(const Source& source, std::uint32_t way, const CostTable& costs,
                          const OperatorSettings& operators) {
    const std::uint32_t root = costs.root(operators);
    switch (source.kind) {
        case SourceKind::directional:
            return costs.source_facing;
        case SourceKind::spot:
            return way + root + costs.source_emission + costs.power(operators);
        case SourceKind::rectangle:
        case SourceKind::triangle:
            return costs.sample_place + way + root + costs.source_emission;
        case SourceKind::sphere:
            return costs.disc_place + root + way + root;
        case SourceKind::point:
            break;
    }
    return way + root;
}

/// Cycles of the views of those lights of `which` that a source has, the first of which is light `first`.
std::uint32_t views_cycles(const Source& source, std::uint64_t which, std::uint32_t way,
                           const CostTable& costs, const OperatorSettings& operators) {
    if (which == 0) return 0;
    const bool sphere = source.kind == SourceKind::sphere;
    return std::uint32_t(std::bitset<64>(which).count()) * view_cycles(source, way, costs, operators) +
           (sphere ? costs.disc_axes + 2 * costs.root(operators) : 0);
}

/// Calls see(source, its bits of `which`) for every source.
template <typename See>
void for_each_source(const Lights& lights, std::uint64_t which, const See& see) {
    for (std::size_t light = 0; light < lights.rays.size();) {
        const Source& source = lights.sources[lights.rays[light].source];
        see(source, which & lights.bits(light));
        light += is_area(source.kind) ? std::size_t(lights.samples) : 1;
    }
}

}  // namespace

std::uint32_t primary_cycles(const Context& context, const CostTable& costs) {
    const OperatorSettings& operators = context.settings.numbers.operators;
    if (context.settings.own_samples() == 1) return 0;
    if (context.scene.frame.viewer_at_infinity) return costs.ray_start;  // all have one direction
    return costs.source_view + costs.root(operators) + costs.ray_start + 2 * costs.reciprocal(operators);
}

std::uint32_t setup_cycles(const Context& context, const HitSetup& setup, const CostTable& costs) {
    const OperatorSettings& operators = context.settings.numbers.operators;
    const std::uint32_t root = costs.root(operators);
    // With the reciprocals that a ray carries.
    const std::uint32_t start = costs.ray_start + 2 * costs.reciprocal(operators);
    std::uint32_t cycles = costs.shade_setup + root;  // a voxel's own normal is made unit, too
    if (context.settings.normals == Normals::linear) cycles += costs.normal_linear;
    if (context.lights.areas()) cycles += costs.sample_shift;
    for_each_source(context.lights, ~std::uint64_t(0), [&](const Source& source, std::uint64_t all) {
        cycles += views_cycles(source, all, costs.source_view, costs, operators);
    });
    if (context.settings.shadows == Shadows::per_hit) {
        cycles += std::uint32_t(std::bitset<64>(setup.facing).count()) * start;
    }
    if (setup.reflects) cycles += costs.reflect + root + start;
    if (setup.refracts) cycles += costs.refract + costs.reciprocal(operators) + 2 * root + start;
    return cycles;
}

std::uint32_t shade_cycles(const Context& context, const HitSetup& setup, std::uint32_t object,
                           std::uint64_t lit, bool waited, const CostTable& costs) {
    if (lit == 0) return costs.local_intensity;
    const OperatorSettings& operators = context.settings.numbers.operators;
    const auto direction = [&](std::uint32_t cycles) {
        return cycles > 0 ? cycles + costs.root(operators) : 0;
    };
    const bool mirrors = context.objects[object].specular > 0 && !setup.reflects;
    std::uint32_t cycles = costs.local_intensity + (mirrors ? direction(costs.mirrored) : 0);
    bool samples = false;
    for_each_source(context.lights, lit, [&](const Source& source, std::uint64_t own) {
        if (own == 0) return;
        const auto count = std::uint32_t(std::bitset<64>(own).count());
        const bool shares = source.kind != SourceKind::point && source.kind != SourceKind::directional &&
                            source.kind != SourceKind::sphere;
        cycles +=
            costs.per_lit_source + count * costs.power(operators) + (shares ? count * costs.emitted : 0);
        if (is_area(source.kind)) cycles += costs.sample_mean + count * costs.per_lit_sample;
        samples = samples || is_area(source.kind);
        if (waited && costs.light_again > 0)
            cycles += views_cycles(source, own, costs.light_again, costs, operators);
    });
    if (samples && waited && costs.light_again > 0) cycles += costs.sample_shift;
    return cycles;
}

}  // namespace raycell
