// Directions that a hit computes: reflected at grazing angles, refracted around the critical angle.
#include <cmath>

#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr double tile = 3;  ///< width of a polygon of the mirror, cells

/// A flat mirror of 5 by 5 polygons, tilted at random. A ray that it reflects can't meet it again.
struct Mirror {
    CellScene scene;
    dvec3 corner;
    dvec3 u;
    dvec3 v;
    dvec3 normal;
};
Mirror make_mirror(Random& random) {
    Mirror mirror;
    mirror.scene = empty_scene(24, 24, 24, 1024);
    Material material;
    material.specular = 0.8;
    const std::uint32_t object = add_object(mirror.scene, material);
    mirror.normal = random.direction();
    mirror.u = glm::normalize(glm::cross(mirror.normal, random.direction()));
    mirror.v = glm::cross(mirror.normal, mirror.u);
    mirror.corner = dvec3(12) - 2.5 * tile * (mirror.u + mirror.v);
    const auto at = [&](int i, int j) {
        return mirror.corner + tile * (double(i) * mirror.u + double(j) * mirror.v);
    };
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            add_polygon(mirror.scene, object, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mirror;
}

struct Reflections {
    Share below;
    Share hit_again;
    Errors angle;
};

/// Reflects a ray that arrives at a random point of an inner polygon of the mirror, in the cell there.
void reflect_at(const Loaded& loaded, const Mirror& mirror, double grazing, Random& random,
                Reflections& sum) {
    const int i = 1 + int(random.uniform(0, 3));
    const int j = 1 + int(random.uniform(0, 3));
    const dvec3 point = mirror.corner + tile * ((i + random.uniform(0, 1)) * mirror.u +
                                                (j + random.uniform(0, 1)) * mirror.v);
    const double turn = random.uniform(0, 2 * pi);
    const dvec3 along = std::cos(turn) * mirror.u + std::sin(turn) * mirror.v;
    const dvec3 way = std::cos(grazing) * along - std::sin(grazing) * mirror.normal;
    const Placed placed = start_ray(loaded, point, way);
    const CellStore& store = loaded.cell(placed.x, placed.y);
    const auto polygon = std::uint32_t(5 * i + j);
    for (std::uint32_t voxel = 0; voxel < store.voxels.size(); ++voxel) {
        if (store.voxels[voxel].polygon != polygon) continue;
        const CellHit hit{0, voxel};
        const HitSetup setup = set_up_hit(loaded.context(), store, placed.ray, hit, placed.x, placed.y);
        const Ray reflected =
            reflected_ray(loaded.context(), store, placed.ray, hit, setup, placed.x, placed.y);
        const dvec3 wanted = way + 2 * std::sin(grazing) * mirror.normal;
        sum.below.add(glm::dot(reflected.direction, mirror.normal) <= 0);
        sum.hit_again.add(walk(loaded, {reflected, placed.x, placed.y}).has_value());
        sum.angle.add(angle_between(reflected.direction, wanted));
    }
}

}  // namespace

Report study_grazing(const Effort& effort) {
    Report report{Table({"arithmetic", "grazing_rad", "rays", "below_percent", "hit_again_percent",
                         "largest_angle_error_rad"}),
                  "", ""};
    for (const NumberSettings& numbers : exact_and({32, 24, 20, 16, 12})) {
        double first_below = 0;
        double first_again = 0;
        for (const double grazing : {1.0, 0.3, 0.1, 0.03, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5}) {
            Random random(effort.seed);
            Reflections sum;
            for (int i = 0; i < effort.samples(80); ++i) {
                const Mirror mirror = make_mirror(random);
                const Loaded loaded(mirror.scene, settings_for(mirror.scene, numbers));
                for (int ray = 0; ray < 50; ++ray) reflect_at(loaded, mirror, grazing, random, sum);
            }
            report.table.add({name_of(numbers), grazing, sum.below.all(), sum.below.percent(),
                              sum.hit_again.percent(), sum.angle.largest()});
            if (first_below == 0 && sum.below.some() > 0) first_below = grazing;
            if (first_again == 0 && sum.hit_again.some() > 0) first_again = grazing;
        }
        const auto from = [](double angle) {
            return angle == 0 ? std::string("never") : text("from %g rad", angle);
        };
        report.boundary +=
            text("%s%s: under the surface %s, hits it again %s", report.boundary.empty() ? "" : "; ",
                 name_of(numbers).c_str(), from(first_below).c_str(), from(first_again).c_str());
    }
    report.treatment =
        "documented: a reflected ray can't hit the polygon that it leaves, starts a normal offset to the "
        "side "
        "that it goes to, and passes neighbours within 64 last bits of its start; a ray that points under "
        "the "
        "surface is not told apart and goes on behind it";
    return report;
}

