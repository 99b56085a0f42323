// The traversal unit's programs and calls as files for hardware.
#pragma once

#include <string>

#include "testbench/cell/visit_calls.hpp"

namespace raycell {

/// All programs of a visit in one memory, with registers of their own. `calls` must outlive it.
MicroImage image_of(const VisitCalls& calls);

/// The sequences of copies and calls, for $readmemh, and the package that names them.
struct VisitFiles {
    std::string copies, calls, package;
};
/// `store_words`: how much the unit's memory of voxels and edges holds; `edges`: the rung has them.
VisitFiles visit_files(const VisitCalls& calls, const MicroImage& image, std::size_t store_words, bool edges);

}  // namespace raycell
