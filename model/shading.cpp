#include "model/shading.hpp"

#include "model/arithmetic.hpp"

namespace raycell {

ShadePoint shade_point(const dvec3& position, const dvec3& direction, const dvec3& raw_normal,
                       const dvec3& plane_normal) {
    const bool vanishes = !(arith::dot(raw_normal, raw_normal) > 1e-12);
    const dvec3 normal = vanishes ? plane_normal : arith::normalise(raw_normal);
    ShadePoint point;
    point.position = position;
    point.direction = direction;
    point.entering = arith::dot(normal, direction) < 0;
    point.normal = point.entering ? normal : -normal;
    return point;
}

SourceView view_source(const ShadePoint& point, const Source& source) {
    const dvec3 way = source.position - point.position;
    const double squared = arith::dot(way, way);
    SourceView view;
    if (!(squared > 0)) return view;  // the source lies on the surface: it lights nothing there
    view.distance = arith::square_root(squared);
    view.direction = way * arith::reciprocal(view.distance);
    view.cosine = arith::dot(point.normal, view.direction);
    return view;
}

dvec3 reflect_direction(const ShadePoint& point) {
    const double along = arith::dot(point.direction, point.normal);
    return arith::normalise(point.direction - 2 * along * point.normal);
}

bool refract_direction(const ShadePoint& point, double ior, dvec3& out) {
    const double eta = point.entering ? arith::reciprocal(ior) : ior;
    const double cosine = -arith::dot(point.direction, point.normal);
    const double squared = 1 - eta * eta * (1 - cosine * cosine);
    if (squared < 0) return false;
    out =
        arith::normalise(eta * point.direction + (eta * cosine - arith::square_root(squared)) * point.normal);
    return true;
}

dvec3 local_intensity(const ShadePoint& point, const Material& material, const Source* sources,
                      std::size_t source_count, std::uint64_t lit) {
    dvec3 sum = 0.1 * material.diffuse * material.colour;
    const dvec3 mirrored = material.specular > 0 ? reflect_direction(point) : dvec3(0);
    for (std::size_t s = 0; s < source_count; ++s) {
        if (!(lit >> s & 1)) continue;
        const SourceView view = view_source(point, sources[s]);
        if (!view.faces()) continue;
        dvec3 share = material.diffuse * view.cosine * material.colour;
        if (material.specular > 0) {
            const double along = arith::dot(mirrored, view.direction);
            if (along > 0) share += material.specular * arith::power(along, material.shine);
        }
        sum += sources[s].intensity * share;
    }
    return sum;
}

dvec3 combine_intensity(const dvec3& local, const Material& material, const dvec3& reflected,
                        const dvec3& refracted) {
    return local + mirror_share(material) * reflected + transmit_share(material) * refracted;
}

}  // namespace raycell