namespace {

struct Refractions {
    Share wrongly_total;      ///< of rays short of the critical angle
    Share wrongly_refracted;  ///< of rays beyond it
    Errors angle;             ///< of those that refract, and should
};

/// A ray inside glass meets its surface `off` radians short of (negative) or beyond the critical angle.
void refract_at(double off, double ior, const Arithmetic& arithmetic, Random& random, Refractions& sum) {
    const dvec3 normal = random.direction();
    const dvec3 along = glm::normalize(glm::cross(normal, random.direction()));
    const double angle = std::asin(1 / ior) + off;
    ShadePoint exact;
    exact.direction = std::sin(angle) * along - std::cos(angle) * normal;
    exact.normal = normal;
    exact.entering = false;
    ShadePoint held = exact;
    held.direction = arithmetic.normalise(exact.direction);
    held.normal = arithmetic.normalise(exact.normal);
    dvec3 wanted{0, 0, 1};
    dvec3 got{0, 0, 1};
    const bool refracted = refract_direction(held, ior, got, arithmetic);
    if (off > 0) {
        sum.wrongly_refracted.add(refracted);
        return;
    }
    sum.wrongly_total.add(!refracted);
    refract_direction(exact, ior, wanted);
    if (refracted) sum.angle.add(angle_between(got, wanted));
}

}  // namespace

Report study_critical(const Effort& effort) {
    Report report{Table({"arithmetic", "from_critical_rad", "rays_per_side", "wrongly_total_percent",
                         "wrongly_refracted_percent", "largest_angle_error_rad", "mean_angle_error_rad"}),
                  "", ""};
    constexpr double ior = 1.5;  // exact in every word of 8 bits and more
    for (const NumberSettings& numbers : exact_and({32, 24, 20, 16, 12})) {
        const Arithmetic arithmetic(numbers, {128, 128, 128, 0.125});
        double wrong_within = 0;
        for (const double off : {0.3, 0.1, 0.03, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7}) {
            Random random(effort.seed);
            Refractions sum;
            for (int i = 0; i < effort.samples(4000); ++i) {
                refract_at(-off, ior, arithmetic, random, sum);
                refract_at(off, ior, arithmetic, random, sum);
            }
            report.table.add({name_of(numbers), off, sum.wrongly_total.all(), sum.wrongly_total.percent(),
                              sum.wrongly_refracted.percent(), sum.angle.largest(), sum.angle.mean()});
            if (sum.wrongly_total.some() + sum.wrongly_refracted.some() > 0) {
                wrong_within = std::max(wrong_within, off);
            }
        }
        report.boundary += text(
            "%s%s %s", report.boundary.empty() ? "wrong verdicts from so near the critical angle: " : "; ",
            name_of(numbers).c_str(), wrong_within == 0 ? "none" : text("%g rad", wrong_within).c_str());
    }
    report.treatment =
        "documented: a negative number under the square root is total reflection and sends no refracted ray; "
        "there is no special case near 0, where the angle's error grows as the root's does";
    return report;
}

}  // namespace raycell::stability
