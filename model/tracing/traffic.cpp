#include "model/tracing/traffic.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace raycell {
namespace {

constexpr double child_share = 0.5;  ///< share of a child's intensity in its parent's

/// Finaliser of SplitMix64 (Steele, Lea & Flood 2014).
std::uint64_t mix(std::uint64_t h) {
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ h >> 27) * 0x94d049bb133111ebULL;
    return h ^ h >> 31;
}

void check_share(const char* name, double value) {
    if (value >= 0 && value <= 1) return;
    throw std::invalid_argument(std::string(name) + ": expected 0 to 1, not " + std::to_string(value));
}

std::uint32_t cell_index(const CellStore& store) { return store.voxels[0].polygon; }

}  // namespace

SyntheticTraffic::SyntheticTraffic(const TrafficSettings& settings) : settings_(settings) {
    check_share("hit probability", settings.hit_probability);
    check_share("probability of a reflected child", settings.reflected);
    check_share("probability of a refracted child", settings.refracted);
    check_share("share that turns back", settings.turn_back);
    if (settings.sources < 0 || std::size_t(settings.sources) > max_sources) {
        throw std::invalid_argument("sources: expected 0 to " + std::to_string(max_sources) + ", not " +
                                    std::to_string(settings.sources));
    }
}

double SyntheticTraffic::draw(Draw what, std::uint64_t ray, std::uint32_t cell, std::uint32_t count) const {
    std::uint64_t h = mix(settings_.seed + 0x9e3779b97f4a7c15ULL);
    h = mix(h ^ ray);
    h = mix(h ^ (std::uint64_t(cell) << 32 | count << 8 | std::uint32_t(what)));
    return double(h >> 11) * 0x1p-53;
}

dvec3 SyntheticTraffic::direction(std::uint64_t ray, std::uint32_t cell) const {
    const double u = draw(Draw::direction, ray, cell);
    if (settings_.directions == Directions::axial) {
        const Side side = Side(int(u * side_count));
        return {step_x(side), step_y(side), 0};
    }
    if (settings_.directions == Directions::diagonal) {
        const int which = int(u * 4);
        const double part = std::sqrt(0.5);
        return {which & 1 ? -part : part, which & 2 ? -part : part, 0};
    }
    // Draws a point of the disc by rejection: this needs only operations that are rounded the same way
    // everywhere.
    for (std::uint32_t count = 1;; count += 2) {
        const double x = 2 * draw(Draw::direction, ray, cell, count) - 1;
        const double y = 2 * draw(Draw::direction, ray, cell, count + 1) - 1;
        const double square = x * x + y * y;
        if (square > 1 || square < 1e-6) continue;
        const double length = std::sqrt(square);
        return {x / length, y / length, 0};
    }
}

Visit SyntheticTraffic::visit_cell(const CellStore& store, const Ray& ray, const Context& context) const {
    Visit visit;
    visit.crossing = next_crossing(ray, context.arithmetic);
    if (ray.fresh) return visit;
    const std::uint32_t cell = cell_index(store);
    // A ray that turns back hits nothing on its way: it retraces its parent's path.
    const bool hits = ray.leaves != no_polygon ? ray.leaves == cell
                                               : draw(Draw::hit, ray.id, cell) < settings_.hit_probability;
    visit.comparisons.runs = 1;
    if (!hits) return visit;
    visit.comparisons.tests = 1;
    visit.event = Visit::Event::hit;
    visit.hit.voxel = 0;
    visit.hit.t = draw(Draw::place, ray.id, cell) * visit.crossing.t;
    return visit;
}

HitSetup SyntheticTraffic::set_up_hit(const Context& context, const CellStore& store, const Ray& ray,
                                      const CellHit& hit, int x, int y) const {
    const std::uint32_t cell = cell_index(store);
    HitSetup setup;
    setup.local = point_at(ray, hit.t, context.arithmetic);
    setup.point.position = setup.local + dvec3(x, y, 0);
    setup.point.direction = ray.direction;
    // The surface's own intensity takes the place of the normal, so that it is recorded with the pixel's
    // first hit.
    for (int channel = 0; channel < 3; ++channel) {
        setup.point.normal[channel] = draw(Draw::intensity, ray.id, cell, std::uint32_t(channel));
    }
    setup.facing = settings_.sources == 0 ? 0 : ~std::uint64_t(0) >> (64 - settings_.sources);
    if (ray.generation < context.settings.max_depth) {
        setup.reflects = draw(Draw::reflect, ray.id, cell) < settings_.reflected;
        setup.refracts = draw(Draw::refract, ray.id, cell) < settings_.refracted;
    }
    return setup;
}

void SyntheticTraffic::start_primary(Ray& ray, const Context& context, int x, int y) const {
    const std::uint32_t cell = std::uint32_t(y) * std::uint32_t(context.scene.frame.width) + std::uint32_t(x);
    ray.position = {draw(Draw::place, ray.id, cell), draw(Draw::place_y, ray.id, cell), 0};
    set_direction(ray, direction(ray.id, cell), context.arithmetic);
}

bool SyntheticTraffic::turns_back(const Ray& child, std::uint32_t cell) const {
    return settings_.directions == Directions::back && !is_shadow(child.kind) &&
           draw(Draw::turn, child.id, cell) < settings_.turn_back;
}

void SyntheticTraffic::start_child(Ray& child, const Ray& parent, const Context& context,
                                   const CellStore& store, const HitSetup& setup) const {
    const std::uint32_t cell = cell_index(store);
    child.position = setup.local;
    if (turns_back(child, cell)) {
        set_direction(child, -parent.direction, context.arithmetic);
        child.leaves =
            std::uint32_t(parent.home_y) * std::uint32_t(context.scene.frame.width) + parent.home_x;
    } else {
        set_direction(child, direction(child.id, cell), context.arithmetic);
    }
}

dvec3 SyntheticTraffic::local_intensity(const HitSetup& setup, std::uint64_t lit) const {
    const dvec3& own = setup.point.normal;
    dvec3 intensity = own;
    for (int source = 0; source < settings_.sources; ++source) {
        if (lit >> source & 1) intensity += own / double(source + 2);
    }
    return intensity;
}

void SyntheticTraffic::furnish(CellStore& store, const Frame& frame, int x, int y) {
    Voxel surface;
    surface.polygon = std::uint32_t(y) * std::uint32_t(frame.width) + std::uint32_t(x);
    surface.far_level = frame.depth_levels;
    surface.far = frame.depth;
    store.voxels.assign(1, surface);
}

PictureSettings traffic_picture(int width, int height, int generations) {
    PictureSettings picture;
    picture.width = width;
    picture.height = height;
    picture.depth_levels = 1;
    picture.max_depth = generations;
    picture.min_weight = 0;
    picture.exterior = ExteriorMode::none;
    picture.shadows = Shadows::per_hit;
    picture.numbers.arithmetic = Numbers::exact;
    return picture;
}

CellScene traffic_scene(const PictureSettings& picture, const TrafficSettings& traffic) {
    CellScene scene;
    scene.frame = array_frame(picture);
    scene.background = {0.25, 0.5, 0.75};
    Material material;
    material.specular = traffic.reflected > 0 ? child_share : 0;
    material.transmit = traffic.refracted > 0 ? child_share : 0;
    scene.objects.push_back(material);
    scene.sources.resize(std::size_t(traffic.sources));
    return scene;
}

}  // namespace raycell
