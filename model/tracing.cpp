#include "model/tracing.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "model/arithmetic.hpp"

namespace raycell {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 32-bit finaliser of MurmurHash3: ids that depend on the tree alone, not on when a ray was sent.
std::uint32_t mix(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x85ebca6bU;
    h ^= h >> 13;
    h *= 0xc2b2ae35U;
    return h ^ h >> 16;
}

std::uint64_t child_id(std::uint64_t parent, unsigned child) {
    return (parent & ~std::uint64_t(0xffffffffU)) | mix(std::uint32_t(parent) * 31 + child + 1);
}

/// Starts a ray off a polygon: a small way along its normal, to the side that the ray goes to.
void leave_surface(Ray& ray, const Context& context, const dvec3& local, const Voxel& voxel) {
    const double along = arith::dot(voxel.plane.n, ray.direction);
    const double offset = along < 0 ? -context.settings.normal_offset : context.settings.normal_offset;
    ray.position = local + offset * voxel.plane.n;
    ray.position.x = std::clamp(ray.position.x, 0.0, 1.0);
    ray.position.y = std::clamp(ray.position.y, 0.0, 1.0);
    ray.leaves = voxel.polygon;
    ray.leaves_front = along >= 0;
}

Ray child_of(const Ray& parent, RayKind kind, unsigned child, int x, int y) {
    Ray ray;
    ray.kind = kind;
    ray.child = std::uint8_t(child);
    ray.id = child_id(parent.id, (unsigned(kind) << 8) + child);
    ray.home_x = std::uint16_t(x);
    ray.home_y = std::uint16_t(y);
    ray.generation = std::uint8_t(parent.generation + 1);
    return ray;
}

Ray secondary_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, RayKind kind, const dvec3& direction, double share, int x, int y) {
    Ray ray = child_of(parent, kind, kind == RayKind::reflected ? 0 : 1, x, y);
    ray.weight = parent.weight * share;
    set_direction(ray, direction);
    leave_surface(ray, context, setup.local, store.voxels[hit.voxel]);
    return ray;
}

}  // namespace

Visit visit_cell(const CellStore& store, const Ray& ray, const Context& context) {
    Visit visit;
    if (ray.outside) {
        visit.crossing = border_crossing(ray);
        return visit;
    }
    visit.crossing = next_crossing(ray);
    const double dz = ray.direction.z;
    const double depth = context.scene.frame.depth;
    double t_end = visit.crossing.t;
    // A ray may start a hair outside, from a polygon on the cube's face: it leaves at once, not in the past.
    const double t_leave = dz > 0   ? std::max((depth - ray.position.z) * arith::reciprocal(dz), 0.0)
                           : dz < 0 ? std::max(-ray.position.z * arith::reciprocal(dz), 0.0)
                                    : infinity;
    if (t_leave < t_end) {
        t_end = t_leave;
        visit.event = Visit::Event::leaves_cube;
        visit.t_leave = t_leave;
    }
    if (ray.reach <= t_end) {
        t_end = ray.reach;
        visit.event = Visit::Event::reaches_source;
    }
    const auto hit = nearest_in_cell(store, ray, t_end, context.settings.hit, context.scene.frame.level(),
                                     &visit.comparisons);
    // What lies on the source itself does not hide it.
    if (hit && !(is_shadow(ray.kind) && hit->t >= ray.reach - hair)) {
        visit.event = Visit::Event::hit;
        visit.hit = *hit;
    }
    return visit;
}

std::uint32_t visit_cycles(const Visit& visit, HitTest test, const CostTable& costs) {
    const Comparisons& made = visit.comparisons;
    if (test == HitTest::depth) return costs.walk_step + made.runs * costs.compare_depth;
    const std::uint32_t each = test == HitTest::interval ? 0
                               : test == HitTest::plane  ? costs.compare_plane
                               : test == HitTest::mask   ? costs.compare_mask
                                                         : costs.compare_edge;
    return costs.walk_step + made.runs * costs.compare_interval + made.tests * each +
           made.edges * costs.per_edge;
}

