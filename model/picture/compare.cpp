#include "model/picture/compare.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace raycell {

namespace {

constexpr double largest_psnr = 200;  ///< dB; replaces infinity, which JSON can't express
constexpr double rounding = 1e-6;     ///< tolerance: an error of one 8-bit step is not "more than 1/255"

bool has_nan(const Pixel& pixel) {
    return std::isnan(pixel.depth) || glm::any(glm::isnan(pixel.colour)) ||
           glm::any(glm::isnan(pixel.normal));
}

void check(const Picture& picture, const char* name) {
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            if (has_nan(picture.at(x, y)))
                throw std::domain_error("pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                                        ") of the " + name + " picture holds NaN");
}

void check(const Picture& test, const Picture& truth) {
    if (test.width != truth.width || test.height != truth.height)
        throw std::invalid_argument("pictures differ in size: " + std::to_string(test.width) + "x" +
                                    std::to_string(test.height) + " and " + std::to_string(truth.width) +
                                    "x" + std::to_string(truth.height));
    if (test.pixels.empty()) throw std::invalid_argument("pictures are empty");
    check(test, "tested");
    check(truth, "true");
}

dvec3 absolute_difference(const Pixel& a, const Pixel& b) {
    return glm::abs(glm::clamp(a.colour, 0.0, 1.0) - glm::clamp(b.colour, 0.0, 1.0));
}

}  // namespace

Accuracy compare(const Picture& test, const Picture& truth) {
    check(test, truth);
    Accuracy accuracy;
    double squares = 0;
    std::size_t off_by_step = 0, off_by_tenth = 0, wrong_hits = 0;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) {
        const dvec3 error = absolute_difference(test.pixels[i], truth.pixels[i]);
        const double largest = std::max({error.r, error.g, error.b});
        squares += glm::dot(error, error);
        accuracy.max_error = std::max(accuracy.max_error, largest);
        off_by_step += largest > 1.0 / 255 + rounding;
        off_by_tenth += largest > 0.1 + rounding;
        wrong_hits += test.pixels[i].polygon != truth.pixels[i].polygon;
    }
    const double pixels = double(test.pixels.size());
    accuracy.rmse = std::sqrt(squares / (3 * pixels));
    accuracy.psnr_db =
        accuracy.rmse > 0 ? std::min(-20 * std::log10(accuracy.rmse), largest_psnr) : largest_psnr;
    accuracy.off_by_1_255_percent = 100 * double(off_by_step) / pixels;
    accuracy.off_by_0_1_percent = 100 * double(off_by_tenth) / pixels;
    accuracy.wrong_hit_percent = 100 * double(wrong_hits) / pixels;
    return accuracy;
}

Picture difference(const Picture& test, const Picture& truth, double gain) {
    check(test, truth);
    Picture picture(test.width, test.height);
    for (std::size_t i = 0; i < test.pixels.size(); ++i)
        picture.pixels[i].colour = gain * absolute_difference(test.pixels[i], truth.pixels[i]);
    return picture;
}

}  // namespace raycell
