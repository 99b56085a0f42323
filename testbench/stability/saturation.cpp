// The ends of the formats: every input driven out of its range, one at a time.
#include <cmath>

#include "model/truth/truth.hpp"
#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

struct Inputs {
    double source_distance = 30;  ///< from the ball's surface, cells
    double source_intensity = 1;
    double colour = 0.8;
    double depth = 16;  ///< of the cube, cells
    double shine = 20;
    double ior = 1.5;
};

/// A glass ball over a mirroring floor before a back wall, in a cube of 16x16 columns; the ball in its
/// middle.
CellScene make_scene(const Inputs& in) {
    CellScene scene = empty_scene(16, 16, in.depth, 1024);
    scene.background = {0.1, 0.2, 0.3};
    Material glass;
    glass.colour = in.colour * dvec3(1, 0.75, 0.5);
    glass.diffuse = 0.4;
    glass.specular = 0.3;
    glass.shine = in.shine;
    glass.transmit = 0.4;
    glass.ior = in.ior;
    Material floor;
    floor.colour = in.colour * dvec3(0.5, 0.75, 1);
    floor.diffuse = 0.6;
    floor.specular = 0.4;
    floor.shine = in.shine;
    const std::uint32_t ball = add_object(scene, glass);
    const std::uint32_t ground = add_object(scene, floor);
    const dvec3 centre{8.1, 7.3, 0.5 * in.depth};
    const double radius = std::min(4.3, 0.3 * in.depth);
    add_ball(scene, ball, centre, radius, 16, 8);
    add_cross_section(scene, ground, {8, 13, 0.5 * in.depth}, glm::normalize(dvec3(0, 1, 8 / in.depth)));
    add_cross_section(scene, ground, {8, 8, 0.97 * in.depth}, {0, 0, 1});
    const dvec3 towards = glm::normalize(dvec3(-1, -1.5, -1.2));
    scene.sources.push_back({centre + (radius + in.source_distance) * towards, dvec3(in.source_intensity)});
    return scene;
}

struct Outcome {
    std::int64_t not_numbers = 0;  ///< channels
    std::int64_t infinite = 0;
    std::int64_t negative = 0;  ///< as a word that wraps round would be
    std::int64_t saturated = 0;
    double largest_error = 0;  ///< of channels clamped to 0 to 1
    double rms_error = 0;
    double mean = 0;  ///< of the channels, clamped to 8
};

Outcome judge(const Picture& picture, const Picture& truth, double most) {
    Outcome outcome;
    double squares = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            const double value = picture.pixels[i].colour[channel];
            outcome.not_numbers += std::isnan(value);
            outcome.infinite += std::isinf(value);
            outcome.negative += value < 0;
            outcome.saturated += value >= most;
            const double wanted = std::clamp(truth.pixels[i].colour[channel], 0.0, 1.0);
            const double error = std::abs(std::clamp(value, 0.0, 1.0) - wanted);
            outcome.largest_error = std::max(outcome.largest_error, error);
            squares += error * error;
            outcome.mean += std::min(value, 8.0) / (3.0 * double(picture.pixels.size()));
        }
    }
    outcome.rms_error = std::sqrt(squares / (3.0 * double(picture.pixels.size())));
    return outcome;
}

/// How many numbers of the scene saturate in the machine's formats.
std::int64_t saturated_inputs(const Loaded& loaded) {
    const Context& context = loaded.context();
    if (context.arithmetic.exact()) return 0;
    const Formats& f = context.arithmetic.formats();
    std::int64_t count = 0;
    for (const Material& m : loaded.scene.objects) {
        for (int channel = 0; channel < 3; ++channel) count += m.colour[channel] > f.feature.most();
        count += m.ior > f.ior.most();
    }
    for (const Source& source : loaded.scene.sources) {
        for (int channel = 0; channel < 3; ++channel) {
            count += source.intensity[channel] > f.intensity.most();
        }
    }
    return count;
}

struct Sweep {
    const char* input;
    double Inputs::*member;
    std::vector<double> values;
    bool brightens;  ///< more of it can't darken the picture
};

