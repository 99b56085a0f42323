// A file of golden vectors, read with all that its head says.
#pragma once

#include <string>

#include "testbench/golden/file.hpp"

namespace raycell {

/// A file of golden vectors, and the cell that it is of.
struct Record {
    GoldenFile file;
    CellSetup setup;
};

/// Throws UsageError for a file that can't be read or is of cells with several primary rays, GoldenError for
/// a wrong line.
Record record_of_file(const std::string& path);

}  // namespace raycell
