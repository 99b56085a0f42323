#include "model/tracing/tracing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/geometry/sampling.hpp"
#include "model/tracing/pixel_sum.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 32-bit finaliser of MurmurHash3. Ids depend on the tree alone, not on when a ray was sent.
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

/// Starts a ray at a small offset along the polygon's normal, to the side that the ray goes to. In words the
/// normal is not unit but 1 along the polygon's dominant axis, so the distance is up to 1.7 times the offset.
void leave_surface(Ray& ray, const Context& context, const dvec3& local, const Voxel& voxel) {
    const Arithmetic& arithmetic = context.arithmetic;
    const Formats& formats = arithmetic.formats();
    const dvec3& n = voxel.plane.n;
    const double along = arithmetic.dot(formats.accumulator, n, ray.direction);
    const double offset = along < 0 ? -context.normal_offset : context.normal_offset;
    ray.position = {arithmetic.mac(formats.unit, local.x, offset, n.x),
                    arithmetic.mac(formats.unit, local.y, offset, n.y),
                    arithmetic.mac(formats.depth, local.z, offset, n.z)};
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
    ray.weight = context.arithmetic.product(context.arithmetic.formats().unit, parent.weight, share);
    if (context.traffic) {
        context.traffic->start_child(ray, parent, context, store, setup);
        return ray;
    }
    set_direction(ray, direction, context.arithmetic);
    leave_surface(ray, context, setup.local, store.voxels[hit.voxel]);
    return ray;
}

}  // namespace

Material hold(const Material& material, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return material;
    const Formats& f = arithmetic.formats();
    const auto unsigned_word = [](const Format& format, double x) { return std::max(format.hold(x), 0.0); };
    Material held = material;
    for (int channel = 0; channel < 3; ++channel) {
        held.colour[channel] = unsigned_word(f.feature, material.colour[channel]);
    }
    held.diffuse = unsigned_word(f.feature, material.diffuse);
    held.specular = unsigned_word(f.feature, material.specular);
    held.transmit = unsigned_word(f.feature, material.transmit);
    held.shine = arithmetic.hold_shine(material.shine);
    held.ior = std::max(f.ior.hold(material.ior), f.ior.step());  // 0 would have no reciprocal
    return held;
}

namespace {

/// Rounds what an area's points are sums of to mantissas of one exponent.
void hold_area(Source& held, const Source& source, const Arithmetic& arithmetic) {
    const auto largest = [](const dvec3& a, const dvec3& b) { return glm::max(glm::abs(a), glm::abs(b)); };
    const dvec3& corner = source.position;
    dvec3 most = largest(largest(corner, dvec3(source.radius)), largest(source.edge_u, source.edge_v));
    for (const double side : {-1, 1}) {
        most = largest(most, corner + side * source.radius);
        most = largest(most, corner + 0.5 * (source.edge_u + source.edge_v) +
                                 side * 0.5 * (source.edge_u - source.edge_v));
    }
    most = largest(most, corner + source.edge_u + source.edge_v);
    const Format mantissa(1, arithmetic.formats().word_bits + 11);
    const int e = held.exponent = arithmetic.formats().place_exponent(most);
    const auto word = [&](double x) { return scale_by(mantissa.hold(scale_by(x, -e)), e); };
    const auto words = [&](const dvec3& v) { return dvec3(word(v.x), word(v.y), word(v.z)); };
    held.position = words(source.position);
    held.edge_u = words(source.edge_u);
    held.edge_v = words(source.edge_v);
    held.radius = word(source.radius);
}

}  // namespace

Source hold(const Source& source, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return source;
    const Formats& f = arithmetic.formats();
    Source held = source;
    held.position =
        source.kind == SourceKind::directional ? dvec3(0) : arithmetic.hold_place(source.position);
    if (is_area(source.kind)) hold_area(held, source, arithmetic);
    held.intensity = arithmetic.hold(f.intensity, source.intensity);
    held.axis = arithmetic.hold(f.unit, source.axis);
    held.cut_off = f.unit.hold(source.cut_off);
    held.falloff = arithmetic.hold_shine(source.falloff);
    return held;
}

