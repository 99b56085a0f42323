// What loading a scene demands of each unit and link of the pipeline, found without time: which messages, in
// which order, and how many cycles they take at least.
#pragma once

#include <cstdint>
#include <vector>

#include "cells/channels/message.hpp"
#include "model/loading/loading.hpp"
#include "testbench/loading/layout.hpp"

namespace raycell::loading {

/// Of a unit: messages taken (geometry: put out), cycles of its work. Of a link: messages, cycles of its
/// wires.
struct Need {
    std::uint64_t messages = 0;
    std::uint64_t cycles = 0;
    void add(std::uint64_t count, std::uint64_t cycles_each) {
        messages += count;
        cycles += count * cycles_each;
    }
};

struct LoadPlan {
    Layout layout;
    std::vector<Need> units;
    std::vector<Need> links;
    std::vector<std::uint32_t> geometry_work;      ///< cycles of each message that geometry puts out
    std::vector<std::uint64_t> polygons;           ///< digest_of() what geometry puts out, in order
    std::vector<std::uint64_t> trapezes;           ///< the same of precomputation
    std::vector<std::vector<std::uint64_t>> rows;  ///< the same of each row's distributor, to the east
    LoadCounts counts;                             ///< voxels and overflow are not counted here

    /// Cycles that loading can't be shorter than, and what says so.
    struct Bound {
        std::string of;
        std::uint64_t cycles = 0;
    };
    Bound longest_way;  ///< from geometry to its last cell, of a span that nothing holds up
    /// The unit or link that needs most cycles.
    Bound busiest() const;
    /// The larger of the two.
    Bound bound() const;
};

LoadPlan plan_loading(const CellScene& scene, const PictureSettings& picture, const MachineSettings& machine);

/// Of everything that a load message carries; two that differ in a bit have different digests but for
/// 2^-64 of chance.
std::uint64_t digest_of(const LoadItem& item);

}  // namespace raycell::loading
