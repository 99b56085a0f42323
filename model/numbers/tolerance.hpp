// What counts as the same place in exact arithmetic, for the machine and for the truth alike: with rules of
// their own they would choose different surfaces wherever a ray meets an edge. Words have tolerances of their
// own (Arithmetic). Cell widths.
#pragma once

namespace raycell {

/// A ray that passes a polygon's outline by no more than this meets it. In the projection that the polygon is
/// kept in; what its corners lie off its plane comes to it, twice (Polygon::slack).
constexpr double exact_hair = 1e-7;

/// Surfaces met at distances that differ by no more than this are met at the same distance; then the one with
/// the lowest polygon id counts. More than `exact_hair`, since a hair along an outline is more along the ray.
constexpr double exact_tie = 1e-6;

/// A ray that leaves a polygon meets nothing nearer than this.
constexpr double nearest_hit = 1e-7;

}  // namespace raycell
