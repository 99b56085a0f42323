// Measures how far one picture is from another.
#pragma once

#include "model/picture/picture.hpp"

namespace raycell {

/// Errors of a picture against the truth, over colours clamped to [0, 1].
struct Accuracy {
    double psnr_db = 0;               ///< 20·log10(1/rmse), at most 200 (equal pictures)
    double rmse = 0;                  ///< over all channels of all pixels, 0..1
    double max_error = 0;             ///< largest difference of a channel, 0..1
    double off_by_1_255_percent = 0;  ///< pixels with a channel off by more than 1/255
    double off_by_0_1_percent = 0;    ///< pixels with a channel off by more than 0.1
    double wrong_hit_percent = 0;     ///< pixels whose first hit is another polygon, or none
};

/// Compares two pictures of one size. Throws std::invalid_argument if the sizes differ or are 0,
/// std::domain_error naming the first pixel that holds NaN.
Accuracy compare(const Picture& test, const Picture& truth);

/// Picture of the absolute differences of the clamped colours, times `gain` (>= 0) to make small ones
/// visible. Only colours are filled. Throws as compare does.
Picture difference(const Picture& test, const Picture& truth, double gain = 8);

}  // namespace raycell
