// Measures how far a picture is from the truth, on a sample of its pixels: cheap enough for every run.
#pragma once

#include "model/picture/picture.hpp"
#include "model/truth/truth.hpp"

namespace raycell {

struct SampledAccuracy {
    int pixels = 0;      ///< compared, spread evenly
    double psnr_db = 0;  ///< 200 stands for equal
};

/// Compares `most` pixels of a finished picture, or all if it has fewer, with the truth. Takes as long as
/// rendering that many pixels of `truth`.
SampledAccuracy sample_accuracy(const Picture& picture, const Frame& frame, const TruthRenderer& truth,
                                int most);

}  // namespace raycell
