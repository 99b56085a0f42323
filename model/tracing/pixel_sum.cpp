#include "model/tracing/pixel_sum.hpp"

#include <algorithm>
#include <cmath>

namespace raycell {
namespace {

double last_place(const Arithmetic& arithmetic) {
    return arithmetic.exact() ? 1.0 / (std::int64_t(1) << 40) : arithmetic.formats().intensity.step();
}

}  // namespace

void PixelSum::add(const dvec3& intensity, const Arithmetic& arithmetic) {
    const double step = last_place(arithmetic);
    for (std::size_t i = 0; i < 3; ++i) {
        constexpr double most = 1 << 22;
        const std::int64_t word = std::llround(std::clamp(intensity[int(i)], -most, most) / step);
        sum_[i] += word;
        least_[i] = count_ > 0 ? std::min(least_[i], word) : word;
        most_[i] = count_ > 0 ? std::max(most_[i], word) : word;
    }
    ++count_;
}

bool PixelSum::agrees(double within, const Arithmetic& arithmetic) const {
    const double step = last_place(arithmetic);
    for (std::size_t i = 0; i < 3; ++i) {
        if (double(most_[i] - least_[i]) * step > within) return false;
    }
    return true;
}

dvec3 PixelSum::mean(const Arithmetic& arithmetic) const {
    const double step = last_place(arithmetic);
    const dvec3 sum{double(sum_[0]), double(sum_[1]), double(sum_[2])};
    return arithmetic.hold(arithmetic.formats().intensity, sum * step / double(count_));
}

bool is_complete(const PixelSum& sum, const PictureSettings& settings, const Arithmetic& arithmetic) {
    if (sum.count() == settings.samples) return true;
    return may_stop_early(settings) && sum.count() == first_samples &&
           sum.agrees(settings.sample_until, arithmetic);
}

}  // namespace raycell
