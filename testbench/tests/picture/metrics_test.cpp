// SSIM, FLIP and relative MSE against what other implementations give for the same pictures.
#include "model/picture/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace raycell {
namespace {

/// A picture of waves with a step, and the same with spots, a wave and a shifted edge.
struct Pair {
    Picture truth{61, 47};
    Picture test{61, 47};
    Pair() {
        for (int y = 0; y < truth.height; ++y) {
            for (int x = 0; x < truth.width; ++x) {
                const dvec3 right(0.5 + 0.5 * std::sin(0.3 * x + 0.1 * y),
                                  0.5 + 0.5 * std::cos(0.05 * x * y * 0.1), x > 30 && y > 20 ? 0.9 : 0.1);
                const dvec3 error(x % 7 == 0 && y % 5 == 0 ? 0.3 : 0.0, 0.05 * std::sin(0.9 * x),
                                  x > 28 && y > 20 && x <= 30 ? 0.8 : 0.0);
                truth.at(x, y).colour = right;
                test.at(x, y).colour = glm::clamp(right + error, dvec3(0), dvec3(1));
            }
        }
    }
};

Picture plain(const dvec3& colour) {
    Picture picture(8, 8);
    for (Pixel& pixel : picture.pixels) pixel.colour = colour;
    return picture;
}

TEST(Metrics, OfEqualPicturesAreTheirBest) {
    const Pair pair;
    EXPECT_NEAR(ssim(pair.truth, pair.truth), 1, 1e-12);
    EXPECT_EQ(flip(pair.truth, pair.truth), 0);
    EXPECT_EQ(relative_mse(pair.truth, pair.truth), 0);
}

TEST(Metrics, FlipIsThatOfThePublishedImplementation) {
    // Python, v1.2, float64 in place of float32, the same pictures.
    const Pair pair;
    EXPECT_NEAR(flip(pair.test, pair.truth), 0.17183278955613265, 1e-7);
}

TEST(Metrics, SsimAndRelativeMseAreThoseOfASecondWriting) {
    // NumPy and SciPy, from the formulas.
    const Pair pair;
    EXPECT_NEAR(ssim(pair.test, pair.truth), 0.9223976019902681, 1e-12);
    EXPECT_NEAR(relative_mse(pair.test, pair.truth), 0.22248265705335904, 1e-12);
}

TEST(Metrics, FlipOfBlackAgainstWhiteIsNearItsLargest) {
    const double error = flip(plain(dvec3(0)), plain(dvec3(1)));
    EXPECT_GT(error, 0.95);
    EXPECT_LT(error, 1);
    EXPECT_NEAR(error, flip(plain(dvec3(1)), plain(dvec3(0))), 1e-12) << "either way";
}

TEST(Metrics, RelativeMseSeesIntensitiesBeyondOneAndTheOthersDoNot) {
    EXPECT_NEAR(relative_mse(plain(dvec3(3)), plain(dvec3(2))), 1 / 4.01, 1e-12);
    EXPECT_NEAR(ssim(plain(dvec3(3)), plain(dvec3(2))), 1, 1e-12);
    EXPECT_EQ(flip(plain(dvec3(3)), plain(dvec3(2))), 0);
}

TEST(Metrics, RefusePicturesOfDifferentSizes) {
    EXPECT_THROW(ssim(Picture(2, 3), Picture(3, 2)), std::invalid_argument);
    EXPECT_THROW(flip(Picture(2, 3), Picture(3, 2)), std::invalid_argument);
    EXPECT_THROW(relative_mse(Picture(), Picture()), std::invalid_argument);
}

}  // namespace
}  // namespace raycell
