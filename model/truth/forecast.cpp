#include "model/truth/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace raycell {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Bounds of a polygon's outline; its sides are cut to the array.
struct Outline {
    double left = infinite, right = -infinite, top = infinite, bottom = -infinite;
    double near = infinite, far = -infinite;

    Outline(const Polygon& polygon, const Frame& frame) {
        for (const dvec3& v : polygon.vertices) {
            left = std::min(left, v.x), right = std::max(right, v.x);
            top = std::min(top, v.y), bottom = std::max(bottom, v.y);
            near = std::min(near, v.z), far = std::max(far, v.z);
        }
        inside_ = right > 0 && left < frame.width && bottom > 0 && top < frame.height && far >= 0 &&
                  near <= frame.depth;
        left = std::max(left, 0.0), right = std::min(right, double(frame.width));
        top = std::max(top, 0.0), bottom = std::min(bottom, double(frame.height));
    }
    bool inside() const { return inside_; }
    int first_row() const { return int(top); }
    int last_row(const Frame& frame) const { return std::min(int(bottom), frame.height - 1); }

  private:
    bool inside_ = false;
};

/// Columns that a polygon's spans cross from the left border, summed over its rows.
double columns_passed(const Polygon& polygon, const Outline& outline, const Frame& frame) {
    const int first = outline.first_row();
    const int rows = outline.last_row(frame) - first + 1;
    const double last_column = frame.width - 1;
    if (rows <= 2) {  // most polygons of a fine tessellation
        return rows * std::min(outline.right, last_column);
    }
    double sum = 0;
    const auto& outer = polygon.vertices;
    for (int row = first; row < first + rows; ++row) {
        double right = 0;
        for (std::size_t i = 0; i < outer.size(); ++i) {
            const dvec3& a = outer[i];
            const dvec3& b = outer[(i + 1) % outer.size()];
            if (std::max(a.y, b.y) < row || std::min(a.y, b.y) > row + 1) continue;
            for (const double y : {double(row), row + 1.0}) {
                const double t = a.y == b.y ? 0 : std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
                right = std::max(right, a.x + t * (b.x - a.x));
            }
        }
        sum += std::min(right, last_column);
    }
    return sum;
}

/// Approximate number of cells that a polygon touches: that of a convex outline placed at random on a grid.
double touched_cells(const Polygon& polygon, const Outline& outline) {
    const double width = outline.right - outline.left;
    const double height = outline.bottom - outline.top;
    double doubled = 0;
    const auto& v = polygon.vertices;
    for (std::size_t i = 1; i + 1 < v.size(); ++i)
        doubled += (v[i].x - v[0].x) * (v[i + 1].y - v[0].y) - (v[i + 1].x - v[0].x) * (v[i].y - v[0].y);
    return std::min(std::abs(doubled) / 2, width * height) + width + height + 1;
}

/// Adds the loading: spans travel from the left border to their last cell; broadcast messages cross all
/// cells. Every vertex between the top and the bottom one cuts its row's span in two.
void forecast_loading(const CellScene& scene, Forecast& sum) {
    const Frame& frame = scene.frame;
    double broadcasts = 2;  // viewer and sources, end of scene
    std::int64_t object = -1;
    for (const Polygon& polygon : scene.polygons) {
        const Outline outline(polygon, frame);
        if (!outline.inside()) continue;
        if (std::int64_t(polygon.object) != object) ++broadcasts;
        object = polygon.object;
        const double cuts = double(polygon.vertices.size()) - 2;
        sum.load_hops += columns_passed(polygon, outline, frame) + cuts * outline.right;
        sum.voxels += touched_cells(polygon, outline);
        sum.load_steps += (1 + cuts) * (outline.last_row(frame) + 1);
    }
    sum.load_hops += broadcasts * frame.height * (frame.width - 1.0);
    sum.load_steps += broadcasts * frame.height;
}

/// Follows rays of single pixels through the array, counting hops.
class Sampler {
  public:
    Sampler(const CellScene& scene, const PictureSettings& settings, const TruthRenderer& truth)
        : scene_(scene),
          settings_(settings),
          truth_(truth),
          lights_(scene.sources, settings.source_samples, exact_arithmetic()) {}

    double hops = 0;

