// Light sources from faces whose material emits (Ke of MTL).
#pragma once

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Adds a source for every polygon whose material emits: a rectangle for a parallelogram, else a triangle for
/// each of its fan. Its front shines. The machine's sources do not fade with distance, so a face counts by
/// its power, area times emission, and all together have intensity 1 in their brightest channels: its
/// intensity is Ke · area / sum(largest channel of Ke · area). The sources stand before their faces by
/// LightSource::before. Warns of concave faces, which give no light, and of more than max_sources sources,
/// of which the most powerful stay. Adds a note that says how many there are.
void add_emitters(Scene& scene, Diagnostics& diagnostics);

}  // namespace raycell
