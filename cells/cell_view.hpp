// What probes may see of a cell: the states of its units and what holds a message back. docs/probes.md lists
// the values.
#pragma once

#include <cstdint>

namespace raycell {

/// What the head of a buffer, the own ray or a slot waits for.
enum class HeadStall : std::uint8_t {
    none,            ///< nothing there, at work on it, or it moves with the next cycle
    traversal_unit,  ///< not yet tested: the unit is at work on another ray
    output_full,     ///< no room in the buffer behind the output
    wires_busy,      ///< the output's wires carry another message
    no_slot,         ///< the ray store has no slot for it (recovery `none`)
    shading_unit,    ///< a hit that needs no slot, and the unit is at work or has other things to do first
    store_port,      ///< the ray store's one write port was used in this cycle
    answer_full,     ///< its answer, or the notice that it is postponed: no room behind the output
    answer_wires     ///< the same: the output's wires carry another message
};
constexpr int stall_count = 9;

struct UnitView {
    enum class State : std::uint8_t {
        idle,
        busy,
        blocked  ///< done, and what it holds can't leave yet
    };
    enum class Operation : std::uint8_t {
        none,
        walk,        ///< traversal: next crossing alone, no voxel to compare with
        compare,     ///< traversal: voxels compared with the ray
        set_up,      ///< shading: point, normal and children's directions of a slot
        shade,       ///< shading: intensity of a slot
        direct,      ///< shading: both for a hit that waits for nothing
        make_voxel,  ///< loading: of a span
        pass_on      ///< loading: a message for cells farther on, or one to latch
    };
    State state = State::idle;
    Operation operation = Operation::none;
    std::uint64_t ray = no_ray;  ///< id of the ray at work on
    static constexpr std::uint64_t no_ray = ~std::uint64_t(0);
};

}  // namespace raycell
