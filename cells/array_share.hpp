// Which rows of an array a process simulates.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace raycell {

class SplitLinks;

/// Rows of cells next to each other, `end` not included.
struct Band {
    int first = 0;
    int end = 0;
    SplitLinks* above = nullptr;  ///< with whoever has row first - 1; null: that is the array's border
    SplitLinks* below = nullptr;  ///< with whoever has row `end`
};

/// The part of an array that this process simulates. The other rows are other ranks', and the links to them
/// are halves.
class ArrayShare {
  public:
    /// All of an array of so many rows.
    explicit ArrayShare(int height) : ArrayShare(height, {{0, height, nullptr, nullptr}}) {}
    /// Of an array of so many rows these bands, from the top down.
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
    /// The one that begins at row y; null if there is none.
    const Band* band_at(int y) const {
        for (const Band& band : bands_) {
            if (band.first == y) return &band;
        }
        return nullptr;
    }
    /// All its rows, from the top down.
    const std::vector<int>& rows() const { return rows_; }
    /// Any y, also one beyond the array.
    bool contains(int y) const { return y >= 0 && std::size_t(y) < places_.size() && place(y) >= 0; }
    /// Where in rows() row y is.
    int place(int y) const { return places_[std::size_t(y)]; }

  private:
    std::vector<Band> bands_;
    std::vector<int> rows_;
    std::vector<int> places_;  ///< by row of the array; -1: another rank's
};

}  // namespace raycell
