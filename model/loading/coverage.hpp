// Which edges of a span cross a voxel's run, and which of its 8x8 sub-cells the polygon touches.
#pragma once

#include <array>
#include <cstdint>

#include "model/loading/part.hpp"

namespace raycell {

constexpr int window_steps = 32;

/// What a span's edges and a cell's part of the polygon say of a voxel.
struct Coverage {
    bool touched = true;            ///< false: the polygon only touches the run's box
    std::array<int, 4> crossing{};  ///< which edges cross the run
    int crossings = 0;
    std::uint64_t mask = 0;  ///< as in Voxel, only if asked for
    std::array<std::uint8_t, 4> window{0, window_steps, 0, window_steps};
};

/// `near`, `far`: the voxel's run. Both edges and sub-cells count with the tolerance of hit tests: watertight
/// first.
Coverage cover(const PartBounds& bounds, const Part& part, double near, double far, bool with_mask,
               const Arithmetic& arithmetic);

}  // namespace raycell
