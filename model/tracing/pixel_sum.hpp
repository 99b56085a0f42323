// What a cell adds up of the samples of a pixel.
#pragma once

#include <array>
#include <cstdint>

#include "model/numbers/arithmetic.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// With `sample_until`, a pixel's samples of which so many decide whether the others are sent.
constexpr int first_samples = 4;

/// Whether the first samples of a pixel may be all of them.
inline bool may_stop_early(const PictureSettings& settings) {
    return settings.sample_until >= 0 && settings.samples > first_samples;
}

/// The sum of a pixel's intensities: an integer of the intensity's last place, 6 bits longer than a word, so
/// that nothing is rounded and no order of the answers matters. In exact arithmetic its last place is 2^-40, and
/// intensities count up to 2^22.
class PixelSum {
  public:
    void add(const dvec3& intensity, const Arithmetic& arithmetic);
    int count() const { return count_; }
    /// Whether no two of the samples differ by more than `within` in any component.
    bool agrees(double within, const Arithmetic& arithmetic) const;
    /// The sum over the count, rounded to the intensity's format.
    dvec3 mean(const Arithmetic& arithmetic) const;

  private:
    std::array<__int128, 3> sum_{};
    std::array<std::int64_t, 3> least_{};
    std::array<std::int64_t, 3> most_{};
    int count_ = 0;
};

/// Whether a pixel with this sum needs no further sample.
bool is_complete(const PixelSum& sum, const PictureSettings& settings, const Arithmetic& arithmetic);

}  // namespace raycell
