#include "model/loading/span.hpp"

#include <algorithm>
#include <cmath>

#include "model/shading/shading.hpp"

namespace raycell {
namespace {

/// Below this |n_z| the plane's depth functions are useless; the bounds of the row's part are used instead.
constexpr double least_facing = 1e-5;

std::vector<dvec3> row_part(const Trapeze& trapeze, int row) {
    std::vector<dvec3> part(trapeze.corners.begin(), trapeze.corners.begin() + trapeze.corner_count);
    const double low = row - trapeze.slack.y;
    const double high = row + 1 + trapeze.slack.y;
    if (trapeze.top < low) part = clip_half_space(part, 1, low, 1);
    if (trapeze.bottom > high && !part.empty()) part = clip_half_space(part, 1, high, -1);
    return part;
}

void set_depth_functions(Span& span, double y_low, double y_high) {
    const dvec3& n = span.plane.n;
    if (std::abs(n.z) < least_facing) {
        span.near = span.z_min;
        span.far = span.z_max;
        return;
    }
    const double by_x = -n.x / n.z;
    const double by_y = -n.y / n.z;
    const double at_corner = span.plane.c / n.z;  // the plane is relative to the span's first cell already
    span.near = at_corner + std::min(by_x, 0.0) + std::min(by_y * y_low, by_y * y_high);
    span.far = at_corner + std::max(by_x, 0.0) + std::max(by_y * y_low, by_y * y_high);
    span.d_near = span.d_far = by_x;
}

/// Rounds the values that the row computed to loading words. All others are already sums of loading words.
void hold(Span& span, const Format& word) {
    const double steep = word.most() / 4;
    if (std::abs(span.d_near) > steep || std::abs(span.near) > steep || std::abs(span.far) > steep) {
        // Too steep for words: uses the bounds, as for a plane without depth functions.
        span.near = span.z_min;
        span.far = span.z_max;
        span.d_near = span.d_far = 0;
    }
    for (double* value : {&span.near, &span.far, &span.d_near, &span.d_far, &span.z_min, &span.z_max}) {
        *value = word.hold(*value);
    }
    for (int axis = 0; axis < 3; ++axis) {
        span.intensity[axis] = word.hold(span.intensity[axis]);
        span.d_intensity[axis] = word.hold(span.d_intensity[axis]);
        for (int i = 0; i < span.outline_count; ++i) {
            double& place = span.outline[std::size_t(i)][axis];
            place = word.hold(place);
        }
    }
}

/// Classic Gouraud: takes the intensities on the left and the right side at the middle of the row's part, and
/// interpolates linearly between them.
void set_intensity(Span& span, const Trapeze& trapeze, const CornerIntensities& shades, double y) {
    double left = 1e300;
    double right = -1e300;
    dvec3 at_left{0, 0, 0};
    dvec3 at_right{0, 0, 0};
    for (int i = 0; i < trapeze.corner_count; ++i) {
        const int j = (i + 1) % trapeze.corner_count;
        const dvec3& a = trapeze.corners[std::size_t(i)];
        const dvec3& b = trapeze.corners[std::size_t(j)];
        if (y < std::min(a.y, b.y) || y > std::max(a.y, b.y)) continue;
        for (int end = 0; end < 2; ++end) {  // a side along the row counts with both of its ends
            double share = double(end);
            if (a.y != b.y) {
                if (end == 1) break;
                share = (y - a.y) / (b.y - a.y);
            }
            const double x = a.x + share * (b.x - a.x);
            const dvec3 shade = shades[std::size_t(i)] * (1 - share) + shades[std::size_t(j)] * share;
            if (x < left) left = x, at_left = shade;
            if (x > right) right = x, at_right = shade;
        }
    }
    // Over less than a cell there is nothing to interpolate, and a steep increment would overshoot.
    if (right - left >= 1) span.d_intensity = (at_right - at_left) / (right - left);
    const double centre = span.x + 0.5;
    span.intensity =
        right - left >= 1 ? at_left + (centre - left) * span.d_intensity : 0.5 * (at_left + at_right);
}

}  // namespace

std::optional<Span> cut_span(const Trapeze& trapeze, int row, int width, const Arithmetic& arithmetic,
                             const CornerIntensities* intensities) {
    if (trapeze.bottom + trapeze.slack.y < row || trapeze.top - trapeze.slack.y > row + 1)
        return std::nullopt;
    const std::vector<dvec3> part = row_part(trapeze, row);
    if (part.size() < 3) return std::nullopt;
    dvec3 low = part.front();
    dvec3 high = part.front();
    for (const dvec3& p : part) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    low -= trapeze.slack;
    high += trapeze.slack;
    Span span;
    span.slack = trapeze.slack;
    span.polygon = trapeze.polygon;
    span.object = trapeze.object;
    span.x = std::clamp(int(std::floor(low.x)), 0, width - 1);
    span.last = std::clamp(int(std::floor(high.x)), span.x, width - 1);
    const dvec3 corner{double(span.x), double(row), 0};
    span.plane = trapeze.plane;
    span.plane.c -= span.plane.n.x * corner.x + span.plane.n.y * corner.y;
    span.drop = trapeze.drop;
    span.normal = trapeze.normal;
    const dvec2 shift = project(corner, span.drop);
    span.normal.base = trapeze.normal.at(shift);
    span.edge_count = trapeze.edge_count;
    for (int i = 0; i < span.edge_count; ++i) {
        EdgeFunction edge = trapeze.edges[std::size_t(i)];
        edge.c = edge.at(shift);
        span.edges[std::size_t(i)] = edge;
    }
    span.z_min = low.z;
    span.z_max = high.z;
    span.outline_count = int(std::min(part.size(), span.outline.size()));
    for (int i = 0; i < span.outline_count; ++i) span.outline[std::size_t(i)] = part[std::size_t(i)] - corner;
    set_depth_functions(span, std::clamp(low.y - row, 0.0, 1.0), std::clamp(high.y - row, 0.0, 1.0));
    if (intensities) {
        set_intensity(span, trapeze, *intensities, std::clamp(row + 0.5, low.y, high.y));
    }
    if (!arithmetic.exact()) hold(span, arithmetic.formats().loading);
    return span;
}

void advance(Span& span, const Arithmetic& arithmetic) {
    // Increments and the values they are added to have the same last bit, so that nothing drifts along a row.
    const Format& word = arithmetic.formats().loading;
    ++span.x;
    span.plane.c -= span.plane.n.x;
    if (span.drop != 0) {  // otherwise x is not among (u, v)
        span.normal.base += span.normal.du;
        for (int i = 0; i < span.edge_count; ++i)
            span.edges[std::size_t(i)].c += span.edges[std::size_t(i)].a;
    }
    span.near = arithmetic.hold(word, span.near + span.d_near);
    span.far = arithmetic.hold(word, span.far + span.d_far);
    for (int i = 0; i < span.outline_count; ++i) span.outline[std::size_t(i)].x -= 1;
    span.intensity = arithmetic.hold(word, span.intensity + span.d_intensity);
}

CornerIntensities shade_corners(const Trapeze& trapeze, const CellScene& scene) {
    CornerIntensities shades{};
    for (int i = 0; i < trapeze.corner_count; ++i) {
        const dvec3& corner = trapeze.corners[std::size_t(i)];
        const dvec3 normal = trapeze.normal.at(project(corner, trapeze.drop));
        const ShadePoint point = shade_point(corner, {0, 0, 1}, normal, trapeze.plane.n);
        shades[std::size_t(i)] = local_intensity(point, scene.objects[trapeze.object], scene.sources.data(),
                                                 scene.sources.size(), ~std::uint64_t(0));
    }
    return shades;
}

}  // namespace raycell
