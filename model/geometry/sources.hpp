// Light sources in cell coordinates, and what bits depend on of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "model/geometry/scene.hpp"

namespace raycell {

/// A light source in cell coordinates.
struct Source {
    dvec3 position{0, 0, 0};  ///< not of directional ones
    dvec3 intensity{1, 1, 1};
    SourceKind kind = SourceKind::point;
    /// Unit: directional and spot: against the way of its light; rectangle and triangle: against the normal
    /// of its front.
    dvec3 axis{0, 0, 0};
    double cut_off = 0;     ///< spot: cosine at the edge of its cone, 0..1
    double falloff = 1;     ///< spot: power of the cosine to the axis
    dvec3 edge_u{0, 0, 0};  ///< rectangle, triangle: from the corner `position`
    dvec3 edge_v{0, 0, 0};
    double radius = 0;  ///< sphere, cells
    int exponent =
        0;  ///< of its mantissas: place, edges or radius, and all its points are below 2^it; words only
};

/// The sources of a scene, as far as bits depend on them.
struct SourceCounts {
    std::array<std::size_t, std::size_t(source_kinds)> of_kind{};
    std::size_t lights = 0;  ///< shadow rays a hit: one to a source, to an area one to each sample

    /// So many points.
    SourceCounts(std::size_t points) : lights(points) { of_kind[0] = points; }
    SourceCounts(const std::vector<Source>& sources, int samples) {
        for (const Source& source : sources) {
            ++of_kind[std::size_t(source.kind)];
            lights += is_area(source.kind) ? std::size_t(samples) : 1;
        }
    }
    std::size_t sources() const {
        std::size_t sum = 0;
        for (const std::size_t count : of_kind) sum += count;
        return sum;
    }
    /// Whether all are points: then no message says which kind a source is of.
    bool points() const { return sources() == of_kind[0]; }
};

}  // namespace raycell
