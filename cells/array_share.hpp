// Which rows of an array a process simulates.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace raycell {

class SplitLinks;

/// Adjacent rows of cells, `first` to `end` - 1.
struct Band {
    int first = 0;
    int end = 0;
    SplitLinks* above = nullptr;  ///< links to the owner of row `first` - 1; null at the array's border
    SplitLinks* below = nullptr;  ///< links to the owner of row `end`; null at the array's border
};

/// The part of an array that this process simulates. Other ranks simulate the other rows; the links to them
/// are half links.
class ArrayShare {
  public:
    /// A whole array of `height` rows.
    explicit ArrayShare(int height) : ArrayShare(height, {{0, height, nullptr, nullptr}}) {}
    /// These bands, from the top down, of an array of `height` rows.
    ArrayShare(int height, std::vector<Band> bands) : bands_(std::move(bands)) {
        places_.assign(std::size_t(height), -1);
        for (const Band& band : bands_) {
            for (int y = band.first; y < band.end; ++y) {
                places_.at(std::size_t(y)) = int(rows_.size());
                rows_.push_back(y);
            }
        }
    }

    const std::vector<Band>& bands() const { return bands_; }
    /// The band that begins at row y; null if there is none.
    const Band* band_at(int y) const {
        for (const Band& band : bands_) {
            if (band.first == y) return &band;
        }
        return nullptr;
    }
    /// All its rows, from the top down.
    const std::vector<int>& rows() const { return rows_; }
    /// Whether row y is simulated here; y may lie beyond the array.
    bool contains(int y) const { return y >= 0 && std::size_t(y) < places_.size() && place(y) >= 0; }
    /// The index of row y in rows(); -1 if it is another rank's.
    int place(int y) const { return places_[std::size_t(y)]; }

  private:
    std::vector<Band> bands_;
    std::vector<int> rows_;
    std::vector<int> places_;  ///< by row of the array; -1: another rank's
};

}  // namespace raycell
