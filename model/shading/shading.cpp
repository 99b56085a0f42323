#include "model/shading/shading.hpp"

namespace raycell {

ShadePoint shade_point(const dvec3& position, const dvec3& direction, const dvec3& raw_normal,
                       const dvec3& plane_normal, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    // In words, a normal of only a few last bits has no usable direction.
    const double step = formats.normal.step();
    const double least = arithmetic.exact() ? 1e-12 : 64 * step * step;
    const bool vanishes = !(arithmetic.dot(formats.accumulator, raw_normal, raw_normal) > least);
    const dvec3 normal = !vanishes            ? arithmetic.normalise(raw_normal)
                         : arithmetic.exact() ? plane_normal
                                              : arithmetic.normalise(plane_normal);  // not unit in words
    ShadePoint point;
    point.position = position;
    point.direction = direction;
    point.entering = arithmetic.dot(formats.accumulator, normal, direction) < 0;
    point.normal = point.entering ? normal : -normal;
    return point;
}

SourceView view_source(const ShadePoint& point, const Source& source, const Arithmetic& arithmetic) {
    const dvec3 way = arithmetic.way(point.position, source.position);
    SourceView view;
    if (way == dvec3(0)) return view;  // the source lies on the surface: it lights nothing there
    view.direction = arithmetic.normalise(way, view.distance);
    view.cosine = arithmetic.dot(arithmetic.formats().unit, point.normal, view.direction);
    return view;
}

dvec3 reflect_direction(const ShadePoint& point, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    const double along = arithmetic.dot(formats.unit, point.direction, point.normal);
    return arithmetic.normalise(arithmetic.along(formats.field, point.direction, -2 * along, point.normal));
}

bool refract_direction(const ShadePoint& point, double ior, dvec3& out, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    const double eta = arithmetic.hold(formats.normal, point.entering ? arithmetic.reciprocal(ior) : ior);
    const double cosine =
        arithmetic.hold(formats.unit, -arithmetic.dot(formats.unit, point.direction, point.normal));
    const double squared_sine = arithmetic.mac(formats.field, 1, -cosine, cosine);
    const double bent =
        arithmetic.product(formats.field, arithmetic.product(formats.field, eta, eta), squared_sine);
    const double squared = 1 - bent;
    if (squared < 0) return false;
    const double across = arithmetic.mac(formats.field, -arithmetic.square_root(squared), eta, cosine);
    // One rounding: a double does not hold the product of two long words.
    const dvec3 bent_way = arithmetic.along(formats.field, dvec3(0), eta, point.direction);
    const dvec3 way = arithmetic.along(formats.field, bent_way, across, point.normal);
    if (way == dvec3(0)) return false;  // words too short for this index of refraction: nothing is left
    out = arithmetic.normalise(way);
    return true;
}

dvec3 transmit_direction(const ShadePoint& point, double ior, const Arithmetic& arithmetic) {
    dvec3 refracted;
    return refract_direction(point, ior, refracted, arithmetic) ? refracted
                                                                : reflect_direction(point, arithmetic);
}

dvec3 local_intensity(const ShadePoint& point, const Material& material, const Source* sources,
                      std::size_t source_count, std::uint64_t lit, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    const Format& word = formats.intensity;
    const double ambient =
        arithmetic.product(formats.unit, arithmetic.hold(formats.unit, 0.1), material.diffuse);
    dvec3 sum = arithmetic.along(word, dvec3(0), ambient, material.colour);
    const dvec3 mirrored = material.specular > 0 ? reflect_direction(point, arithmetic) : dvec3(0);
    for (std::size_t s = 0; s < source_count; ++s) {
        if (!(lit >> s & 1)) continue;
        const SourceView view = view_source(point, sources[s], arithmetic);
        if (!view.faces()) continue;
        double highlight = 0;
        if (material.specular > 0) {
            const double along = arithmetic.dot(formats.unit, mirrored, view.direction);
            if (along > 0) {
                highlight =
                    arithmetic.product(word, material.specular, arithmetic.power(along, material.shine));
            }
        }
        const double diffuse = arithmetic.product(formats.unit, material.diffuse, view.cosine);
        for (int channel = 0; channel < 3; ++channel) {
            const double share = arithmetic.mac(word, highlight, diffuse, material.colour[channel]);
            sum[channel] = arithmetic.mac(word, sum[channel], sources[s].intensity[channel], share);
        }
    }
    return sum;
}

dvec3 combine_intensity(const dvec3& local, const Material& material, const dvec3& reflected,
                        const dvec3& refracted, const Arithmetic& arithmetic) {
    const double mirror = mirror_share(material);
    const double transmit = transmit_share(material);
    dvec3 sum;
    for (int channel = 0; channel < 3; ++channel) {
        sum[channel] = arithmetic.mac(arithmetic.formats().intensity, local[channel], mirror,
                                      reflected[channel], transmit, refracted[channel]);
    }
    return sum;
}

}  // namespace raycell
