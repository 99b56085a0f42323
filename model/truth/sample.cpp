#include "model/truth/sample.hpp"

#include <algorithm>
#include <cmath>

namespace raycell {

SampledAccuracy sample_accuracy(const Picture& picture, const Frame& frame, const TruthRenderer& truth,
                                int most) {
    SampledAccuracy sample;
    const auto all = picture.pixels.size();
    sample.pixels = int(std::min(all, std::size_t(std::max(most, 1))));
    // Steps of the golden ratio fall evenly over rows and columns alike.
    constexpr double golden = 0.6180339887498949;
    double squares = 0;
    for (int i = 0; i < sample.pixels; ++i) {
        const double share = std::fmod((i + 0.5) * golden, 1.0);
        const std::size_t at =
            std::size_t(sample.pixels) == all ? std::size_t(i) : std::size_t(share * double(all));
        const int x = int(at % std::size_t(picture.width));
        const int y = int(at / std::size_t(picture.width));
        const dvec3 exact = truth.pixel(x, y, int(picture.at(x, y).samples));
        const dvec3 error = glm::clamp(exact, 0.0, 1.0) - glm::clamp(picture.at(x, y).colour, 0.0, 1.0);
        squares += glm::dot(error, error);
    }
    const double mean = squares / (3.0 * std::max(sample.pixels, 1));
    sample.psnr_db = mean > 0 ? std::min(-10 * std::log10(mean), 200.0) : 200;
    return sample;
}

}  // namespace raycell
