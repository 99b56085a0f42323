// Tolerances of exact arithmetic, in cell widths. The machine and the truth share them: with different rules
// they would choose different surfaces wherever a ray meets an edge. Words have tolerances of their own
// (Arithmetic).
#pragma once

namespace raycell {

/// A ray that passes a polygon's outline by no more than this meets it. Measured in the projection that the
/// polygon is stored in; twice the distance of its corners from its plane (Polygon::slack) is added.
constexpr double exact_hair = 1e-7;

/// Surfaces whose distances along a ray differ by no more than this count as met at the same distance; then
/// the lowest polygon id counts. Larger than `exact_hair`, since a tolerance across an outline is longer
/// along the ray.
constexpr double exact_tie = 1e-6;

/// A ray that leaves a polygon meets nothing nearer than this.
constexpr double nearest_hit = 1e-7;

}  // namespace raycell
