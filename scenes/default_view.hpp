// A view for scenes whose format has none.
#pragma once

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Gives a scene a view that frames its bounding box, from the side of +z with y up, and one source at the
/// viewer; a note says so.
void add_default_view(Scene& scene, Diagnostics& diagnostics);

/// Takes background and view from `view_scene`, and its sources if it has any. Scene::view stays as it is if
/// `view_scene` has none.
void take_view(Scene& scene, const Scene& view_scene);

}  // namespace raycell
