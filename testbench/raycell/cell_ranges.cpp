#include "testbench/raycell/cell_ranges.hpp"

#include <algorithm>

#include "testbench/raycell/options.hpp"

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

std::vector<CellModule*> cells_in(const std::vector<CellRange>& ranges, Array& array) {
    std::vector<CellModule*> cells;
    for (const auto& module : array.cells()) {
        const Cell& cell = module->cell();
        if (std::any_of(ranges.begin(), ranges.end(),
                        [&](const CellRange& range) { return range.contains(cell.x(), cell.y()); })) {
            cells.push_back(module.get());
        }
    }
    return cells;
}

}  // namespace raycell
