#include "model/truth/fineness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "model/numbers/arithmetic.hpp"
#include "model/truth/rows.hpp"
#include "model/truth/truth.hpp"

namespace raycell {

std::vector<double> chord_errors_at(const Scene& scene, const Frame& frame, double level, double least) {
    // The square error grows with chord error e and radius r as e·r for a sphere, whose voxels grow as r/e,
    // and as e·h for a cone of height h, whose voxels grow as h·sqrt(r/e). The fewest voxels for a sum of
    // errors are where one voxel more lessens it by the same anywhere: equal errors for spheres, smaller ones
    // for cones.
    std::vector<double> errors;
    errors.reserve(scene.primitives.size());
    for (const Primitive& primitive : scene.primitives) {
        double error = level;
        if (const auto* cone = std::get_if<ConePrimitive>(&primitive.shape)) {
            const double radius =
                std::max(cone->base_radius, cone->apex_radius) / frame.cell_width * frame.pixels_per_cell();
            error = std::pow(0.53 * level * level * std::sqrt(radius), 2.0 / 3);
        }
        errors.push_back(std::clamp(error, least, coarsest_chord_error));
    }
    return errors;
}

double told_chord_error(const Frame& frame, const PictureSettings& settings) {
    const Arithmetic arithmetic(settings.numbers, extent_of(frame));
    return arithmetic.exact() ? 0 : 2 * arithmetic.formats().unit.step() * frame.pixels_per_cell();
}

namespace {

/// The truth at the same pixels, of one tessellation after the other.
class Trials {
  public:
    Trials(const Scene& scene, const Frame& frame, const PictureSettings& settings, int threads)
        : scene_(scene),
          frame_(frame),
          settings_(settings),
          threads_(threads),
          least_(std::clamp(told_chord_error(frame, settings), finest_chord_error, coarsest_chord_error)),
          exact_(render(coarsest_chord_error, TruthOf::scene)) {}

    double least() const { return least_; }

    Fineness at(double level) const {
        Fineness tried;
        tried.level = level;
        tried.chord_errors = chord_errors_at(scene_, frame_, level, least_);
        const std::vector<dvec3> colours = render(level, TruthOf::polygons);
        double squares = 0;
        for (std::size_t i = 0; i < colours.size(); ++i) {
            const dvec3 error = glm::clamp(colours[i], 0.0, 1.0) - glm::clamp(exact_[i], 0.0, 1.0);
            squares += glm::dot(error, error);
        }
        const double mean = squares / (3.0 * double(colours.size()));
        tried.psnr_db = mean > 0 ? std::min(-10 * std::log10(mean), 200.0) : 200;
        tried.reached = tried.psnr_db >= settings_.tessellate_for - 0.5;
        return tried;
    }

  private:
    std::vector<dvec3> render(double level, TruthOf of) const {
        const CellScene placed =
            place_scene(scene_, frame_, settings_, chord_errors_at(scene_, frame_, level, least_));
        const bool outside = settings_.exterior == ExteriorMode::host;
        TruthSettings tree{settings_.max_depth, settings_.min_weight};
        tree.source_samples = settings_.source_samples;
        const TruthRenderer itself(placed, tree);
        tree.of = TruthOf::polygons;
        tree.beyond = outside ? &itself : nullptr;
        const TruthRenderer polygons(placed, tree);
        const TruthRenderer& truth = of == TruthOf::scene ? itself : polygons;
        const int columns = std::min(frame_.picture_width(), most_each_way);
        const int rows = std::min(frame_.picture_height(), most_each_way);
        std::vector<dvec3> colours(std::size_t(columns) * std::size_t(rows));
        const auto spread = [](int i, int count, int pixels) {
            return int(std::floor((i + 0.5) * pixels / count));
        };
        for_each_row(rows, threads_, {}, [&](int row) {
            for (int column = 0; column < columns; ++column) {
                const dvec2 at = frame_.place_in_pixel(spread(column, columns, frame_.picture_width()),
                                                       spread(row, rows, frame_.picture_height()));
                const Frame::PrimaryRay ray = frame_.primary_ray(at.x, at.y);
                colours[std::size_t(row) * std::size_t(columns) + std::size_t(column)] =
                    truth.radiance(ray.origin, ray.direction, no_polygon, 0, 1);
            }
        });
        return colours;
    }

    static constexpr int most_each_way = 256;

    const Scene& scene_;
    const Frame& frame_;
    const PictureSettings& settings_;
    int threads_;
    double least_;
    std::vector<dvec3> exact_;
};

}  // namespace

Fineness fineness_for(const Scene& scene, const Frame& frame, const PictureSettings& settings, int threads) {
    const bool curved =
        std::any_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& primitive) {
            return !std::holds_alternative<PolygonPrimitive>(primitive.shape);
        });
    if (!curved) return {};
    const Trials trials(scene, frame, settings, threads);
    const double goal = settings.tessellate_for;
    constexpr double too_good = 1.5;  // dB above the goal
    constexpr int most_trials = 9;
    double fine = trials.least();  // reached the goal, if any did
    double coarse = coarsest_chord_error;
    bool failed = false;
    double level = 0.2;
    std::optional<Fineness> best;
    for (int i = 0; i < most_trials && (!best || coarse > 1.05 * fine); ++i) {
        const Fineness tried = trials.at(level);
        // Errors are few pixels at outlines, so they don't fall evenly: what once was reached is kept.
        const bool better = !best || (tried.reached ? !best->reached || tried.level > best->level
                                                    : !best->reached && tried.psnr_db > best->psnr_db);
        if (better) best = tried;
        (tried.reached ? fine : coarse) = level;
        failed = failed || !tried.reached;
        const bool at_an_end = tried.reached ? level >= coarsest_chord_error : level <= trials.least();
        if (at_an_end || (tried.reached && tried.psnr_db <= goal + too_good)) break;
        // The square error is about proportional to the chord error.
        const double step = std::pow(10, 0.1 * (tried.psnr_db - goal));
        const double room = std::pow(coarse / fine, 0.15);
        level = std::clamp(level * std::clamp(step, 1.0 / 16, 4.0), best->reached ? fine * room : fine,
                           failed ? coarse / room : coarse);
    }
    return *best;
}

}  // namespace raycell