Beyond beyond_face(const Context& context, Face face) {
    const bool work = context.settings.exterior == ExteriorMode::host && context.scene.beyond[face];
    return work ? Beyond::exterior : Beyond::nothing;
}

void start_outside(Ray& ray, double t_leave) {
    ray.position += t_leave * ray.direction;
    ray.position.x = std::clamp(ray.position.x, 0.0, 1.0);
    ray.position.y = std::clamp(ray.position.y, 0.0, 1.0);
    ray.reach -= t_leave;
    ray.outside = true;
    ray.fresh = false;
}

ExteriorRequest exterior_request(const Ray& ray, const Crossing& crossing, int x, int y, double depth) {
    ExteriorRequest request;
    request.direction = ray.direction;
    const bool axial = ray.inverse_x == 0 && ray.inverse_y == 0;
    if (axial && ray.outside) {
        // It was only carried to the border: its place is still that of the cell that sent it.
        request.origin = {ray.home_x + ray.position.x, ray.home_y + ray.position.y, ray.position.z};
        request.reach = ray.reach;
        return request;
    }
    double t = crossing.t;
    if (ray.outside) {  // back along the way that it came untested
        const double face = ray.direction.z > 0 ? depth : 0;
        t = (face - ray.position.z) * arith::reciprocal(ray.direction.z);
    }
    const dvec3 corner{double(x), double(y), 0};
    request.origin = corner + ray.position + t * ray.direction;
    request.reach = ray.reach - t;
    return request;
}

HitSetup set_up_hit(const Context& context, const CellStore& store, const Ray& ray, const CellHit& hit, int x,
                    int y) {
    const Voxel& voxel = store.voxels[hit.voxel];
    const Material& material = context.scene.objects[voxel.object];
    HitSetup setup;
    setup.local = ray.position + hit.t * ray.direction;
    const dvec3 normal = voxel.normal.at(project(setup.local, voxel.drop));
    setup.point = shade_point(setup.local + dvec3(x, y, 0), ray.direction, normal, voxel.plane.n);
    for (std::size_t s = 0; s < context.scene.sources.size(); ++s) {
        if (view_source(setup.point, context.scene.sources[s]).faces()) setup.facing |= std::uint64_t(1) << s;
    }
    const auto worth = [&](double share) {
        return share > 0 && ray.generation < context.settings.max_depth &&
               ray.weight * share >= context.settings.min_weight;
    };
    if (worth(mirror_share(material))) {
        setup.reflects = true;
        setup.reflected = reflect_direction(setup.point);
    }
    if (worth(transmit_share(material))) {
        setup.refracts = refract_direction(setup.point, material.ior, setup.refracted);
    }
    return setup;
}

bool may_wait(const Context& context, const Ray& ray, std::uint32_t object) {
    if (context.settings.shadows != Shadows::precast && !context.scene.sources.empty()) return true;
    const Material& material = context.scene.objects[object];
    return ray.generation < context.settings.max_depth &&
           (mirror_share(material) > 0 || transmit_share(material) > 0);
}

int waiting_generations(const Context& context) {
    const bool shadows = context.settings.shadows != Shadows::precast && !context.scene.sources.empty();
    return context.settings.max_depth + (shadows ? 1 : 0);
}

Ray primary_ray(const Context& context, int x, int y) {
    const Frame& frame = context.scene.frame;
    Ray ray;
    ray.id = (std::uint64_t(y) * std::uint64_t(frame.width) + std::uint64_t(x)) << 32;
    ray.home_x = std::uint16_t(x);
    ray.home_y = std::uint16_t(y);
    ray.position = {0.5, 0.5, 0};
    set_direction(ray, frame.primary_ray(x + 0.5, y + 0.5).direction);
    return ray;
}

Ray reflected_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y) {
    const Material& material = context.scene.objects[store.voxels[hit.voxel].object];
    return secondary_ray(context, store, parent, hit, setup, RayKind::reflected, setup.reflected,
                         mirror_share(material), x, y);
}

