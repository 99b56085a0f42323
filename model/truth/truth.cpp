#include "model/truth/truth.hpp"

#include <stdexcept>
#include <string>

#include "model/geometry/sampling.hpp"
#include "model/truth/area_light.hpp"
#include "model/truth/rows.hpp"

namespace raycell {

TruthCounts& operator+=(TruthCounts& sum, const TruthCounts& more) {
    sum.eye += more.eye;
    sum.eye_hits += more.eye_hits;
    sum.reflected += more.reflected;
    sum.refracted += more.refracted;
    sum.shadow += more.shadow;
    return sum;
}

/// What all rays of a tree share.
struct TruthRenderer::Tracer {
    const TruthRenderer& truth;
    TruthSettings limits;
    TruthCounts counts;

    Tracer(const TruthRenderer& renderer, const TruthSettings& settings)
        : truth(renderer), limits(settings) {}

    /// A ray's place in its tree.
    struct Rank {
        int generation;
        double weight;
    };

    dvec3 trace(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, Rank rank,
                double started = 0);
    dvec3 shade(const ShadePoint& point, const TruthHit& hit, Rank rank);
    dvec3 local(const ShadePoint& point, const Material& material, std::uint32_t polygon);
    std::uint64_t lit_sources(const ShadePoint& point, std::uint32_t polygon);
    bool sends(double share, Rank rank) const {
        return share > 0 && rank.generation < limits.max_depth && rank.weight * share >= limits.min_weight;
    }
    bool blocked(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, double reach) const;
    dvec3 leave(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, Rank rank, double t);
    void primary(const dvec2& at, Pixel& pixel);
};

ShadePoint TruthRenderer::point_at(const TruthHit& hit, const dvec3& direction) const {
    if (const Polygon* polygon = surfaces_.polygon(hit.index)) {
        const dvec3 normal = polygon->normal.at(project(hit.position, polygon->drop));
        return shade_point(hit.position, direction, normal, polygon->plane.n);
    }
    const dvec3 normal = normal_at(surfaces_.curved(hit.index), hit.position);
    return shade_point(hit.position, direction, normal, normal);
}

namespace {

/// Distance at which a ray from a point of the cube leaves it.
double way_out(const Box& cube, const dvec3& origin, const dvec3& direction) {
    double t = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const double face = direction[axis] > 0 ? cube.high[axis] : cube.low[axis];
        t = std::min(t, (face - origin[axis]) / direction[axis]);
    }
    return std::max(t, 0.0);
}

}  // namespace

/// Whether anything hides a source at distance `reach`.
bool TruthRenderer::Tracer::blocked(const dvec3& origin, const dvec3& direction, std::uint32_t exclude,
                                    double reach) const {
    const TruthRenderer* const beyond = truth.settings_.beyond;
    if (!beyond) return truth.occluded(origin, direction, exclude, reach);
    const double out = way_out(truth.scene_.frame.cube(), origin, direction);
    if (truth.occluded(origin, direction, exclude, std::min(reach, out + nearest_hit))) return true;
    return out < reach && beyond->occluded(origin + out * direction, direction, exclude, reach - out, -out);
}

/// Goes on with a ray from where it leaves the cube.
dvec3 TruthRenderer::Tracer::leave(const dvec3& origin, const dvec3& direction, std::uint32_t exclude,
                                   Rank rank, double t) {
    return truth.settings_.beyond->radiance(origin + t * direction, direction, exclude, rank.generation,
                                            rank.weight, &counts, -t);
}

/// One bit per source without extent that the normal faces and nothing hides.
std::uint64_t TruthRenderer::Tracer::lit_sources(const ShadePoint& point, std::uint32_t polygon) {
    const std::vector<Source>& sources = truth.scene_.sources;
    std::uint64_t lit = 0;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (is_area(sources[i].kind)) continue;
        const SourceView view = view_source(point, sources[i]);
        if (!view.faces()) continue;
        ++counts.shadow;
        if (!blocked(point.position, view.direction, polygon, view.distance)) lit |= std::uint64_t(1) << i;
    }
    return lit;
}

