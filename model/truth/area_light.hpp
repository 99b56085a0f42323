// Light of sources that are areas, as the truth sees it: many points on them, exactly.
#pragma once

#include <functional>

#include "model/shading/shading.hpp"

namespace raycell {

/// What an area adds to the local intensity at a point: the mean over `samples` points of it, of those that
/// `visible(direction, distance)` says are not hidden. It is asked for those alone that the normal faces and
/// that shine this way. The points are not those of the machine: Hammersley's, shifted by a hash of the
/// point, on a disc and a triangle by their own areas.
dvec3 area_light(const ShadePoint& point, const Material& material, const Source& source, int samples,
                 const std::function<bool(const dvec3&, double)>& visible);

}  // namespace raycell