Ray refracted_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y) {
    const Material& material = context.scene.objects[store.voxels[hit.voxel].object];
    return secondary_ray(context, store, parent, hit, setup, RayKind::refracted, setup.refracted,
                         transmit_share(material), x, y);
}

Ray shadow_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
               const HitSetup& setup, std::size_t source, int x, int y) {
    Ray ray = child_of(parent, RayKind::shadow, unsigned(source), x, y);
    const SourceView view = view_source(setup.point, context.scene.sources[source]);
    set_direction(ray, view.direction);
    ray.reach = view.distance;
    leave_surface(ray, context, setup.local, store.voxels[hit.voxel]);
    return ray;
}

Ray voxel_shadow_ray(const Context& context, const CellStore& store, std::uint32_t voxel, std::size_t source,
                     RayKind kind, int x, int y) {
    Ray parent;
    parent.id =
        (std::uint64_t(y) * std::uint64_t(context.scene.frame.width) + std::uint64_t(x)) << 32 | voxel;
    Ray ray = child_of(parent, kind, unsigned(source), x, y);
    ray.slot = voxel;
    const dvec3 local = store.voxels[voxel].point;
    const dvec3 way = context.scene.sources[source].position - (local + dvec3(x, y, 0));
    ray.reach = arith::square_root(arith::dot(way, way));
    set_direction(ray, ray.reach > 0 ? way * arith::reciprocal(ray.reach) : dvec3(0, 0, 1));
    leave_surface(ray, context, local, store.voxels[voxel]);
    return ray;
}

dvec3 shade_hit(const Context& context, const HitSetup& setup, std::uint32_t object, std::uint64_t lit,
                const dvec3& reflected, const dvec3& refracted) {
    const Material& material = context.scene.objects[object];
    const auto& sources = context.scene.sources;
    const dvec3 local =
        local_intensity(setup.point, material, sources.data(), sources.size(), lit & setup.facing);
    return combine_intensity(local, material, reflected, refracted);
}

std::uint32_t setup_cycles(const Context& context, const HitSetup& setup, const CostTable& costs) {
    std::uint32_t cycles = costs.shade_setup;
    if (context.settings.normals == Normals::linear) cycles += costs.normal_linear;
    cycles += std::uint32_t(context.scene.sources.size()) * costs.source_view;
    if (setup.reflects) cycles += costs.reflect;
    if (setup.refracts) cycles += costs.refract;
    return cycles;
}

std::uint32_t shade_cycles(std::uint64_t lit, const CostTable& costs) {
    return costs.local_intensity + std::uint32_t(std::bitset<64>(lit).count()) * costs.per_lit_source;
}

Pixel display_cell(const Context& context, const CellStore& store, int x, int y) {
    Pixel pixel;
    Ray ray;
    ray.position = {0.5, 0.5, 0};
    ray.fresh = false;
    set_direction(ray, {0, 0, 1});
    const Frame& frame = context.scene.frame;
    const auto hit = nearest_in_cell(store, ray, frame.depth, context.settings.hit, frame.level());
    if (!hit) {
        record_background(pixel);
        pixel.colour = context.scene.background;
        return pixel;
    }
    const Voxel& voxel = store.voxels[hit->voxel];
    const HitSetup setup = set_up_hit(context, store, ray, *hit, x, y);
    record_first_hit(pixel, setup, voxel.polygon);
    pixel.colour = context.settings.display == Display::gouraud
                       ? store.intensities[hit->voxel]
                       : shade_hit(context, setup, voxel.object, ~std::uint64_t(0), dvec3(0), dvec3(0));
    return pixel;
}

void record_first_hit(Pixel& pixel, const HitSetup& setup, std::uint32_t polygon) {
    pixel.depth = setup.point.position.z;
    pixel.normal = setup.point.normal;
    pixel.polygon = polygon;
}

void record_background(Pixel& pixel) {
    pixel.depth = infinity;
    pixel.normal = dvec3(0);
    pixel.polygon = no_polygon;
}

}  // namespace raycell
