#include "model/shading/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace raycell {

/// Multiples of powers of an irrational number: neighbouring voxels get shifts far apart (Roberts 2018).
SamplePlace shift_of(std::uint32_t polygon, int x, int y) {
    const auto sum = [&](unsigned a, unsigned b, unsigned c) {
        return std::uint16_t(unsigned(x) * a + unsigned(y) * b + polygon * c);
    };
    return {sum(56143, 48097, 40503), sum(41203, 35297, 49471)};
}

SamplePlace step_of(int samples) {
    int best = 0;
    int farthest = -1;
    for (int g = 1; g <= samples; ++g) {
        if (std::gcd(g, samples) != 1) continue;
        int nearest = 2 * samples * samples;
        for (int k = 1; k < samples; ++k) {
            const int u = std::min(k, samples - k);
            const int v = std::min(g * k % samples, samples - g * k % samples);
            nearest = std::min(nearest, u * u + v * v);
        }
        if (nearest > farthest) best = g, farthest = nearest;
    }
    const auto fraction = [&](int n) { return std::uint16_t((n * 65536 + samples / 2) / samples); };
    return {fraction(1), fraction(best % std::max(samples, 1))};
}

Lights::Lights(std::vector<Source> held, int samples_of_each, const Arithmetic& arithmetic)
    : sources(std::move(held)), samples(areas() ? samples_of_each : 1) {
    if (const std::size_t count = SourceCounts(sources, samples).lights; count > max_sources) {
        const auto areas = std::size_t(
            std::count_if(sources.begin(), sources.end(), [](const Source& s) { return is_area(s.kind); }));
        const std::size_t room = max_sources - std::min(max_sources, sources.size() - areas);
        const std::string fewer = areas > 0 && room >= areas
                                      ? "--source-samples " + std::to_string(room / areas) + " or less"
                                      : "fewer sources";
        throw std::invalid_argument(std::to_string(sources.size()) + " light sources with --source-samples " +
                                    std::to_string(samples) + " take " + std::to_string(count) +
                                    " shadow rays a hit, for whose verdicts there are " +
                                    std::to_string(max_sources) + " bits; expected " + fewer);
    }
    const SamplePlace step = step_of(samples);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        SamplePlace place;
        for (int k = is_area(sources[s].kind) ? samples : 1; k > 0; --k) {
            rays.push_back({std::uint16_t(s), place});
            place = place + step;
        }
    }
    // A mantissa, so that it is as exact for many samples as for few.
    const int exponent = exponent_of(1.0 / samples) + 1;
    const Format mantissa(1, arithmetic.formats().word_bits - 1);
    share = arithmetic.exact() ? 1.0 / samples
            : samples == 1     ? 1.0
                               : scale_by(mantissa.hold(scale_by(1.0 / samples, -exponent)), exponent);
}

namespace {

double fraction_of(std::uint16_t word) { return scale_by(word, -16); }

/// c + s·a + t·b, rounded to the last bit of the source's mantissas.
dvec3 on_grid(const Source& source, const dvec3& c, double s, const dvec3& a, double t, const dvec3& b,
              const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return c + s * a + t * b;
    const Format mantissa(1, arithmetic.formats().word_bits + 11);
    const int e = source.exponent;
    dvec3 place;
    for (int i = 0; i < 3; ++i) {
        const double m =
            arithmetic.long_mac(mantissa, scale_by(c[i], -e), s, scale_by(a[i], -e), t, scale_by(b[i], -e));
        place[i] = scale_by(m, e);
    }
    return place;
}

/// sin(t · 90 degrees), 0 <= t <= 1, by an odd polynomial, 1.1e-4 off at most (Hastings 1955).
double quarter_sine(double t, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return std::sin(t * 1.57079632679489662);
    const Format& unit = arithmetic.formats().unit;
    const auto word = [&](double x) { return arithmetic.hold(unit, x); };
    const double squared = arithmetic.product(unit, t, t);
    const double inner = arithmetic.mac(unit, word(-0.6432292), squared, word(0.0727102));
    return arithmetic.product(unit, t, arithmetic.mac(unit, word(1.5706268), squared, inner));
}

/// A point of the unit disc, evenly: the root of u from its middle, at v of a turn.
dvec2 on_disc(SamplePlace at, const Arithmetic& arithmetic) {
    const Format& unit = arithmetic.formats().unit;
    const double radius = arithmetic.square_root(arithmetic.hold(unit, fraction_of(at.u)));
    const double t = arithmetic.hold(unit, scale_by(at.v & 0x3fff, -14));
    const double sine = quarter_sine(t, arithmetic);
    const double cosine = quarter_sine(1 - t, arithmetic);
    const dvec2 turned[] = {{cosine, sine}, {-sine, cosine}, {-cosine, -sine}, {sine, -cosine}};
    const dvec2& way = turned[at.v >> 14];
    return {arithmetic.product(unit, radius, way.x), arithmetic.product(unit, radius, way.y)};
}

/// Of the disc that a sphere is from a point: the one through its middle, across the way there.
dvec3 on_sphere(const Source& source, SamplePlace at, const dvec3& from, const Arithmetic& arithmetic) {
    const dvec3 way = arithmetic.way(from, source.position);
    if (way == dvec3(0)) return source.position;
    const DiscAxes axes = disc_axes(way, arithmetic);
    const dvec2 disc = on_disc(at, arithmetic);
    dvec3 direction;
    for (int i = 0; i < 3; ++i)
        direction[i] =
            arithmetic.mac(arithmetic.formats().unit, 0, disc.x, axes.first[i], disc.y, axes.second[i]);
    return on_grid(source, source.position, source.radius, direction, 0, dvec3(0), arithmetic);
}

}  // namespace

/// The first is also across the coordinate axis that the way has least of.
DiscAxes disc_axes(const dvec3& way, const Arithmetic& arithmetic) {
    const dvec3 l = arithmetic.normalise(way);
    int least = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::abs(l[i]) < std::abs(l[least])) least = i;
    }
    const int p = (least + 1) % 3, q = (least + 2) % 3;
    dvec3 across(0);
    across[p] = l[q];
    across[q] = -l[p];
    DiscAxes axes;
    axes.first = arithmetic.normalise(across);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        axes.second[i] =
            arithmetic.mac(arithmetic.formats().unit, 0, l[j], axes.first[k], -l[k], axes.first[j]);
    }
    return axes;
}

Source middle_of(const Source& source) {
    Source middle = source;
    middle.position += (source.edge_u + source.edge_v) / (source.kind == SourceKind::triangle ? 3.0 : 2.0);
    return middle;
}

Source sample_of(const Source& source, SamplePlace at, const dvec3& from, const Arithmetic& arithmetic) {
    Source sample = source;
    if (source.kind == SourceKind::sphere) {
        sample.position = on_sphere(source, at, from, arithmetic);
        return sample;
    }
    // The other half of the parallelogram is turned into the triangle.
    if (source.kind == SourceKind::triangle && at.u + at.v > 0xffff)
        at = {std::uint16_t(0xffff - at.u), std::uint16_t(0xffff - at.v)};
    sample.position = on_grid(source, source.position, fraction_of(at.u), source.edge_u, fraction_of(at.v),
                              source.edge_v, arithmetic);
    return sample;
}

}  // namespace raycell
