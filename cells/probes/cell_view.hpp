// What probes see of a cell: the states of its units, and why messages wait. docs/use/probes.md lists the
// values.
#pragma once

#include "cells/cell.hpp"

namespace raycell {

struct UnitView {
    enum class State : std::uint8_t {
        idle,
        busy,
        blocked  ///< done, but its message can't leave yet
    };
    enum class Operation : std::uint8_t {
        none,
        walk,        ///< traversal: the next crossing only, no voxel to compare
        compare,     ///< traversal: voxels compared with the ray
        set_up,      ///< shading: point, normal and children's directions of a slot
        shade,       ///< shading: intensity of a slot
        direct,      ///< shading: set_up and shade, for a hit that needs no slot
        make_voxel,  ///< loading: from a span
        pass_on      ///< loading: a message for later cells, or one to latch
    };
    State state = State::idle;
    Operation operation = Operation::none;
    std::uint64_t ray = no_ray;  ///< id of the ray in the unit
    static constexpr std::uint64_t no_ray = ~std::uint64_t(0);
};

/// A cell at the end of cycle `now`, the last one run. Causes are those that the cell itself found when it
/// last looked.
class CellView {
  public:
    CellView(const Cell& cell, Cycle now) : cell_(cell), env_(cell.environment()), now_(now) {}

    /// What the oldest message of a buffer waits for; `in` is one of the cell's inputs.
    Stall stall_of(const Link& in, int index) const;
    /// What a ray in this cell waits for: a ray in a buffer, the own ray or a slot's child.
    Stall stall_of(const RayPacket& packet) const;
    /// What a slot's child or its reply waits for.
    Stall stall_of(const Slot& slot) const;
    UnitView traversal_unit(std::size_t unit) const;
    UnitView shading_unit() const;
    UnitView loading_unit() const;

  private:
    Stall stall_of_answer(const Answer& answer) const;

    const Cell& cell_;
    const Environment& env_;
    Cycle now_;
};

}  // namespace raycell
