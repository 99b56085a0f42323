// Cells named on the command line: --probe, --golden.
#pragma once

#include <string>
#include <vector>

#include "cells/hosts/array.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// Throws UsageError for a range that reaches outside the array; `option` as "--probe".
void check_inside(const std::string& option, const std::vector<CellRange>& ranges,
                  const PictureSettings& picture);

/// The cells of all ranges, row by row, each once.
std::vector<const Cell*> cells_in(const std::vector<CellRange>& ranges, const Array& array);

}  // namespace raycell
