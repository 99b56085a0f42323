// Makes polygons from the readers' raw outlines; they meet the conditions of PolygonPrimitive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// The place of an outline in the input, for messages.
struct Place {
    const std::string& file;
    std::size_t line;
};

/// Adds an outline with finite coordinates (magnitude 1e30 at most) to the scene. Faults are repaired, each
/// with a warning:
/// - repeated vertices are removed; an outline without area is dropped;
/// - a non-planar outline is cut into triangles by ear clipping in the projection along its mean normal. All
///   edges of the outline stay, so there are no cracks to its neighbours. Non-planar means: a vertex is off
///   the mean plane by more than 1e-4 of the polygon's size plus the error of six printed digits (at most 1 %
///   of the size);
/// - `normals` (empty or one per vertex) are made unit vectors; one without length becomes the outline's own.
///   If all oppose the winding, all are flipped; a single one that points straight back is flipped alone.
///   Other normals that oppose the winding, as on a coarse curved surface, are kept without a warning.
/// The outline's normal is Newell's, over all vertices, so its first three vertices may make a reflex corner
/// (with a warning). Throws InputError for a non-planar outline of more than 1000 vertices.
void add_outline(Scene& scene, std::uint32_t material, std::vector<dvec3> vertices,
                 std::vector<dvec3> normals, const Place& place, Diagnostics& diagnostics);

}  // namespace raycell