dvec3 TruthRenderer::Tracer::local(const ShadePoint& point, const Material& material, std::uint32_t polygon) {
    const std::vector<Source>& sources = truth.scene_.sources;
    dvec3 sum = local_intensity(point, material, sources.data(), sources.size(), lit_sources(point, polygon));
    for (const Source& source : sources) {
        if (!is_area(source.kind)) continue;
        sum += area_light(point, material, source, limits.source_samples,
                          [&](const dvec3& direction, double distance) {
                              ++counts.shadow;
                              return !blocked(point.position, direction, polygon, distance);
                          });
    }
    return sum;
}

dvec3 TruthRenderer::Tracer::shade(const ShadePoint& point, const TruthHit& hit, Rank rank) {
    const CellScene& scene = truth.scene_;
    const Material& material = scene.objects[truth.surfaces_.object(hit.index)];
    const dvec3 own = local(point, material, hit.polygon);
    dvec3 reflected(0), refracted(0);
    const double mirrored = mirror_share(material);
    const double transmitted = transmit_share(material);
    const bool by_rule = limits.transmitters_reflect && transmitted > 0 && rank.generation < limits.max_depth;
    if (by_rule || sends(mirrored, rank)) {
        ++counts.reflected;
        reflected = trace(point.position, reflect_direction(point), hit.polygon,
                          {rank.generation + 1, rank.weight * mirrored});
    }
    dvec3 onward;
    const bool bends = transmitted > 0 && refract_direction(point, material.ior, onward);
    if (sends(transmitted, rank) && !(by_rule && !bends)) {
        ++(bends ? counts.refracted : counts.reflected);
        refracted = trace(point.position, bends ? onward : reflect_direction(point), hit.polygon,
                          {rank.generation + 1, rank.weight * transmitted});
    }
    return combine_intensity(own, material, reflected, refracted);
}

dvec3 TruthRenderer::Tracer::trace(const dvec3& origin, const dvec3& direction, std::uint32_t exclude,
                                   Rank rank, double started) {
    const double out = truth.settings_.beyond ? way_out(truth.scene_.frame.cube(), origin, direction)
                                              : std::numeric_limits<double>::infinity();
    const std::optional<TruthHit> hit = truth.intersect(origin, direction, exclude, out, started);
    if (!hit && truth.settings_.beyond) return leave(origin, direction, exclude, rank, out);
    if (!hit) return truth.scene_.background;
    return shade(truth.point_at(*hit, direction), *hit, rank);
}

/// Fills a pixel from the primary ray through a point of the screen, cell coordinates.
void TruthRenderer::Tracer::primary(const dvec2& at, Pixel& pixel) {
    const Frame::PrimaryRay ray = truth.scene_.frame.primary_ray(at.x, at.y);
    ++counts.eye;
    const TruthRenderer* met = &truth;
    std::optional<TruthHit> hit;
    if (truth.settings_.beyond) {
        const double out = way_out(truth.scene_.frame.cube(), ray.origin, ray.direction);
        hit = truth.intersect(ray.origin, ray.direction, no_polygon, out);
        if (!hit) {
            met = truth.settings_.beyond;
            hit = met->intersect(ray.origin + out * ray.direction, ray.direction, no_polygon);
            pixel.colour = leave(ray.origin, ray.direction, no_polygon, {0, 1.0}, out);
        }
    } else {
        hit = truth.intersect(ray.origin, ray.direction, no_polygon);
    }
    if (!hit) {
        pixel.colour = truth.scene_.background;
        pixel.depth = std::numeric_limits<double>::infinity();
        return;
    }
    ++counts.eye_hits;
    const ShadePoint point = met->point_at(*hit, ray.direction);
    pixel.depth = hit->position.z;
    pixel.normal = point.normal;
    pixel.polygon = hit->polygon;
    if (met == &truth) pixel.colour = shade(point, *hit, {0, 1.0});
}

TruthSettings truth_settings(const PictureSettings& picture, int source_samples) {
    TruthSettings settings{picture.max_depth, picture.min_weight};
    settings.source_samples = source_samples;
    if (picture.samples == 1) return settings;
    settings.source_samples = source_samples_of_many(source_samples);
    settings.samples = converged_samples;
    settings.filter = picture.filter;
    settings.first_of = picture.samples;
    return settings;
}

