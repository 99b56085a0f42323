// Interpolated normals after the cell has normalised them, by word length and method of the root.
#include <cmath>

#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

/// A triangle whose first and last vertex normals lean one way, the second the other, `opening` apart.
struct Facet {
    std::array<dvec3, 3> vertices;
    dvec3 plane_normal;
    CellScene scene;
};
Facet make_facet(double opening, Random& random) {
    Facet facet;
    const auto z = [&] { return random.uniform(8, 16); };
    facet.vertices = {dvec3(1.3, 1.7, z()), dvec3(22.6, 2.2, z()), dvec3(3.1, 22.4, z())};
    const dvec3 n = glm::normalize(
        glm::cross(facet.vertices[1] - facet.vertices[0], facet.vertices[2] - facet.vertices[0]));
    const dvec3 aside = glm::normalize(glm::cross(n, random.direction()));
    const auto lean = [&](double angle) { return std::cos(angle) * n + std::sin(angle) * aside; };
    facet.plane_normal = n;
    facet.scene = empty_scene(24, 24, 24, 1024);
    facet.scene.polygons.push_back(make_triangle(
        0, 0, facet.vertices, {lean(-0.5 * opening), lean(0.5 * opening), lean(-0.5 * opening)}));
    return facet;
}

struct Outcome {
    Errors length;
    Errors angle;
    Share fell_back;  ///< the plane's normal stands in for a vanishing one
    std::int64_t not_numbers = 0;
};

/// Rays along z at points of the facet: anywhere, or just where opposite normals cancel.
void shoot(const Facet& facet, const NumberSettings& numbers, bool at_zero_line, int rays, Random& random,
           Outcome& outcome) {
    const Loaded loaded(facet.scene, settings_for(facet.scene, numbers));
    const Polygon& polygon = loaded.scene.polygons[0];
    for (int i = 0; i < rays; ++i) {
        const double b = at_zero_line ? 0.5 : random.uniform(0.02, 0.96);
        const double c = random.uniform(0.02, 0.98 - b);
        const dvec3 aim = facet.vertices[0] * (1 - b - c) + facet.vertices[1] * b + facet.vertices[2] * c;
        const auto landing = walk(loaded, start_ray(loaded, {aim.x, aim.y, 0}, {0, 0, 1}));
        if (!landing) continue;
        const CellStore& store = loaded.cell(landing->x, landing->y);
        const HitSetup setup =
            set_up_hit(loaded.context(), store, landing->ray, landing->hit, landing->x, landing->y);
        const dvec3 got = setup.point.normal;
        outcome.not_numbers += std::isnan(got.x + got.y + got.z);
        outcome.length.add(std::abs(glm::length(got) - 1));
        const dvec3 wanted = polygon.normal.at(project(aim, polygon.drop));
        const double off = at_zero_line ? 0 : angle_between(got, wanted);
        outcome.angle.add(std::min(off, pi - off));  // the cell turns it to the ray
        const double from_plane = angle_between(got, facet.plane_normal);
        outcome.fell_back.add(std::min(from_plane, pi - from_plane) < 1e-3);
    }
}

std::string root_of(const NumberSettings& numbers) {
    const OperatorSettings& operators = numbers.operators;
    if (operators.root == Iteration::rounded) return "rounded";
    return text("%s %d", operators.root == Iteration::newton ? "newton" : "table",
                table_sizes(operators, numbers.word_bits).root);
}

std::vector<NumberSettings> variants() {
    std::vector<NumberSettings> all = exact_and({8, 10, 12, 14, 16, 20, 24, 32});
    for (const auto& [method, size] : {std::pair(Iteration::table, 16), std::pair(Iteration::table, 64),
                                       std::pair(Iteration::table, 128), std::pair(Iteration::table, 512),
                                       std::pair(Iteration::newton, 16), std::pair(Iteration::rounded, 64)}) {
        NumberSettings numbers = fixed_numbers(20);
        numbers.operators.root = method;
        numbers.operators.root_table = size;
        all.push_back(numbers);
    }
    return all;
}

}  // namespace

Report study_normals(const Effort& effort) {
    Report report{
        Table({"arithmetic", "root", "opening_deg", "points", "where", "largest_length_error",
               "largest_angle_error_rad", "mean_angle_error_rad", "fallback_percent", "not_numbers"}),
        "", ""};
    double angle_20 = 0;
    double length_20 = 0;
    double angle_179 = 0;
    double vanishing = 0;
    std::int64_t not_numbers = 0;
    const auto measure = [&](const NumberSettings& numbers, double opening, bool at_zero_line) {
        Random random(effort.seed);
        Outcome outcome;
        for (int i = 0; i < effort.samples(40); ++i) {
            const Facet facet = make_facet(opening * pi / 180, random);
            shoot(facet, numbers, at_zero_line, 100, random, outcome);
        }
        const bool exact = numbers.arithmetic == Numbers::exact;
        report.table.add({stability::name_of(numbers), exact ? std::string("exact") : root_of(numbers),
                          opening, outcome.angle.count(), at_zero_line ? "zero line" : "anywhere",
                          outcome.length.largest(), outcome.angle.largest(), outcome.angle.mean(),
                          outcome.fell_back.percent(), outcome.not_numbers});
        not_numbers += outcome.not_numbers;
        return outcome;
    };
    for (const NumberSettings& numbers : variants()) {
        const Outcome outcome = measure(numbers, 60, false);
        const bool standard =
            numbers.operators.root == Iteration::newton && numbers.operators.root_table == 0;
        if (numbers.arithmetic == Numbers::fixed && numbers.word_bits == 20 && standard) {
            angle_20 = outcome.angle.largest();
            length_20 = outcome.length.largest();
        }
    }
    for (const NumberSettings& numbers : exact_and({20})) {
        for (const double opening : {120.0, 170.0, 179.0, 179.9, 180.0}) {
            const Outcome outcome = measure(numbers, opening, false);
            if (opening == 179.0) angle_179 = outcome.angle.largest();
        }
        vanishing = measure(numbers, 180, true).fell_back.percent();
    }
    report.boundary = text(
        "20-bit words, normals 60 degrees apart: length off by %.2g, angle by %.2g rad at most; 179 degrees "
        "apart %.2g rad. Where opposite normals cancel, %.3g %% take the plane's normal, the others a unit "
        "normal of no "
        "meaning; %lld are no numbers",
        length_20, angle_20, angle_179, vanishing, static_cast<long long>(not_numbers));
    report.treatment =
        "documented: a normal shorter than 1e-6 (in words, 8 last bits) before it is made unit falls back to "
        "the plane's; opposite vertex normals are taken as written, without a warning";
    return report;
}

}  // namespace raycell::stability
