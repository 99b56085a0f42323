// Where the samples of a pixel lie: a fixed pattern, the same for every pixel, in the machine and the truth.
#pragma once

#include "model/geometry/polygon.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// Place of sample number `sample` of `samples` (1..256) in its pixel, from its top left corner, in pixels:
/// (0, 1) both ways; one sample lies in the middle.
///
/// The first two dimensions of Sobol's sequence (1967): with a power of two of samples each row, each column
/// and each box of equal area has equally many, and of the first four each quarter of the pixel has one. The
/// digits are turned over so that the first four lie evenly around the middle, too. `tent`: the same places,
/// nearer to the middle, so that all samples weigh the same.
dvec2 sample_place(int sample, int samples, PixelFilter filter);

}  // namespace raycell
