// Golden vectors of the traversal unit alone: a cell's voxels, the rays that it tests, and what it decides
// (docs/reference/cell_tb.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "testbench/golden/file.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {

/// "voxel INDEX FIELDS" for each voxel of a store.
std::string voxel_lines(const Words& words, const CellStore& store);

/// Adds a voxel that was written so. Throws GoldenError naming the field.
void read_voxel(const Words& words, const std::vector<std::string>& tokens, CellStore& store);

/// The inputs of a test beside the ray.
struct TraversalSetting {
    const CellStore& store;
    const Context& context;
    const MachineSettings& machine;
    int x;
    int y;
};
/// What the unit decides about a ray: "CYCLES RUNS TESTS EDGES DECISION FIELDS".
std::string decision_of(const Words& words, const TraversalSetting& setting, const Ray& ray,
                        const Visit& visit);

struct TraversalReplay {
    std::vector<std::string> failures;  ///< a line each, `most` at most
    std::size_t tests = 0;
};
/// What a file's rays do, one after the other.
using TestObserver = std::function<void(const TraversalSetting&, const Ray&, const Visit&)>;
/// Tests all rays of a file again and compares the decisions. Throws GoldenError for lines that make no
/// sense.
TraversalReplay replay_traversal(const GoldenFile& file, const CellSetup& setup, std::size_t most = 10,
                                 const TestObserver& observer = {});

}  // namespace raycell
