#include "model/truth/area_light.hpp"

#include <cmath>

#include "model/numbers/hash.hpp"

namespace raycell {
namespace {

/// The digits of k in base 2, mirrored at the point.
double mirrored_digits(unsigned k) {
    double sum = 0;
    for (double half = 0.5; k > 0; k >>= 1, half /= 2) sum += (k & 1) * half;
    return sum;
}

/// Two fractions that look random, from a place.
dvec2 shift_of(const dvec3& place) {
    Fnv hash;
    hash.add_bytes(&place, sizeof place);
    hash.fold(32);
    hash.add(1);
    hash.fold(29);
    const std::uint64_t word = hash.value();
    return {double(word & 0xffffff) / 0x1000000, double(word >> 24 & 0xffffff) / 0x1000000};
}

/// A point of a source from two fractions.
dvec3 place_on(const Source& source, const dvec2& at, const dvec3& from) {
    if (source.kind == SourceKind::rectangle)
        return source.position + at.x * source.edge_u + at.y * source.edge_v;
    const double root = std::sqrt(at.x);
    if (source.kind == SourceKind::triangle)
        return source.position + root * (1 - at.y) * source.edge_u + root * at.y * source.edge_v;
    const dvec3 way = source.position - from;
    const dvec3 beside = std::abs(way.x) < std::abs(way.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(way, beside));
    const dvec3 second = glm::normalize(glm::cross(way, first));
    const double turn = 2 * 3.14159265358979323846 * at.y;
    return source.position + source.radius * root * (std::cos(turn) * first + std::sin(turn) * second);
}

}  // namespace

dvec3 area_light(const ShadePoint& point, const Material& material, const Source& source, int samples,
                 const std::function<bool(const dvec3&, double)>& visible) {
    const dvec2 shift = shift_of(point.position);
    const dvec3 mirrored = glm::reflect(point.direction, point.normal);
    double diffuse = 0, highlight = 0;
    for (int k = 0; k < samples; ++k) {
        const dvec2 at = glm::fract(dvec2((k + 0.5) / samples, mirrored_digits(unsigned(k))) + shift);
        const dvec3 way = place_on(source, at, point.position) - point.position;
        const double distance = glm::length(way);
        if (!(distance > 0)) continue;
        const dvec3 direction = way / distance;
        const double cosine = glm::dot(point.normal, direction);
        const double emission = source.kind == SourceKind::sphere ? 1 : glm::dot(source.axis, direction);
        if (cosine <= 0 || emission <= 0 || !visible(direction, distance)) continue;
        diffuse += emission * cosine;
        const double along = glm::dot(mirrored, direction);
        if (material.specular > 0 && along > 0) highlight += emission * std::pow(along, material.shine);
    }
    return source.intensity * (material.diffuse * diffuse * material.colour + material.specular * highlight) /
           double(samples);
}

}  // namespace raycell
