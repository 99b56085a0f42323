// Triangles smaller than a cell: found where they are, or lost.
#include <cmath>

#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

/// A triangle with three corners on a circle, anywhere in the middle cell and in any orientation.
struct Small {
    CellScene scene;
    dvec3 centre;
    dvec3 u;
    dvec3 v;
    double size;
    std::array<dvec3, 3> corners;
};
Small make_small(double size, Random& random) {
    Small small;
    small.size = size;
    small.scene = empty_scene(9, 9, 9, 1024);
    small.centre = {random.uniform(4, 5), random.uniform(4, 5), random.uniform(4, 5)};
    const dvec3 normal = random.direction();
    small.u = glm::normalize(glm::cross(normal, random.direction()));
    small.v = glm::cross(normal, small.u);
    std::array<dvec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 2 * pi * double(i) / 3 + random.uniform(-0.3, 0.3);
        const dvec3 outwards = std::cos(turn) * small.u + std::sin(turn) * small.v;
        small.corners[i] = small.centre + 0.5 * size * outwards;
        normals[i] = glm::normalize(normal + 0.5 * outwards);
    }
    small.scene.polygons.push_back(make_triangle(0, 0, small.corners, normals));
    return small;
}

struct Outcome {
    Share stored;
    Share found;
    Errors place;   ///< of hits, along the ray
    Errors normal;  ///< of hits
    Share flat;     ///< voxels that fell back to one normal
    Share false_hits;
};

void shoot(const Loaded& loaded, const Small& small, Random& random, Outcome& outcome) {
    const Polygon& polygon = loaded.scene.polygons[0];
    dvec3 way = random.direction();
    while (std::abs(glm::dot(way, polygon.plane.n)) < 0.2) way = random.direction();
    // A point inside, clear of the edges by a tenth of the height.
    const double b = random.uniform(0.1, 0.8);
    const double c = random.uniform(0.1, 0.9 - b);
    const dvec3 aim = small.corners[0] * (1 - b - c) + small.corners[1] * b + small.corners[2] * c;
    const auto landing = walk(loaded, start_ray(loaded, aim - 3.0 * way, way));
    outcome.found.add(landing.has_value());
    if (landing) {
        outcome.place.add(std::abs(landing->t - 3));
        const CellStore& store = loaded.cell(landing->x, landing->y);
        const HitSetup setup =
            set_up_hit(loaded.context(), store, landing->ray, landing->hit, landing->x, landing->y);
        const double off = angle_between(setup.point.normal, polygon.normal.at(project(aim, polygon.drop)));
        outcome.normal.add(std::min(off, pi - off));
        outcome.flat.add(store.voxels[landing->hit.voxel].normal.du == dvec3(0));
    }
    // A point beside it: the triangle reaches only half of its size from the centre.
    const double turn = random.uniform(0, 2 * pi);
    const dvec3 beside = small.centre + small.size * (std::cos(turn) * small.u + std::sin(turn) * small.v);
    outcome.false_hits.add(walk(loaded, start_ray(loaded, beside - 3.0 * way, way)).has_value());
}

Outcome measure(double size, HitTest rung, const NumberSettings& numbers, const Effort& effort) {
    Random random(effort.seed);
    Outcome outcome;
    for (int i = 0; i < effort.samples(600); ++i) {
        const Small small = make_small(size, random);
        const Loaded loaded(small.scene, settings_for(small.scene, numbers, rung));
        outcome.stored.add(loaded.machine.loaded().voxels > 0);
        for (int ray = 0; ray < 5; ++ray) shoot(loaded, small, random, outcome);
    }
    return outcome;
}

}  // namespace

Report study_small(const Effort& effort) {
    Report report{Table({"rung", "arithmetic", "size_cells", "triangles", "stored_percent", "found_percent",
                         "false_hit_percent", "largest_place_error_cells", "mean_normal_error_rad",
                         "one_normal_percent"}),
                  "", ""};
    double lost_at[2] = {0, 0};  // rung edge: exact, 20 bits
    double false_at = 0;
    double depth_found = 0;
    double flat_at = 0;
    for (const HitTest rung : all_rungs) {
        for (const NumberSettings& numbers : exact_and({20, 12})) {
            for (const double size : {1.0, 0.3, 0.1, 0.03, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
                const Outcome outcome = measure(size, rung, numbers, effort);
                report.table.add({name_of(rung), name_of(numbers), size, outcome.stored.all(),
                                  outcome.stored.percent(), outcome.found.percent(),
                                  outcome.false_hits.percent(), outcome.place.largest(),
                                  outcome.normal.mean(), outcome.flat.percent()});
                const bool exact = numbers.arithmetic == Numbers::exact;
                const bool twenty = !exact && numbers.word_bits == 20;
                if (rung == HitTest::depth && exact && size == 0.1) depth_found = outcome.found.percent();
                if (rung != HitTest::edge || !(exact || twenty)) continue;
                double& lost = lost_at[exact ? 0 : 1];
                if (lost == 0 && outcome.found.some() < outcome.found.all()) lost = size;
                if (twenty && false_at == 0 && outcome.false_hits.some() > 0) false_at = size;
                if (twenty && flat_at == 0 && outcome.flat.some() > 0) flat_at = size;
            }
        }
    }
    const auto from = [](double at) {
        return at == 0 ? std::string("never") : text("from %g cells down", at);
    };
    report.boundary = text(
        "rung edge: rays miss it %s in exact arithmetic, %s with 20 bits; hit beside it %s, one normal "
        "instead "
        "of three %s (20 bits). Rung depth finds %.1f %% of triangles of 0.1 cells",
        from(lost_at[0]).c_str(), from(lost_at[1]).c_str(), from(false_at).c_str(), from(flat_at).c_str(),
        depth_found);
    report.treatment =
        "documented: from interval up whatever touches a cell is stored, edges are widened by a hair (4 last "
        "bits), normals that turn faster than a word can say become one; rung depth keeps only what covers a "
        "pixel's centre. No warning";
    return report;
}

}  // namespace raycell::stability
