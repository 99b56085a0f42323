// A cell during loading: spans and broadcast messages pass through it from west to east.
#include "cells/cell.hpp"

namespace raycell {

void Cell::step_load(Cycle now) {
    if (!load_in_) return;
    const auto kind =
        pass_load(loading_, *load_in_, router_.link(Side::east), store_, env_, meter_, x_, wakeup_);
    if (kind) record(now, CellEvent::load, std::uint32_t(*kind), 0, std::uint32_t(*kind));
}

}  // namespace raycell
