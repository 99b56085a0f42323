// Rays against a plane that cuts the whole cube in two: a ray that crosses it without a hit is a leak.
#include <cmath>

#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr int size = 16;
constexpr double depth = 64;
constexpr int levels = 1024;

/// A ray from one side of the plane to the other, sideways (at most 0.5 in depth to 1 across), so that a
/// steep plane spans many cell widths of depth within one step.
struct Shot {
    dvec3 origin;
    dvec3 direction;
};

bool inside(const dvec3& p) {
    return p.x > 0 && p.y > 0 && p.z > 0 && p.x < size && p.y < size && p.z < depth;
}

/// Ends soon: half of the plane's points have room on both sides.
Shot shoot(const dvec3& point, const dvec3& normal, Random& random) {
    const dvec3 aside = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(normal, aside));
    const dvec3 v = glm::cross(normal, u);
    for (;;) {
        const dvec3 on_plane = point + random.uniform(-40, 40) * u + random.uniform(-40, 40) * v;
        const double turn = random.uniform(0, 2 * pi);
        const dvec3 way = glm::normalize(dvec3(std::cos(turn), std::sin(turn), random.uniform(-0.5, 0.5)));
        const double back = random.uniform(0.5, 6);
        const dvec3 origin = on_plane - back * way;
        // Both ends must lie inside and clear of the plane: a start on it, or an end in the next cell, proves
        // nothing.
        if (std::abs(glm::dot(normal, way)) * back < 0.05) continue;
        if (inside(on_plane) && inside(origin) && inside(on_plane + 0.5 * way)) return {origin, way};
    }
}

Share leaks_at(double slope, HitTest rung, const NumberSettings& numbers, const Effort& effort) {
    Random random(effort.seed);
    Share leaks;
    const int planes = effort.quick ? 4 : 8;
    for (int i = 0; i < planes; ++i) {
        const double turn = random.uniform(0, 2 * pi);
        const dvec3 normal = glm::normalize(dvec3(slope * std::cos(turn), slope * std::sin(turn), 1));
        const dvec3 point{8 + random.uniform(-1, 1), 8 + random.uniform(-1, 1), 32 + random.uniform(-1, 1)};
        CellScene scene = empty_scene(size, size, depth, levels);
        add_cross_section(scene, 0, point, normal);
        const PictureSettings settings = settings_for(scene, numbers, rung);
        const Loaded loaded(std::move(scene), settings);
        const int rays = effort.samples(10000) / planes;
        for (int ray = 0; ray < rays; ++ray) {
            const Shot shot = shoot(point, normal, random);
            leaks.add(!walk(loaded, start_ray(loaded, shot.origin, shot.direction)));
        }
    }
    return leaks;
}

}  // namespace

Report study_slopes(const Effort& effort) {
    std::vector<std::string> columns = {"arithmetic", "slope", "rays_per_rung"};
    for (const HitTest rung : all_rungs) columns.push_back(name_of(rung) + "_leak_percent");
    Report report{Table(columns), "", ""};
    double first_leak = -1;
    double worst_depth = 0;
    std::vector<Share> from_interval(4);  // exact, words of 20, 16 and 12 bits
    for (const NumberSettings& numbers : exact_and({20, 16, 12})) {
        const bool exact = numbers.arithmetic == Numbers::exact;
        Share& sum = from_interval[exact ? 0 : std::size_t(6 - numbers.word_bits / 4)];
        for (const double slope : {0.0, 0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0, 256.0, 1000.0}) {
            std::vector<Table::Value> row = {name_of(numbers), slope, std::int64_t(0)};
            for (const HitTest rung : all_rungs) {
                const Share leaks = leaks_at(slope, rung, numbers, effort);
                row[2] = leaks.all();
                row.push_back(leaks.percent());
                if (rung == HitTest::depth) {
                    worst_depth = std::max(worst_depth, leaks.percent());
                    if (leaks.some() > 0 && first_leak < 0) first_leak = slope;
                } else {
                    sum.add(leaks);
                }
            }
            report.table.add(std::move(row));
        }
    }
    const auto counted = [](const Share& share) {
        return std::to_string(share.some()) + " of " + std::to_string(share.all());
    };
    report.boundary = text(
        "rung depth leaks from slope %g up, at worst %.1f %%; from interval up %s rays leak in exact "
        "arithmetic, %s with 20 bits, %s with 16, %s with 12",
        first_leak, worst_depth, counted(from_interval[0]).c_str(), counted(from_interval[1]).c_str(),
        counted(from_interval[2]).c_str(), counted(from_interval[3]).c_str());
    report.treatment =
        "documented: rung depth is the paper's own test and leaks by design; the default rung is edge. From "
        "interval up voxels and tests are widened by a hair (4 last bits of a word, more where the ray "
        "grazes "
        "the plane)";
    return report;
}

}  // namespace raycell::stability
