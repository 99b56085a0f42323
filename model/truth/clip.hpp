// The scene as the array can hold it: cut off at the cube.
#pragma once

#include "model/geometry/placement.hpp"

namespace raycell {

/// The scene with every polygon's outline clipped to the cube; ids, planes and normal fields are kept, so a
/// point that remains shades as before. Polygons of which nothing remains are dropped. For the truth against
/// which nothing counts as error that is lost outside the cube (design, section 7).
CellScene clip_scene(const CellScene& scene);

}  // namespace raycell
