// Perceived and relative differences of pictures, beside PSNR.
#pragma once

#include "model/picture/picture.hpp"

namespace raycell {

// All compare two pictures of one size, of one pixel or more; throw std::invalid_argument otherwise.

/// Mean structural similarity, 1 for equal pictures, of the luma (Rec. 601) of colours clamped to [0, 1]. The
/// values are taken as they stand, as the PNG shows them: no transfer curve. Gaussian window of 11x11 pixels,
/// sigma 1.5, K1 0.01, K2 0.03 (Wang, Bovik, Sheikh and Simoncelli 2004); beyond the border its pixels go on.
double ssim(const Picture& test, const Picture& truth);

/// Mean FLIP error, 0 for equal pictures, at most 1, at 67 pixels per degree (Andersson, Nilsson,
/// Akenine-Moeller, Oskarsson, Astroem and Fairchild 2020). Colours are clamped to [0, 1] and taken as sRGB
/// values, as a screen shows the PNG.
double flip(const Picture& test, const Picture& truth);

/// Mean over pixels and channels of (test - truth)^2 / (truth^2 + 0.01) of intensities, not clamped, without
/// a transfer curve (Rousselle, Knaus and Zwicker 2011).
double relative_mse(const Picture& test, const Picture& truth);

}  // namespace raycell
