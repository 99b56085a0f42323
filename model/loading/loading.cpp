#include "model/loading/loading.hpp"

#include <algorithm>
#include <cmath>

#include "model/numbers/tolerance.hpp"

namespace raycell {

namespace {

/// The largest component of the polygon's field of normals at the corners of the cells that it touches. Spans
/// carry it there, at z = 0.
double largest_over_cells(const Polygon& polygon) {
    dvec3 low = polygon.vertices[0];
    dvec3 high = low;
    for (const dvec3& v : polygon.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    double largest = 0;
    for (const double x : {std::floor(low.x) - 1, std::floor(high.x) + 1}) {
        for (const double y : {std::floor(low.y) - 1, std::floor(high.y) + 1}) {
            const dvec3 normal = glm::abs(polygon.normal.at(project({x, y, 0}, polygon.drop)));
            largest = std::max({largest, normal.x, normal.y, normal.z});
        }
    }
    return largest;
}

/// Rounds a polygon to loading words.
void hold(Polygon& polygon, const Arithmetic& arithmetic) {
    const Format& word = arithmetic.formats().loading;
    dvec3 centre{0, 0, 0};
    for (dvec3& v : polygon.vertices) {
        v = arithmetic.hold(word, v);
        centre += v / double(polygon.vertices.size());
    }
    // Rounds upwards: half a last bit more than the bound of 2 * slack + 4 last bits, then to the nearest.
    polygon.slack = arithmetic.hold(word, polygon.slack * 2 + 4.5 * word.step());
    polygon.plane = hold_plane(polygon.plane, polygon.drop, centre, word, word);
    const dvec2 middle = project(centre, polygon.drop);
    // Half of the range: rounding adds to what the field is at another cell.
    const double most = scale_by(1, word.integer_bits() - 2);
    polygon.normal = fill_words(polygon.normal, polygon.normal.at(middle), most, 1024 * word.step(), nullptr,
                                largest_over_cells(polygon));
    polygon.normal = hold_field(polygon.normal, middle, word, word);
}

}  // namespace

bool clip_to_cube(Polygon& polygon, const Box& cube, const Arithmetic& arithmetic) {
    polygon.vertices = clip_to_box(std::move(polygon.vertices), cube);
    if (polygon.vertices.empty()) return false;
    if (!arithmetic.exact()) hold(polygon, arithmetic);
    return glm::length(newell(polygon.vertices)) > 0;
}

bool may_touch_rows(const Polygon& polygon, const Stretch& rows, const Arithmetic& arithmetic) {
    double low = polygon.vertices[0].y;
    double high = low;
    for (const dvec3& v : polygon.vertices) {
        low = std::min(low, v.y);
        high = std::max(high, v.y);
    }
    // More than rounding and slack add on the way to the trapezes (hold(), precompute()).
    const double step = arithmetic.exact() ? exact_hair : arithmetic.formats().loading.step();
    const double more = 4 * polygon.slack + 16 * step;
    return high + more >= rows.first && low - more <= rows.last + 1;
}

std::vector<CellStore> load_array(const CellScene& scene, const PictureSettings& settings,
                                  const Arithmetic& arithmetic, LoadCounts* counts) {
    const Frame& frame = scene.frame;
    std::vector<CellStore> cells(std::size_t(frame.width) * std::size_t(frame.height));
    LoadCounts total;
    const bool gouraud = settings.display == Display::gouraud;
    for (Polygon polygon : scene.polygons) {
        if (!clip_to_cube(polygon, frame.cube(), arithmetic)) continue;
        ++total.polygons;
        for (const Trapeze& trapeze : precompute(polygon, arithmetic, frame.width, frame.height)) {
            ++total.trapezes;
            CornerIntensities shades;
            if (gouraud) shades = shade_corners(trapeze, scene, arithmetic);
            for (int row = trapeze.rows.first; row < frame.height; ++row) {
                if (auto span = cut_span(trapeze, row, frame.depth, settings.hit, arithmetic,
                                         gouraud ? &shades : nullptr)) {
                    ++total.spans;
                    for (;; advance(*span, arithmetic)) {
                        const std::size_t cell =
                            std::size_t(row) * std::size_t(frame.width) + std::size_t(span->x);
                        store_voxel(cells[cell], *span, settings, frame.level(), arithmetic);
                        if (span->x == span->last) break;
                    }
                }
                if (!trapeze.reaches_below(row)) break;
            }
        }
    }
    for (CellStore& cell : cells) {
        if (settings.shadows != Shadows::per_hit) reset_shadow_bits(cell);
        total.voxels += cell.voxels.size();
        total.overflowed += cell.overflowed;
    }
    if (counts) *counts = total;
    return cells;
}

void reset_shadow_bits(CellStore& store) {
    store.lit.assign(store.voxels.size(), ~std::uint64_t(0));
    store.known.assign(store.voxels.size(), 0);
}

}  // namespace raycell
