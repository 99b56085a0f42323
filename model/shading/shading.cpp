#include "model/shading/shading.hpp"

#include <limits>

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

namespace {

/// Of a spot: the power of the cosine to its axis, 0 from the edge of its cone on.
double spot_emission(const dvec3& direction, const Source& source, const Arithmetic& arithmetic) {
    const double along = arithmetic.dot(arithmetic.formats().unit, source.axis, direction);
    return along > source.cut_off ? arithmetic.power(along, source.falloff) : 0;
}

}  // namespace

SourceView view_source(const ShadePoint& point, const Source& source, const Arithmetic& arithmetic) {
    SourceView view;
    if (source.kind == SourceKind::directional) {
        view.direction = source.axis;
        view.distance = std::numeric_limits<double>::infinity();
    } else {
        const dvec3 way = arithmetic.way(point.position, source.position);
        if (way == dvec3(0)) return view;  // the source lies on the surface: it lights nothing there
        view.direction = arithmetic.normalise(way, view.distance);
    }
    view.cosine = arithmetic.dot(arithmetic.formats().unit, point.normal, view.direction);
    if (source.kind == SourceKind::spot) view.emission = spot_emission(view.direction, source, arithmetic);
    if (source.kind == SourceKind::rectangle || source.kind == SourceKind::triangle)
        view.emission = arithmetic.dot(arithmetic.formats().unit, source.axis, view.direction);
    return view;
}

SourceView view_light(const ShadePoint& point, const Lights& lights, std::size_t light,
                      const Arithmetic& arithmetic) {
    const Light& ray = lights.rays[light];
    const Source& source = lights.sources[ray.source];
    if (!is_area(source.kind)) return view_source(point, source, arithmetic);
    return view_source(point, sample_of(source, ray.place + point.shift, point.position, arithmetic),
                       arithmetic);
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

namespace {

/// Of a source's intensity, what a point receives: N·L and (R·L)^Shine, both times the emission.
struct Received {
    double diffuse = 0;
    double highlight = 0;
};

Received received(const SourceView& view, SourceKind kind, const Material& material, const dvec3& mirrored,
                  const Arithmetic& arithmetic) {
    const Format& unit = arithmetic.formats().unit;
    Received light;
    light.diffuse = view.cosine;
    if (material.specular > 0) {
        const double along = arithmetic.dot(unit, mirrored, view.direction);
        if (along > 0) light.highlight = arithmetic.power(along, material.shine);
    }
    if (kind != SourceKind::point && kind != SourceKind::directional && kind != SourceKind::sphere) {
        light.diffuse = arithmetic.product(unit, light.diffuse, view.emission);
        light.highlight = arithmetic.product(unit, light.highlight, view.emission);
    }
    return light;
}

/// The ambient part, to which lights are added.
class LocalSum {
  public:
    LocalSum(const ShadePoint& point, const Material& material, const Arithmetic& arithmetic)
        : material_(material), arithmetic_(arithmetic) {
        const Formats& formats = arithmetic.formats();
        const double ambient =
            arithmetic.product(formats.unit, arithmetic.hold(formats.unit, 0.1), material.diffuse);
        sum_ = arithmetic.along(formats.intensity, dvec3(0), ambient, material.colour);
        if (material.specular > 0) mirrored_ = reflect_direction(point, arithmetic);
    }

    void add(const SourceView& view, const Source& source) {
        if (view.faces()) add(received(view, source.kind, material_, mirrored_, arithmetic_), source);
    }

    /// A source of several samples. The sums of words are exact: an accumulator holds them.
    template <typename ViewOf>
    void add_samples(std::uint64_t lit, double share, const Source& source, const ViewOf& view_of) {
        Received sum;
        for (; lit != 0; lit &= lit - 1) {
            const SourceView view = view_of(std::size_t(__builtin_ctzll(lit)));
            if (!view.faces()) continue;
            const Received one = received(view, source.kind, material_, mirrored_, arithmetic_);
            sum.diffuse += one.diffuse;
            sum.highlight += one.highlight;
        }
        const Format& unit = arithmetic_.formats().unit;
        if (sum.diffuse == 0 && sum.highlight == 0) return;
        add({arithmetic_.long_mac(unit, 0, sum.diffuse, share),
             arithmetic_.long_mac(unit, 0, sum.highlight, share)},
            source);
    }

    const dvec3& sum() const { return sum_; }

  private:
    void add(const Received& light, const Source& source) {
        const Format& word = arithmetic_.formats().intensity;
        const Format& unit = arithmetic_.formats().unit;
        const double highlight = arithmetic_.product(word, material_.specular, light.highlight);
        const double diffuse = arithmetic_.product(unit, material_.diffuse, light.diffuse);
        for (int channel = 0; channel < 3; ++channel) {
            const double share = arithmetic_.mac(word, highlight, diffuse, material_.colour[channel]);
            sum_[channel] = arithmetic_.mac(word, sum_[channel], source.intensity[channel], share);
        }
    }

    const Material& material_;
    const Arithmetic& arithmetic_;
    dvec3 sum_{0, 0, 0};
    dvec3 mirrored_{0, 0, 0};
};

}  // namespace

dvec3 local_intensity(const ShadePoint& point, const Material& material, const Lights& lights,
                      std::uint64_t lit, const Arithmetic& arithmetic) {
    LocalSum local(point, material, arithmetic);
    for (std::size_t light = 0; light < lights.rays.size();) {
        const Source& source = lights.sources[lights.rays[light].source];
        if (is_area(source.kind)) {
            local.add_samples(lit & lights.bits(light), lights.share, source, [&](std::size_t sample) {
                return view_light(point, lights, sample, arithmetic);
            });
            light += std::size_t(lights.samples);
            continue;
        }
        if (lit >> light & 1) local.add(view_source(point, source, arithmetic), source);
        ++light;
    }
    return local.sum();
}

dvec3 local_intensity(const ShadePoint& point, const Material& material, const Source* sources,
                      std::size_t source_count, std::uint64_t lit, const Arithmetic& arithmetic) {
    LocalSum local(point, material, arithmetic);
    for (std::size_t s = 0; s < source_count; ++s) {
        if (lit >> s & 1) local.add(view_source(point, sources[s], arithmetic), sources[s]);
    }
    return local.sum();
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