Context::Context(const CellScene& placed, const PictureSettings& picture_settings,
                 const SyntheticTraffic* synthetic)
    : scene(placed),
      settings(picture_settings),
      arithmetic(settings.numbers, extent_of(placed.frame)),
      traffic(synthetic) {
    if (traffic && (!arithmetic.exact() || settings.exterior != ExteriorMode::none ||
                    settings.shadows != Shadows::per_hit || settings.stage != RunStage::trace)) {
        throw std::invalid_argument(
            "synthetic traffic: expected exact arithmetic, no exterior, shadows per hit, and tracing");
    }
    const Formats& f = arithmetic.formats();
    for (const Material& material : placed.objects) objects.push_back(hold(material, arithmetic));
    std::vector<Source> sources;
    for (const Source& source : placed.sources) sources.push_back(hold(source, arithmetic));
    lights = Lights(std::move(sources), settings.source_samples, arithmetic);
    background = arithmetic.hold(f.intensity, placed.background);
    eye = arithmetic.hold_place(placed.frame.eye);
    depth = arithmetic.hold(f.depth, placed.frame.depth);
    // Exact arithmetic with polygon edges needs no offset; runs and masks do.
    const bool none = arithmetic.exact() && settings.hit == HitTest::edge;
    const double suitable = none ? 0 : arithmetic.default_normal_offset();
    normal_offset = arithmetic.hold(f.unit, settings.normal_offset < 0 ? suitable : settings.normal_offset);
}

Visit visit_cell(const CellStore& store, const Ray& ray, const Context& context, const IndexTable& index) {
    if (context.traffic) return context.traffic->visit_cell(store, ray, context);
    const Arithmetic& arithmetic = context.arithmetic;
    Visit visit;
    if (ray.outside) {
        visit.crossing = border_crossing(ray, arithmetic);
        return visit;
    }
    visit.crossing = next_crossing(ray, arithmetic);
    const double dz = ray.direction.z;
    double t_end = visit.crossing.t;
    // Only a ray that leaves the cube needs the division.
    const double z_end = dz == 0 ? ray.position.z : depth_at(ray, t_end, arithmetic);
    const double bound = dz > 0 ? context.depth : 0;
    if (dz > 0 ? z_end > bound : z_end < bound) {
        t_end = std::min(way_out(ray, bound, arithmetic), t_end);
        visit.leaves = true;
        visit.event = Visit::Event::leaves_cube;
        visit.hit.t = t_end;
    }
    if (ray.reach <= t_end) {
        t_end = ray.reach;
        visit.event = Visit::Event::reaches_source;
    }
    const auto hit =
        nearest_in_cell(store, ray, t_end, context.settings.hit, arithmetic, &visit.comparisons, index);
    // A surface at the source itself does not hide it.
    if (hit && !(is_shadow(ray.kind) && hit->t >= ray.reach - arithmetic.hair())) {
        visit.event = Visit::Event::hit;
        visit.hit = *hit;
    }
    return visit;
}

Beyond beyond_face(const Context& context, Face face) {
    const bool work = context.settings.exterior == ExteriorMode::host && context.scene.beyond[face];
    return work ? Beyond::exterior : Beyond::nothing;
}

void start_outside(Ray& ray, double t_leave, const Arithmetic& arithmetic) {
    move_along(ray, t_leave, arithmetic);
    ray.outside = true;
}

namespace {

ExteriorRequest request_at_border(const Context& context, const Ray& ray, const Crossing& crossing, int x,
                                  int y) {
    ExteriorRequest request;
    request.direction = context.arithmetic.exact() ? ray.direction : glm::normalize(ray.direction);
    const bool axial = ray.inverse_x == 0 && ray.inverse_y == 0;
    if (axial && ray.outside) {
        // It was only passed on to the border: its place is still relative to the cell that sent it.
        request.origin = {ray.home_x + ray.position.x, ray.home_y + ray.position.y, ray.position.z};
        request.reach = ray.reach;
        return request;
    }
    double t = crossing.t;
    if (ray.outside) {  // back to where it left the cube: it came from there untested
        const double face = ray.direction.z > 0 ? context.depth : 0;
        t = (face - ray.position.z) * (1 / ray.direction.z);
    }
    const dvec3 corner{double(x), double(y), 0};
    request.origin = corner + ray.position + t * ray.direction;
    request.reach = ray.reach - t;
    return request;
}

}  // namespace

double started_at(const CellScene& scene, const ExteriorRequest& request, const Ray& ray) {
    if (ray.leaves >= scene.polygons.size()) return 0;
    const Plane& plane = scene.polygons[ray.leaves].plane;
    const double slope = glm::dot(plane.n, request.direction);
    if (slope == 0) return 0;
    return std::min((plane.c - glm::dot(plane.n, request.origin)) / slope, 0.0);
}

