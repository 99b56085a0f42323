// The scene as the array can hold it: cut off at the cube.
#pragma once

#include "model/geometry/placement.hpp"

namespace raycell {

/// The scene with every polygon's outline clipped to the cube. Ids, planes and normal fields are kept, so a
/// point that remains shades as before. Polygons with nothing left are dropped. Against the truth of this
/// scene, what is lost outside the cube does not count as error (design, section 7).
CellScene clip_scene(const CellScene& scene);

}  // namespace raycell
