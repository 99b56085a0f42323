// Makes polygons of the readers' raw outlines: what goes into the scene keeps PolygonPrimitive's promises.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Where an outline stands in the input, for messages.
struct Place {
    const std::string& file;
    std::size_t line;
};

/// Adds an outline with finite coordinates (magnitude 1e30 at most) to the scene, repaired where need be,
/// each repair with a warning:
/// - repeated vertices are removed; an outline without area is dropped;
/// - a non-planar outline is cut into triangles by ear clipping in the projection along its mean normal; all
/// edges
///   of the outline stay, so there are no cracks to the neighbours. Non-planar means that a vertex is off the
///   mean plane by more than 1e-4 of the polygon's size, plus what six printed digits may have cost (1 % at
///   most);
/// - `normals` (empty or one per vertex) are made unit; a vanishing one becomes the outline's own. Where all
///   oppose the winding, all are flipped; a single one that points straight back is flipped alone. Those of a
///   coarse curved surface that lean beyond the edge of their polygon are left alone, in silence.
/// The outline's normal is Newell's, over all vertices, so its first three vertices may make a reflex corner
/// (warned for). Throws InputError for a non-planar outline of more than 1000 vertices.
void add_outline(Scene& scene, std::uint32_t material, std::vector<dvec3> vertices,
                 std::vector<dvec3> normals, const Place& place, Diagnostics& diagnostics);

}  // namespace raycell
