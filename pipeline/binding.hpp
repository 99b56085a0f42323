// What binds a phase: the unit or link that was at work for most of its cycles, or the longest tree of rays.
// No such phase can be shorter.
#pragma once

#include <string>

#include "cells/clock/scheduler.hpp"
#include "model/tracing/ray.hpp"

namespace raycell {

struct MachineParts;

struct Binding {
    enum class Unit : std::uint32_t {
        none,
        geometry,
        precomputation,
        feed_link,
        distributor,
        row_link,
        cell_link,
        loading_unit,
        traversal_unit,
        shading_unit,
        exterior,
        exterior_link,
        tree  ///< of a pixel, alone in the machine: no trace is shorter than its longest tree
    };
    Unit unit = Unit::none;
    std::int32_t x = -1;
    std::int32_t y = -1;
    Side side = Side::east;  ///< of a cell's link
    Cycle cycles = 0;        ///< at work

    /// Takes the other if it was at work for longer; of equals the first by unit, row and column.
    void consider(const Binding& other);
};
/// "traversal unit of cell (3, 7)"; "nothing" if nothing was at work.
std::string name_of(const Binding& binding);

/// Of the parts here, up to now; to be called when loading is over, before the links' statistics are reset.
Binding binding_of_load(const MachineParts& parts);
/// Of precast and trace. The exterior counts with the mean of its processors.
Binding binding_of_trace(const MachineParts& parts);

}  // namespace raycell