    /// False once the ray limit of a forecast is reached.
    bool may_go_on() const { return rays_ < most_rays; }
    void primary(const dvec2& at) {
        const Frame::PrimaryRay ray = scene_.frame.primary_ray(at.x, at.y);
        follow({ray.origin, ray.direction, no_polygon}, 0, 1);
    }
    /// Follows a precast ray from a point of a polygon to a source; an unblocked one sends no answer.
    void precast(const dvec3& point, const Polygon& polygon) {
        ShadePoint from;
        from.position = point;
        for (std::size_t light = 0; light < lights_.rays.size(); ++light) {
            const SourceView view = view_light(from, lights_, light);
            if (view.distance > 0) shadow({point, view.direction, polygon.id}, view.distance, true);
        }
    }

  private:
    struct Start {
        dvec3 origin;
        dvec3 direction;
        std::uint32_t polygon;  ///< that it leaves
    };
    struct Cell {
        int x;
        int y;
    };
    static constexpr std::uint64_t most_rays = 200000;

    Cell cell_at(const dvec3& p) const {
        return {std::clamp(int(std::floor(p.x)), 0, scene_.frame.width - 1),
                std::clamp(int(std::floor(p.y)), 0, scene_.frame.height - 1)};
    }
    static double between(Cell a, Cell b) { return std::abs(a.x - b.x) + std::abs(a.y - b.y); }
    bool exterior(Face face) const {
        return settings_.exterior == ExteriorMode::host && scene_.beyond[std::size_t(face)];
    }

    double leaves_cube(const Start& ray, Face& face) const;
    double to_border(const dvec3& from, const dvec3& direction) const;
    void leave(const Start& ray, double t, Face face, bool answered);
    void shadow(const Start& ray, double distance, bool silent);
    void follow(const Start& ray, int generation, double weight);
    void shade(const TruthHit& hit, const dvec3& direction, int generation, double weight);

    const CellScene& scene_;
    const PictureSettings& settings_;
    const TruthRenderer& truth_;
    Lights lights_;
    std::uint64_t rays_ = 0;
};

/// Distance at which a ray leaves the cube; sets the face.
double Sampler::leaves_cube(const Start& ray, Face& face) const {
    const dvec3 far = scene_.frame.cube().high;
    double leave = infinite;
    for (int axis = 0; axis < 3; ++axis) {
        const double way = ray.direction[axis];
        if (way == 0) continue;
        const double t = ((way > 0 ? far[axis] : 0) - ray.origin[axis]) / way;
        if (t >= leave) continue;
        leave = std::max(t, 0.0);
        face = Face(2 * axis + (way > 0 ? 1 : 0));
    }
    return leave;
}

/// Cells from a place to the array's border, straight on; an axial ray goes east.
double Sampler::to_border(const dvec3& from, const dvec3& direction) const {
    const Frame& frame = scene_.frame;
    dvec2 way(direction.x, direction.y);
    if (way.x == 0 && way.y == 0) way.x = 1;
    double t = infinite;
    if (way.x != 0) t = std::min(t, ((way.x > 0 ? frame.width : 0) - from.x) / way.x);
    if (way.y != 0) t = std::min(t, ((way.y > 0 ? frame.height : 0) - from.y) / way.y);
    return std::max(t, 0.0) * (std::abs(way.x) + std::abs(way.y));
}

void Sampler::leave(const Start& ray, double t, Face face, bool answered) {
    const dvec3 end = ray.origin + t * ray.direction;
    double way = between(cell_at(ray.origin), cell_at(end));
    hops += way;
    if (exterior(face)) {
        if (face >= face_front) {
            const double more = to_border(end, ray.direction);
            hops += more;
            way += more;
        }
        hops += answered ? 2 : 1;
    }
    if (answered) hops += way;
}

void Sampler::shadow(const Start& ray, double distance, bool silent) {
    ++rays_;
    Face face = face_back;
    const double exit = leaves_cube(ray, face);
    const double reach = std::min(exit, distance);
    const auto hit = truth_.intersect(ray.origin, ray.direction, ray.polygon, reach - nearest_hit);
    if (!hit && exit < distance) return leave(ray, exit, face, !silent);
    const Cell end = cell_at(ray.origin + (hit ? hit->t : distance) * ray.direction);
    hops += (hit || !silent ? 2 : 1) * between(cell_at(ray.origin), end);
}

void Sampler::follow(const Start& ray, int generation, double weight) {
    if (!may_go_on()) return;
    ++rays_;
    Face face = face_back;
    const double exit = leaves_cube(ray, face);
    const auto hit = truth_.intersect(ray.origin, ray.direction, ray.polygon, exit);
    if (!hit) return leave(ray, exit, face, true);
    hops += 2 * between(cell_at(ray.origin), cell_at(hit->position));
    shade(*hit, ray.direction, generation, weight);
}

