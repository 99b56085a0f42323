// What a picture loses in fixed-point words, by cause: for warnings before a run, and for its report.
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
    /// Polygons so small that words can't tell the normals of their vertices apart: each has a single normal.
    std::uint64_t single_normals = 0;
    /// Largest error of a primary ray at the back of the cube, in cells: half a last bit of its direction per
    /// cell.
    double drift = 0;
    std::uint64_t polygons = 0;  ///< of the scene, for comparison
};
Losses losses_of(const Context& context);

/// Warnings for standard error, one per cause that occurs: the loss and, where there is one, the value used
/// instead or a remedy.
std::vector<std::string> loss_warnings(const Losses& losses, const Context& context);

/// Number of pixels whose colour reaches the largest intensity.
std::uint64_t saturated_pixels(const Picture& picture, const Context& context);

}  // namespace raycell