namespace {

/// The way to a source along a ray that goes there and left its polygon a `since` ago.
double distance_to(const Source& source, const dvec3& origin, const dvec3& direction, double since) {
    const dvec3 way = source.position - origin;
    switch (source.kind) {
        case SourceKind::directional:
            return infinity;
        case SourceKind::rectangle:
        case SourceKind::triangle:  // where it meets the plane
            return glm::dot(way, source.axis) / glm::dot(direction, source.axis);
        case SourceKind::sphere: {  // its disc lies across the way from the hit to the middle
            const double along = glm::dot(way, direction);
            return (glm::dot(way, way) + since * along) / (along + since);
        }
        case SourceKind::point:
        case SourceKind::spot:
            break;
    }
    return glm::length(way);
}

}  // namespace

ExteriorRequest exterior_request(const Context& context, const Ray& ray, const Crossing& crossing, int x,
                                 int y) {
    ExteriorRequest request = request_at_border(context, ray, crossing, x, y);
    if (is_shadow(ray.kind) && !context.arithmetic.exact()) {
        const Source& source = context.scene.sources[context.lights.rays[ray.child].source];
        request.reach =
            distance_to(source, request.origin, request.direction, -started_at(context.scene, request, ray));
    }
    return request;
}

dvec3 exterior_answer(const Context& context, const dvec3& intensity) {
    return context.arithmetic.hold(context.arithmetic.formats().intensity, intensity);
}

namespace {

/// The field of normals at a point of the cell, not normalised.
dvec3 normal_at(const Voxel& voxel, const dvec3& local, const Arithmetic& arithmetic) {
    const NormalField& field = voxel.normal;
    const dvec2 uv = project({local.x, local.y, local.z - voxel.base}, voxel.drop);
    if (arithmetic.exact()) return field.at(uv);
    const Format& word = arithmetic.formats().field;
    dvec3 normal;
    for (int i = 0; i < 3; ++i) {
        normal[i] = arithmetic.mac(word, field.base[i], uv.x, field.du[i], uv.y, field.dv[i]);
    }
    return normal;
}

}  // namespace

HitSetup set_up_hit(const Context& context, const CellStore& store, const Ray& ray, const CellHit& hit, int x,
                    int y) {
    if (context.traffic) return context.traffic->set_up_hit(context, store, ray, hit, x, y);
    const Voxel& voxel = store.voxels[hit.voxel];
    const Material& material = context.objects[voxel.object];
    const Arithmetic& arithmetic = context.arithmetic;
    HitSetup setup;
    setup.local = point_at(ray, hit.t, arithmetic);
    setup.point = shade_point(setup.local + dvec3(x, y, 0), ray.direction,
                              normal_at(voxel, setup.local, arithmetic), voxel.plane.n, arithmetic);
    setup.point.shift = shift_of(voxel.polygon, x, y);
    for (std::size_t light = 0; light < context.lights.rays.size(); ++light) {
        if (view_light(setup.point, context.lights, light, arithmetic).faces()) {
            setup.facing |= std::uint64_t(1) << light;
        }
    }
    const auto worth = [&](double share) {
        return share > 0 && ray.generation < context.settings.max_depth &&
               ray.weight * share >= context.settings.min_weight;
    };
    if (worth(mirror_share(material))) {
        setup.reflects = true;
        setup.reflected = reflect_direction(setup.point, arithmetic);
    }
    if (worth(transmit_share(material))) {
        setup.refracts = true;
        setup.refracted = transmit_direction(setup.point, material.ior, arithmetic);
    }
    return setup;
}

bool may_wait(const Context& context, const Ray& ray, std::uint32_t object) {
    if (context.settings.shadows != Shadows::precast && !context.lights.sources.empty()) return true;
    const Material& material = context.objects[object];
    return ray.generation < context.settings.max_depth &&
           (mirror_share(material) > 0 || transmit_share(material) > 0);
}

int waiting_generations(const Context& context) {
    const bool shadows = context.settings.shadows != Shadows::precast && !context.lights.sources.empty();
    return context.settings.max_depth + (shadows ? 1 : 0);
}

namespace {

/// Place of a sample of a pixel of a block on the screen, cell widths from the cell's corner.
dvec3 place_on_screen(const Context& context, int pixel, int sample) {
    const dvec2 in_pixel = sample_place(sample, context.settings.samples, context.settings.filter);
    const Format& unit = context.arithmetic.formats().unit;
    return context.arithmetic.hold(unit, dvec3(context.scene.frame.place_in_block(pixel, in_pixel), 0));
}

}  // namespace