void Sampler::shade(const TruthHit& hit, const dvec3& direction, int generation, double weight) {
    const Material& material = scene_.objects[truth_.object_of(hit)];
    const ShadePoint point = truth_.point_at(hit, direction);
    if (settings_.shadows != Shadows::precast) {
        for (std::size_t light = 0; light < lights_.rays.size(); ++light) {
            const SourceView view = view_light(point, lights_, light);
            if (view.faces()) shadow({point.position, view.direction, hit.polygon}, view.distance, false);
        }
    }
    const auto sends = [&](double share) {
        return share > 0 && generation < settings_.max_depth && weight * share >= settings_.min_weight;
    };
    const double mirrored = mirror_share(material);
    if (sends(mirrored))
        follow({point.position, reflect_direction(point), hit.polygon}, generation + 1, weight * mirrored);
    const double transmitted = transmit_share(material);
    if (sends(transmitted)) {
        follow({point.position, transmit_direction(point, material.ior), hit.polygon}, generation + 1,
               weight * transmitted);
    }
}

/// Forecasts hops from all rays of an even sample of pixels. The beginning of the sample is spread evenly
/// too, since the ray limit may end it early.
double forecast_trace(const CellScene& scene, const PictureSettings& settings, const TruthRenderer& truth,
                      int samples) {
    const Frame& frame = scene.frame;
    const double pixels = double(frame.picture_width()) * frame.picture_height();
    // A low-discrepancy sequence in the plane: multiples of two powers of the plastic number.
    constexpr double alpha_x = 0.7548776662466927;
    constexpr double alpha_y = 0.5698402909980532;
    Sampler sampler(scene, settings, truth);
    int taken = 0;
    for (; taken < samples && sampler.may_go_on(); ++taken) {
        const auto place = [&](double alpha, int size) {
            const double at = 0.5 + alpha * taken;
            return std::min(int((at - std::floor(at)) * size), size - 1);
        };
        sampler.primary(frame.place_in_pixel(place(alpha_x, frame.picture_width()),
                                             place(alpha_y, frame.picture_height())));
    }
    return sampler.hops * pixels * settings.samples / taken;
}

/// Forecasts hops of a ray from every voxel to every source. Samples polygons evenly by their voxels, and
/// takes a point of each.
double forecast_precast(const CellScene& scene, const PictureSettings& settings, const TruthRenderer& truth,
                        int samples) {
    std::vector<double> voxels;  ///< running total, with each polygon
    double sum = 0;
    for (const Polygon& polygon : scene.polygons) {
        const Outline outline(polygon, scene.frame);
        if (outline.inside()) sum += touched_cells(polygon, outline);
        voxels.push_back(sum);
    }
    if (sum <= 0 || scene.sources.empty()) return 0;
    Sampler sampler(scene, settings, truth);
    int taken = 0;
    for (; taken < samples && sampler.may_go_on(); ++taken) {
        const double wanted = sum * (taken + 0.5) / samples;
        const auto found = std::upper_bound(voxels.begin(), voxels.end(), wanted);
        const Polygon& polygon = scene.polygons[std::size_t(found - voxels.begin())];
        // A point in the polygon: between its middle and one of its vertices.
        dvec3 middle{0, 0, 0};
        for (const dvec3& vertex : polygon.vertices) middle += vertex / double(polygon.vertices.size());
        const dvec3& vertex = polygon.vertices[std::size_t(taken) % polygon.vertices.size()];
        const double share = std::sqrt(std::fmod(0.5 + 0.6180339887498949 * taken, 1.0));
        const dvec3 point = glm::clamp(middle + share * (vertex - middle), dvec3(0), scene.frame.cube().high);
        sampler.precast(point, polygon);
    }
    return sampler.hops * sum / taken;
}

}  // namespace

Forecast forecast(const CellScene& scene, const PictureSettings& settings, const TruthRenderer* truth,
                  int samples) {
    Forecast sum;
    forecast_loading(scene, sum);
    if (!truth || settings.stage == RunStage::load) return sum;
    if (settings.shadows == Shadows::precast)
        sum.precast_hops = forecast_precast(scene, settings, *truth, samples);
    sum.trace_hops = forecast_trace(scene, settings, *truth, samples);
    return sum;
}

}  // namespace raycell
