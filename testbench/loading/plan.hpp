// What each unit and link of the pipeline must do to load a scene, found without simulating time: which
// messages, in which order, and how many cycles they take at least.
#pragma once

#include <cstdint>
#include <vector>

#include "cells/channels/message.hpp"
#include "model/loading/loading.hpp"
#include "testbench/loading/layout.hpp"

namespace raycell::loading {

/// For a unit: messages taken (geometry: sent) and cycles of its work. For a link: messages and cycles of its
/// wires.
struct Need {
    std::uint64_t messages = 0;
    std::uint64_t cycles = 0;  ///< of a cell: looking at messages and passing them on
    /// Of a cell: making voxels, by all its units. Goes on beside `cycles`, so the cell needs the larger of
    /// the two, not the sum.
    std::uint64_t making = 0;
    void add(std::uint64_t count, std::uint64_t cycles_each) {
        messages += count;
        cycles += count * cycles_each;
    }
};

/// What the geometry and the precomputation of one lane do.
struct LanePlan {
    std::vector<std::uint32_t> geometry_work;  ///< cycles of work for each message that geometry sends
    std::vector<std::uint64_t> polygons;       ///< digest_of() each message that geometry sends, in order
    std::vector<std::uint64_t> trapezes;       ///< the same for precomputation
};

struct LoadPlan {
    Layout layout;
    std::vector<Need> units;
    std::vector<Need> links;
    std::vector<LanePlan> lanes;
    std::vector<std::vector<std::uint64_t>> rows;  ///< digests, for each row's distributor, to the east
    std::uint32_t voxel_cycles = 0;                ///< in which a unit of a cell makes a voxel
    int loading_units = 1;                         ///< of a cell
    /// By cell, row-major: for each span that makes a voxel there, the lines of the index table that were
    /// read to put it in order.
    std::vector<std::vector<std::uint32_t>> lines;
    LoadCounts counts;                ///< of the scene; voxels and overflow are not counted here
    std::uint64_t sent_polygons = 0;  ///< once for each lane that gets them
    std::uint64_t sent_trapezes = 0;

    /// A lower bound on the cycles of loading, and what sets it.
    struct Bound {
        std::string of;
        std::uint64_t cycles = 0;
    };
    Bound longest_way;  ///< of a span that never waits, from geometry to the voxel in its last cell
    /// The unit or link that needs most cycles; a cell makes voxels and looks at messages at the same time.
    Bound busiest() const;
    /// The larger of the two.
    Bound bound() const;
};

LoadPlan plan_loading(const CellScene& scene, const PictureSettings& picture, const MachineSettings& machine);

/// A digest of everything that a load message carries. Messages that differ in a bit have the same digest
/// with a probability of 2^-64.
std::uint64_t digest_of(const LoadItem& item);

}  // namespace raycell::loading
