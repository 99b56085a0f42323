#include "model/loading/span.hpp"

#include <algorithm>
#include <cmath>

#include "model/loading/part.hpp"
#include "model/shading/shading.hpp"

namespace raycell {
namespace {

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

/// The surface and the edges as seen from the corner of cell (x, row): sums of words.
Span seen_from(const Trapeze& trapeze, int x, int row) {
    Span span;
    span.polygon = trapeze.polygon;
    span.object = trapeze.object;
    span.slack = trapeze.slack;
    span.drop = trapeze.drop;
    span.x = span.last = x;
    span.plane = trapeze.plane;
    span.plane.c -= span.plane.n.x * x + span.plane.n.y * row;
    const dvec2 shift = project({double(x), double(row), 0}, span.drop);
    span.normal = trapeze.normal;
    span.normal.base = trapeze.normal.at(shift);
    span.edge_count = trapeze.edge_count;
    for (int i = 0; i < span.edge_count; ++i) {
        EdgeFunction& edge = span.edges[std::size_t(i)] = trapeze.edges[std::size_t(i)];
        edge.c = edge.at(shift);
    }
    return span;
}

/// Leaves out the edges that cut none of the span's cells.
void keep_crossing_edges(Span& span, double depth) {
    const dvec3 cells{double(span.last - span.x + 1), 1, depth};
    const dvec2 low = project(-span.slack, span.drop);
    const dvec2 high = project(cells + span.slack, span.drop);
    const auto crosses = [&](const EdgeFunction& e) {
        return e.c + std::min(e.a * low.x, e.a * high.x) + std::min(e.b * low.y, e.b * high.y) < 0;
    };
    int kept = 0;
    for (int i = 0; i < span.edge_count; ++i) {
        if (crosses(span.edges[std::size_t(i)])) span.edges[std::size_t(kept++)] = span.edges[std::size_t(i)];
    }
    span.edge_count = kept;
}

/// Rung `depth`: whether the polygon covers the centre of the span's current cell; z is its depth there.
bool covers_centre(const Span& span, double hair, double& z) {
    const dvec3& n = span.plane.n;
    if (std::abs(n.z) < 1e-12) return false;
    z = (span.plane.c - 0.5 * (n.x + n.y)) / n.z;
    const dvec2 uv = project({0.5, 0.5, z}, span.drop);
    for (int i = 0; i < span.edge_count; ++i) {
        if (span.edges[std::size_t(i)].at(uv) < -hair) return false;
    }
    return true;
}

/// Rung `depth`: cuts the span down to the cells whose centres the polygon covers, and sets depth and normal
/// at the first of them with their increments (paper, section 3.1: Z, DZ, N, DN). False if there are none.
bool keep_covered_centres(Span& span, const Arithmetic& arithmetic) {
    double z = 0;
    const int last = span.last;
    while (!covers_centre(span, arithmetic.hair(), z)) {
        if (span.x == last) return false;
        advance(span, arithmetic);
    }
    const Format& word = arithmetic.formats().loading;
    const dvec3 n = span.plane.n;
    span.z = arithmetic.hold(word, z);
    Span next = span;
    for (span.last = span.x; span.last < last; ++span.last) {
        advance(next, arithmetic);
        if (!covers_centre(next, arithmetic.hair(), z)) break;
    }
    span.n = arithmetic.hold(word, span.normal.at(project({0.5, 0.5, span.z}, span.drop)));
    if (span.last > span.x) {
        span.dz = arithmetic.hold(word, -n.x / n.z);
        const dvec2 step = project({1, 0, span.dz}, span.drop);
        span.dn = arithmetic.hold(word, step.x * span.normal.du + step.y * span.normal.dv);
    }
    // What else cells need of the plane is its slopes; of them no sums are made.
    span.plane = {arithmetic.hold(arithmetic.formats().unit, n), 0};
    span.edge_count = 0;
    return true;
}

}  // namespace

std::optional<Span> cut_span(const Trapeze& trapeze, int row, double depth, HitTest hit,
                             const Arithmetic& arithmetic, const CornerIntensities* intensities) {
    if (row < trapeze.rows.first || row > trapeze.rows.last) return std::nullopt;
    const auto [first, last] = trapeze.columns;
    const Span whole = seen_from(trapeze, 0, row);
    const Box box{dvec3(first, 0, 0) - trapeze.slack, dvec3(last + 1, 1, depth) + trapeze.slack};
    const Part part =
        part_in({whole.plane, whole.drop, whole.edges.data(), whole.edge_count}, box, arithmetic);
    if (part.empty()) return std::nullopt;
    const auto column = [first = first, last = last](double x) {
        return std::clamp(int(std::floor(x)), first, last);
    };
    Span span = seen_from(trapeze, column(part.low.x - trapeze.slack.x), row);
    span.last = std::max(column(part.high.x + trapeze.slack.x), span.x);
    if (hit == HitTest::depth) {
        if (!keep_covered_centres(span, arithmetic)) return std::nullopt;
    } else {
        keep_crossing_edges(span, depth);
    }
    if (intensities) {
        const double low = std::clamp(part.low.y, 0.0, 1.0);
        const double high = std::clamp(part.high.y, 0.0, 1.0);
        set_intensity(span, trapeze, *intensities, row + std::clamp(0.5, low, high));
        span.intensity = arithmetic.hold(arithmetic.formats().loading, span.intensity);
        span.d_intensity = arithmetic.hold(arithmetic.formats().loading, span.d_intensity);
    }
    return span;
}

void advance(Span& span, const Arithmetic& arithmetic) {
    // Increments and the values they are added to have the same last bit, so that nothing drifts along a row.
    ++span.x;
    span.plane.c -= span.plane.n.x;
    if (span.drop != 0) {  // otherwise x is not among (u, v)
        span.normal.base += span.normal.du;
        for (int i = 0; i < span.edge_count; ++i)
            span.edges[std::size_t(i)].c += span.edges[std::size_t(i)].a;
    }
    span.z += span.dz;
    span.n += span.dn;
    span.intensity = arithmetic.hold(arithmetic.formats().loading, span.intensity + span.d_intensity);
}

CornerIntensities shade_corners(const Trapeze& trapeze, const CellScene& scene,
                                const Arithmetic& arithmetic) {
    CornerIntensities shades{};
    std::vector<Source> sources;
    for (const Source& source : scene.sources) sources.push_back(middle_of(source));
    for (int i = 0; i < trapeze.corner_count; ++i) {
        const dvec3& corner = trapeze.corners[std::size_t(i)];
        const dvec3 normal = trapeze.normal.at(project(corner, trapeze.drop));
        const ShadePoint point = shade_point(corner, {0, 0, 1}, normal, trapeze.plane.n);
        shades[std::size_t(i)] = arithmetic.hold(
            arithmetic.formats().loading, local_intensity(point, scene.objects[trapeze.object],
                                                          sources.data(), sources.size(), ~std::uint64_t(0)));
    }
    return shades;
}

}  // namespace raycell