TruthRenderer::TruthRenderer(const CellScene& scene, const TruthSettings& settings)
    : scene_(scene), settings_(settings), surfaces_(scene, settings.of), index_(surfaces_) {
    if (settings.max_depth < 0) throw std::invalid_argument("max_depth is negative");
    if (settings.source_samples < 1) throw std::invalid_argument("source_samples is below 1");
    if (scene.sources.size() > max_sources)
        throw std::invalid_argument(std::to_string(scene.sources.size()) + " sources, at most " +
                                    std::to_string(max_sources) + " are allowed");
    for (const Polygon& polygon : scene.polygons)
        if (polygon.object >= scene.objects.size())
            throw std::invalid_argument("polygon " + std::to_string(polygon.id) + " is of object " +
                                        std::to_string(polygon.object) + ", but there are only " +
                                        std::to_string(scene.objects.size()));
    for (const CurvedSurface& surface : scene.curved)
        if (surface.object >= scene.objects.size())
            throw std::invalid_argument("a curved surface is of object " + std::to_string(surface.object) +
                                        ", but there are only " + std::to_string(scene.objects.size()));
}

std::optional<TruthHit> TruthRenderer::intersect(const dvec3& origin, const dvec3& direction,
                                                 std::uint32_t exclude, double t_max, double started) const {
    const ProbeRay ray(origin, direction, started);
    const std::optional<SurfaceIndex::Nearest> found = index_.nearest(ray, exclude, t_max);
    if (!found) return std::nullopt;
    return TruthHit{found->t, surfaces_.id(found->index), found->index, ray.at(found->t)};
}

bool TruthRenderer::occluded(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, double t_max,
                             double started) const {
    return index_.any(ProbeRay(origin, direction, started), exclude, t_max - nearest_hit);
}

dvec3 TruthRenderer::radiance(const dvec3& origin, const dvec3& direction, std::uint32_t exclude,
                              int generation, double weight, TruthCounts* counts, double started) const {
    Tracer tracer(*this, settings_);
    const dvec3 intensity = tracer.trace(origin, direction, exclude, {generation, weight}, started);
    if (counts) *counts += tracer.counts;
    return intensity;
}

Picture TruthRenderer::render(int threads, const Progress& progress) const {
    const Frame& frame = scene_.frame;
    Picture picture(frame.picture_width(), frame.picture_height());
    const dvec2 first = sample_place(0, settings_.first_of, settings_.filter);
    for_each_row(picture.height, threads, progress, [&](int y) {
        Tracer tracer(*this, settings_);
        for (int x = 0; x < picture.width; ++x) {
            Pixel& shown = picture.at(x, y);
            tracer.primary(frame.place_in_pixel(x, y, first), shown);
            if (settings_.samples == 1) continue;
            shown.colour = pixel(x, y);
            shown.samples = std::uint32_t(settings_.samples);
        }
    });
    return picture;
}

dvec3 TruthRenderer::pixel(int column, int row, int taken) const {
    const int count = taken > 0 ? taken : settings_.samples;
    dvec3 sum(0);
    for (int sample = 0; sample < count; ++sample) {
        const dvec2 at = scene_.frame.place_in_pixel(
            column, row, sample_place(sample, settings_.samples, settings_.filter));
        const Frame::PrimaryRay ray = scene_.frame.primary_ray(at.x, at.y);
        sum += radiance(ray.origin, ray.direction, no_polygon, 0, 1);
    }
    return sum / double(count);
}

TruthCounts TruthRenderer::count(int n, int threads, const Progress& progress) const {
    if (n < 2) throw std::invalid_argument("rays are counted on a grid of at least 2 by 2");
    // The field of view ends at the centres of the outermost pixels (nff.md: `angle`).
    const Frame& frame = scene_.frame;
    const dvec2 first = frame.place_in_pixel(0, 0);
    const dvec2 step =
        (frame.place_in_pixel(frame.picture_width() - 1, frame.picture_height() - 1) - first) / (n - 1.0);
    std::vector<TruthCounts> rows(static_cast<std::size_t>(n));
    for_each_row(n, threads, progress, [&](int y) {
        Tracer tracer(*this, {4, 0.0, true, settings_.of});
        Pixel unused;
        for (int x = 0; x < n; ++x) tracer.primary(first + dvec2(x, y) * step, unused);
        rows[static_cast<std::size_t>(y)] = tracer.counts;
    });
    TruthCounts sum;
    for (const TruthCounts& row : rows) sum += row;
    return sum;
}

}  // namespace raycell