std::vector<Sweep> sweeps(bool quick) {
    std::vector<Sweep> all = {
        {"source distance, cells",
         &Inputs::source_distance,
         {1e-3, 0.1, 1, 10, 1e2, 1e3, 1e4, 1e5, 1e6, 1e9},
         false},
        {"source intensity", &Inputs::source_intensity, {1e-6, 1e-3, 1, 2, 4, 8, 16, 1e2, 1e4, 1e6}, true},
        {"colour", &Inputs::colour, {0, 1e-3, 1, 2, 4, 8, 1e2, 1e4, 1e6}, true},
        {"depth of the cube, cells", &Inputs::depth, {1, 4, 16, 256, 4096, 65536, 1e6}, false},
        {"shine", &Inputs::shine, {0, 1e-3, 1, 10, 1e2, 1e3, 1024, 1e4, 1e5}, false},
        {"index of refraction", &Inputs::ior, {0.01, 0.1, 0.5, 1, 1.5, 2, 3, 4, 10}, false}};
    if (quick) {
        for (Sweep& sweep : all) {
            std::vector<double> thinned;
            for (std::size_t i = 0; i < sweep.values.size(); i += 2) thinned.push_back(sweep.values[i]);
            if (thinned.back() != sweep.values.back()) thinned.push_back(sweep.values.back());
            sweep.values = thinned;
        }
    }
    return all;
}

struct Totals {
    std::int64_t unsound = 0;  ///< channels that are no numbers or infinite
    std::int64_t negative = 0;
    int darker = 0;          ///< times that more light made a darker picture
    double longest_way = 0;  ///< hops per ray
    std::string worst_text;
};

/// Runs one input through its values in one arithmetic.
void run_sweep(const Sweep& sweep, const NumberSettings& numbers, Table& table, Totals& totals) {
    double before = 0;
    double error_limit_at = -1;
    for (const double value : sweep.values) {
        Inputs in;
        in.*sweep.member = value;
        const CellScene scene = make_scene(in);
        const Picture truth = TruthRenderer(scene).render(1);
        Loaded loaded(scene, settings_for(scene, numbers));
        const Picture picture = loaded.machine.render();
        const bool fixed = numbers.arithmetic == Numbers::fixed;
        const double most = fixed ? loaded.arithmetic().formats().intensity.most() : 1e300;
        const Outcome outcome = judge(picture, truth, most);
        const RayCounts& rays = loaded.machine.rays();
        const double sent = double(rays.primary + rays.reflected + rays.refracted + rays.shadow);
        table.add({std::string(sweep.input), name_of(numbers), value, outcome.not_numbers, outcome.infinite,
                   outcome.negative, saturated_inputs(loaded), outcome.saturated, outcome.largest_error,
                   outcome.rms_error, outcome.mean, double(rays.ray_hops) / sent});
        totals.unsound += outcome.not_numbers + outcome.infinite;
        totals.negative += outcome.negative;
        // A difference in the last bit is rounding; a picture that turns dark is a word that wrapped round.
        if (sweep.brightens && outcome.mean < before - 0.02) ++totals.darker;
        before = outcome.mean;
        totals.longest_way = std::max(totals.longest_way, double(rays.ray_hops) / sent);
        if (fixed && numbers.word_bits == 20 && outcome.rms_error > 0.02 && error_limit_at < 0) {
            error_limit_at = value;
            totals.worst_text += text("%s%s %g", totals.worst_text.empty() ? "" : ", ", sweep.input, value);
        }
    }
}

}  // namespace

Report study_saturation(const Effort& effort) {
    Report report{
        Table({"input", "arithmetic", "value", "not_numbers", "infinite", "negative", "saturated_inputs",
               "saturated", "largest_error", "rms_error", "mean_intensity", "hops_per_ray"}),
        "", ""};
    Totals totals;
    for (const Sweep& sweep : sweeps(effort.quick)) {
        for (const NumberSettings& numbers : exact_and({8, 20, 32})) {
            run_sweep(sweep, numbers, report.table, totals);
        }
    }
    report.boundary = text(
        "%lld channels are no numbers or infinite, %lld negative, %d times more light made it darker; no ray "
        "makes more than %.1f hops on average. With 20 bits the picture is off by more than 0.02 (rms) first "
        "at: %s",
        static_cast<long long>(totals.unsound), static_cast<long long>(totals.negative), totals.darker,
        totals.longest_way, totals.worst_text.empty() ? "nowhere" : totals.worst_text.c_str());
    report.treatment =
        "limits and warnings: every format saturates and never wraps (colours and index of refraction below "
        "4, "
        "intensities below 8, power 2^19); render warns of colours, lights and indices of refraction of a "
        "scene "
        "that its words can't hold, and of a cube so deep that rays are off by over 0.1 cells at its back; "
        "intensities that add up beyond 8 saturate silently; a distance to a source beyond its word counts "
        "as "
        "infinite";
    return report;
}

}  // namespace raycell::stability
