// Two facing mirrors: how errors grow from generation to generation.
#include <memory>

#include "model/picture/compare.hpp"
#include "model/truth/exterior.hpp"
#include "scenes/load_scene.hpp"
#include "testbench/stability/bench.hpp"
#include "testbench/stability/studies.hpp"

namespace raycell::stability {
namespace {

constexpr int most_generations = 62;

/// Parallel mirrors 40 cells apart, tilted, one behind the other; a source beside the way.
struct Corridor {
    CellScene scene;
    dvec3 normal;
    dvec3 middle{16, 16, 32};
};
Corridor make_corridor(Random& random) {
    Corridor corridor;
    corridor.scene = empty_scene(32, 32, 64, 1024);
    Material material;
    material.colour = {0.4, 0.6, 0.2};
    material.diffuse = 0.04;
    material.specular = 0.96;
    material.shine = 30;
    const std::uint32_t object = add_object(corridor.scene, material);
    corridor.normal = glm::normalize(dvec3(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 1));
    for (const double side : {-20.0, 20.0}) {
        add_cross_section(corridor.scene, object, corridor.middle + side * corridor.normal, corridor.normal);
    }
    corridor.scene.sources.push_back(
        {corridor.middle + dvec3(9, 2, 3), dvec3(0.5)});  // the sum of all intensities stays below 8
    return corridor;
}

struct Generation {
    Errors position;
    Errors intensity;
};

/// Follows one ray through its reflections. Adds the distance of each hit from the truth's, and the intensity
/// error of a tree that ends there.
void follow(const Loaded& loaded, const std::vector<std::unique_ptr<TruthRenderer>>& truths,
            const dvec3& origin, const dvec3& direction, std::vector<Generation>& generations) {
    const TruthRenderer& truth = *truths.front();
    auto landing = walk(loaded, start_ray(loaded, origin, direction));
    auto hit = truth.intersect(origin, direction, no_polygon);
    dvec3 way = direction;
    std::vector<HitSetup> hits;
    for (std::size_t i = 0; i <= most_generations; ++i) {
        if (!landing || !hit || landing->polygon != hit->polygon) return;
        const CellStore& store = loaded.cell(landing->x, landing->y);
        hits.push_back(
            set_up_hit(loaded.context(), store, landing->ray, landing->hit, landing->x, landing->y));
        if (truths[i]) {
            generations[i].position.add(glm::distance(landing->point, hit->position));
            dvec3 answer(0);  // the last generation gets no answer
            for (std::size_t h = hits.size(); h-- > 0;) {
                answer = shade_hit(loaded.context(), hits[h], 1, hits[h].facing, answer, dvec3(0));
            }
            const dvec3 wanted = truths[i]->radiance(origin, direction, no_polygon, 0, 1.0);
            const dvec3 off = glm::abs(answer - wanted);
            generations[i].intensity.add(std::max({off.x, off.y, off.z}));
        }
        if (!hits.back().reflects) return;
        const Ray next = reflected_ray(loaded.context(), store, landing->ray, landing->hit, hits.back(),
                                       landing->x, landing->y);
        landing = walk(loaded, {next, landing->x, landing->y});
        const dvec3& n = loaded.scene.polygons[hit->index].plane.n;
        way -= 2 * glm::dot(way, n) * n;
        hit = truth.intersect(hit->position, way, hit->polygon);
    }
}

constexpr int measured_generations[] = {0, 1, 2, 4, 8, 16, 32, most_generations};

std::vector<Generation> follow_all(const NumberSettings& numbers, const Effort& effort) {
    std::vector<Generation> generations(most_generations + 1);
    Random random(effort.seed);
    for (int i = 0; i < effort.samples(40); ++i) {
        const Corridor corridor = make_corridor(random);
        PictureSettings settings = settings_for(corridor.scene, numbers);
        settings.max_depth = most_generations;
        settings.min_weight = 0;
        const Loaded loaded(corridor.scene, settings);
        std::vector<std::unique_ptr<TruthRenderer>> truths(most_generations + 1);
        for (const int end : measured_generations) {
            truths[std::size_t(end)] = std::make_unique<TruthRenderer>(loaded.scene, TruthSettings{end, 0});
        }
        for (int ray = 0; ray < 20; ++ray) {
            const dvec3 aside{random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004), 0};
            follow(loaded, truths, corridor.middle, glm::normalize(corridor.normal + aside), generations);
        }
    }
    return generations;
}

/// Accuracy of a scene's picture with trees of this many generations, against the truth with the same.
Accuracy picture_error(const Scene& scene, const NumberSettings& numbers, int generations, int cells) {
    PictureSettings settings;
    settings.width = settings.height = cells;
    settings.max_depth = generations;
    settings.min_weight = 0;
    settings.numbers = numbers;
    const CellScene placed = place_scene(scene, place_frame(scene, settings), settings);
    const TruthRenderer truth(placed, {generations, 0});
    const ClassicalExterior exterior(placed, truth);
    UntimedMachine machine(placed, settings, &exterior);
    const TruthRenderer polygons(placed, {generations, 0, false, TruthOf::polygons, &truth});
    return compare(machine.render(), polygons.render(1));
}

}  // namespace

Report study_mirrors(const Effort& effort) {
    Report report{Table({"arithmetic", "generations", "rays", "largest_position_error_cells",
                         "mean_position_error_cells", "largest_intensity_error", "mean_intensity_error",
                         "scene_psnr_db"}),
                  "", ""};
    Diagnostics diagnostics;
    const std::filesystem::path file =
        std::filesystem::path(RAYCELL_SOURCE_DIR) / "scenes/facing_mirrors.nff";
    const Scene scene = load_scene(file, std::nullopt, diagnostics);
    for (const NumberSettings& numbers : exact_and({24, 20, 16, 12})) {
        const std::vector<Generation> generations = follow_all(numbers, effort);
        double psnr = 0;
        for (const int end : measured_generations) {
            const Generation& last = generations[std::size_t(end)];
            psnr = picture_error(scene, numbers, end, effort.quick ? 16 : 48).psnr_db;
            report.table.add({name_of(numbers), std::int64_t(end), last.position.count(),
                              last.position.largest(), last.position.mean(), last.intensity.largest(),
                              last.intensity.mean(), psnr});
        }
        const Generation& last = generations.back();
        report.boundary +=
            text("%s%s: %.2g cells, intensity %.2g, own scene %.1f dB",
                 report.boundary.empty() ? "after 62 generations " : "; ", name_of(numbers).c_str(),
                 last.position.largest(), last.intensity.largest(), psnr);
    }
    report.treatment =
        "limit: --max-depth goes to 62, since a message has 6 bits for the generation and the shadow rays of "
        "the last one are one more (63); --min-weight (default 1/256) ends a tree earlier";
    return report;
}

}  // namespace raycell::stability
