#include "cells/cell_tile.hpp"

namespace raycell {

CellTile::CellTile(sc_core::sc_module_name name, Environment& environment)
    : sc_module(name), environment_(environment) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

void CellTile::run() {
    Scheduler& scheduler = environment_.scheduler;
    const Cycle now = scheduler.now();
    for (Cell* cell : active_) {
        const Cycle next = cell->step(now);
        if (next != never) scheduler.wake(*cell, next);
    }
    active_.clear();
}

}  // namespace raycell