Ray primary_ray(const Context& context, int x, int y, int number) {
    const Frame& frame = context.scene.frame;
    const int pixel = number / context.settings.samples;
    const int sample = number % context.settings.samples;
    Ray ray;
    ray.id = ray_id(frame.pixel_index(x, y, pixel), 0, unsigned(sample));
    ray.home_x = std::uint16_t(x);
    ray.home_y = std::uint16_t(y);
    if (context.traffic) {
        context.traffic->start_primary(ray, context, x, y);
        return ray;
    }
    ray.position = place_on_screen(context, pixel, sample);
    const Arithmetic& arithmetic = context.arithmetic;
    const dvec3 at = ray.position + dvec3(x, y, 0);
    const dvec3 direction = arithmetic.exact() || frame.viewer_at_infinity
                                ? frame.primary_ray(at.x, at.y).direction
                                : arithmetic.normalise(-arithmetic.way(at, context.eye));
    set_direction(ray, direction, arithmetic);
    return ray;
}

Ray reflected_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y) {
    const Material& material = context.objects[store.voxels[hit.voxel].object];
    return secondary_ray(context, store, parent, hit, setup, RayKind::reflected, setup.reflected,
                         mirror_share(material), x, y);
}

Ray refracted_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
                  const HitSetup& setup, int x, int y) {
    const Material& material = context.objects[store.voxels[hit.voxel].object];
    return secondary_ray(context, store, parent, hit, setup, RayKind::refracted, setup.refracted,
                         transmit_share(material), x, y);
}

Ray shadow_ray(const Context& context, const CellStore& store, const Ray& parent, const CellHit& hit,
               const HitSetup& setup, std::size_t light, int x, int y) {
    Ray ray = child_of(parent, RayKind::shadow, unsigned(light), x, y);
    if (context.traffic) {
        context.traffic->start_child(ray, parent, context, store, setup);
        return ray;
    }
    const SourceView view = view_light(setup.point, context.lights, light, context.arithmetic);
    set_direction(ray, view.direction, context.arithmetic);
    ray.reach = context.arithmetic.hold_reach(view.distance);
    leave_surface(ray, context, setup.local, store.voxels[hit.voxel]);
    return ray;
}

Ray voxel_shadow_ray(const Context& context, const CellStore& store, std::uint32_t voxel, std::size_t light,
                     RayKind kind, int x, int y) {
    Ray parent;
    parent.id = ray_id(std::uint64_t(y) * std::uint64_t(context.scene.frame.width) + std::uint64_t(x), voxel);
    Ray ray = child_of(parent, kind, unsigned(light), x, y);
    ray.slot = voxel;
    const Arithmetic& arithmetic = context.arithmetic;
    ShadePoint point;
    const dvec3 local = store.voxels[voxel].point;
    point.position = local + dvec3(x, y, 0);
    point.shift = shift_of(store.voxels[voxel].polygon, x, y);
    const SourceView view = view_light(point, context.lights, light, arithmetic);
    ray.reach = arithmetic.hold_reach(view.distance);
    set_direction(ray, view.direction, arithmetic);
    leave_surface(ray, context, local, store.voxels[voxel]);
    return ray;
}

dvec3 shade_hit(const Context& context, const HitSetup& setup, std::uint32_t object, std::uint64_t lit,
                const dvec3& reflected, const dvec3& refracted) {
    const Material& material = context.objects[object];
    const dvec3 local = context.traffic ? context.traffic->local_intensity(setup, lit & setup.facing)
                                        : local_intensity(setup.point, material, context.lights,
                                                          lit & setup.facing, context.arithmetic);
    return combine_intensity(local, material, reflected, refracted, context.arithmetic);
}

namespace {

/// What a sample of a pixel shows of the loaded scene.
Pixel display_sample(const Context& context, const CellStore& store, int x, int y, int pixel_of_block,
                     int sample) {
    Pixel pixel;
    Ray ray;
    ray.position = place_on_screen(context, pixel_of_block, sample);
    ray.fresh = false;
    set_direction(ray, {0, 0, 1}, context.arithmetic);
    const auto hit = nearest_in_cell(store, ray, context.depth, context.settings.hit, context.arithmetic);
    if (!hit) {
        record_background(pixel);
        pixel.colour = context.background;
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

}  // namespace

Pixel display_cell(const Context& context, const CellStore& store, int x, int y, int pixel_of_block) {
    const PictureSettings& settings = context.settings;
    Pixel pixel = display_sample(context, store, x, y, pixel_of_block, 0);
    if (settings.samples == 1) return pixel;
    PixelSum sum;
    sum.add(pixel.colour, context.arithmetic);
    while (!is_complete(sum, settings, context.arithmetic))
        sum.add(display_sample(context, store, x, y, pixel_of_block, sum.count()).colour, context.arithmetic);
    pixel.colour = sum.mean(context.arithmetic);
    pixel.samples = std::uint32_t(sum.count());
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
