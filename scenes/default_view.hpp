// A view for scenes whose format has none.
#pragma once

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Gives a scene a view that frames its bounding box, from the side of +z with y up, and one source at the
/// viewer if it has none. Adds a note about it to `diagnostics`.
void add_default_view(Scene& scene, Diagnostics& diagnostics);

/// Takes the background of `view_scene`, and its view and its sources if it has any.
void take_view(Scene& scene, const Scene& view_scene);

}  // namespace raycell
