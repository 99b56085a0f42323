#include "testbench/common/cell_ranges.hpp"

#include <algorithm>

#include "testbench/common/options.hpp"

namespace raycell {

void check_inside(const std::string& option, const std::vector<CellRange>& ranges,
                  const PictureSettings& picture) {
    for (const CellRange& range : ranges) {
        if (range.x1 < picture.width && range.y1 < picture.height) continue;
        throw UsageError(option + ": cell (" + std::to_string(range.x1) + ", " + std::to_string(range.y1) +
                         ") lies outside the array; expected x from 0 to " +
                         std::to_string(picture.width - 1) + ", y from 0 to " +
                         std::to_string(picture.height - 1));
    }
}

std::vector<const Cell*> cells_in(const std::vector<CellRange>& ranges, const Array& array) {
    std::vector<const Cell*> cells;
    for (const Cell& cell : array.cells()) {
        if (std::any_of(ranges.begin(), ranges.end(),
                        [&](const CellRange& range) { return range.contains(cell.x(), cell.y()); })) {
            cells.push_back(&cell);
        }
    }
    return cells;
}

}  // namespace raycell
