// The chord error: spheres of polygons, from a few facets to more than a cell can tell apart.
#include <cmath>

#include "model/geometry/tessellate.hpp"
#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr double size = 48;  ///< of the cube, cells: rays start inside

struct Ball {
    CellScene scene;
    dvec3 centre;
    double radius;
};

/// A sphere near the middle of the cube, as geometry makes it.
Ball make_ball(double radius, double chord_error, Random& random) {
    Ball ball;
    ball.scene = empty_scene(int(size), int(size), size, 1024);
    ball.radius = radius;
    for (int axis = 0; axis < 3; ++axis) ball.centre[axis] = size / 2 + random.uniform(-2, 2);
    Frame still;  // cells are the world's units
    still.right = {1, 0, 0};
    still.down = {0, 1, 0};
    still.forward = {0, 0, 1};
    still.corner = dvec3(0);
    still.cell_width = 1;
    SpherePrimitive sphere;
    sphere.centre = ball.centre;
    sphere.radius = radius;
    ball.scene.polygons = tessellate({0, sphere}, 0, still, chord_error);
    return ball;
}

struct Outcome {
    std::size_t facets = 0;
    double most_voxels = 0;  ///< in a cell
    Errors place;            ///< of hits, distance from the sphere
    Errors normal;           ///< of hits
    Share lost;              ///< rays aimed inside by more than the chord error that meet nothing
    Share beside;            ///< rays that pass outside by more than that and meet something
};

void shoot(const Ball& ball, const Loaded& loaded, double chord_error, Random& random, Outcome& outcome) {
    const dvec3 way = random.direction();
    const dvec3 aside = glm::normalize(glm::cross(way, random.direction()));
    const double slack = chord_error + 0.01;  // and the tolerance of short words
    const double off = random.uniform(0, 1.2) * ball.radius;
    const dvec3 start = ball.centre + off * aside - (ball.radius + 1) * way;
    const auto landing = walk(loaded, start_ray(loaded, start, way));
    if (off < ball.radius - slack) outcome.lost.add(!landing);
    if (off > ball.radius + slack) outcome.beside.add(landing.has_value());
    if (!landing || off > 0.95 * ball.radius) return;
    const dvec3 from_centre = start + landing->t * way - ball.centre;
    outcome.place.add(std::abs(glm::length(from_centre) - ball.radius));
    const HitSetup setup = set_up_hit(loaded.context(), loaded.cell(landing->x, landing->y), landing->ray,
                                      landing->hit, landing->x, landing->y);
    const double angle = angle_between(setup.point.normal, from_centre);
    outcome.normal.add(std::min(angle, pi - angle));
}

Outcome measure(double radius, double chord_error, const NumberSettings& numbers, const Effort& effort) {
    Random random(effort.seed);
    Outcome outcome;
    for (int i = 0; i < effort.samples(20); ++i) {
        const Ball ball = make_ball(radius, chord_error, random);
        const Loaded loaded(ball.scene, settings_for(ball.scene, numbers));
        outcome.facets = ball.scene.polygons.size();
        outcome.most_voxels = std::max(outcome.most_voxels, double(loaded.machine.storage().max_voxels));
        for (int ray = 0; ray < 200; ++ray) shoot(ball, loaded, chord_error, random, outcome);
    }
    return outcome;
}

}  // namespace

Report study_chord_error(const Effort& effort) {
    Report report{Table({"arithmetic", "radius_cells", "chord_error_cells", "facets", "most_voxels_in_a_cell",
                         "largest_place_error_cells", "mean_normal_error_rad", "rays_lost_percent",
                         "hits_beside_percent"}),
                  "", ""};
    double worst_place = 0;  // of exact arithmetic, over the chord error
    double lost_8 = 0;
    double lost_longer = 0;
    double beside = 0;
    for (const NumberSettings& numbers : exact_and({20, 12, 8})) {
        const bool exact = numbers.arithmetic == Numbers::exact;
        for (const double radius : {0.5, 2.0, 8.0}) {
            for (const double chord_error : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005}) {
                const Outcome o = measure(radius, chord_error, numbers, effort);
                report.table.add({name_of(numbers), radius, chord_error, std::int64_t(o.facets),
                                  o.most_voxels, o.place.largest(), o.normal.mean(), o.lost.percent(),
                                  o.beside.percent()});
                if (exact) worst_place = std::max(worst_place, o.place.largest() / chord_error);
                const bool shortest = !exact && numbers.word_bits == 8;
                double& lost = shortest ? lost_8 : lost_longer;
                lost = std::max(lost, o.lost.percent());
                if (!shortest) beside = std::max(beside, o.beside.percent());
            }
        }
    }
    report.boundary = text(
        "in exact arithmetic no hit is farther from the sphere than %.2f chord errors; with 12 bits and more "
        "at most "
        "%.2g %% of the rays get lost and %.2g %% hit beside, with 8 bits %.2g %% get lost",
        worst_place, lost_longer, beside, lost_8);
    report.treatment =
        "documented: facets lie half a chord error inside and half outside of the surface; --tessellate-for "
        "chooses no "
        "chord error that words can't tell from none, and warns where the accuracy asked for isn't reached";
    return report;
}

}  // namespace raycell::stability
