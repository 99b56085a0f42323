#include "model/loading.hpp"

namespace raycell {

bool clip_to_cube(Polygon& polygon, const Box& cube) {
    polygon.vertices = clip_to_box(std::move(polygon.vertices), cube);
    return !polygon.vertices.empty() && glm::length(newell(polygon.vertices)) > 0;
}

std::vector<CellStore> load_array(const CellScene& scene, const PictureSettings& settings,
                                  LoadCounts* counts) {
    const Frame& frame = scene.frame;
    std::vector<CellStore> cells(std::size_t(frame.width) * std::size_t(frame.height));
    LoadCounts total;
    const bool gouraud = settings.display == Display::gouraud;
    for (Polygon polygon : scene.polygons) {
        if (!clip_to_cube(polygon, frame.cube())) continue;
        ++total.polygons;
        for (const Trapeze& trapeze : precompute(polygon)) {
            ++total.trapezes;
            CornerIntensities shades;
            if (gouraud) shades = shade_corners(trapeze, scene);
            for (int row = trapeze.first_row(frame.height); row < frame.height; ++row) {
                if (auto span = cut_span(trapeze, row, frame.width, gouraud ? &shades : nullptr)) {
                    ++total.spans;
                    for (;; advance(*span)) {
                        const std::size_t cell =
                            std::size_t(row) * std::size_t(frame.width) + std::size_t(span->x);
                        store_voxel(cells[cell], *span, settings, frame.level());
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
