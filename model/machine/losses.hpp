// What a picture in words loses, by cause: told before a run, and in its report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/tracing/tracing.hpp"

namespace raycell {

/// Counts over a whole scene. In exact arithmetic all are 0.
struct Losses {
    std::uint64_t features = 0;  ///< objects with a colour or coefficient beyond its format
    std::uint64_t indices = 0;   ///< objects with an index of refraction beyond its format
    std::uint64_t lights = 0;    ///< sources, and the background, brighter than an intensity can be
    /// Polygons so small that words can't tell their normals apart: they have one each.
    std::uint64_t single_normals = 0;
    /// What a primary ray may be off by at the back of the cube, cells: half a last bit of its direction a
    /// cell.
    double drift = 0;
    std::uint64_t polygons = 0;  ///< of the scene, for comparison
};
Losses losses_of(const Context& context);

/// A line for each cause that is there, for standard error: what it is, what becomes of it, what mends it.
std::vector<std::string> loss_warnings(const Losses& losses, const Context& context);

/// Pixels whose colour ends at the largest intensity.
std::uint64_t saturated_pixels(const Picture& picture, const Context& context);

}  // namespace raycell
