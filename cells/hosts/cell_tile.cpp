#include "cells/hosts/cell_tile.hpp"

namespace raycell {
namespace {

// How many cells ahead each part of a cell is prefetched. A cell that has not run for a while is in no cache,
// and the cells that run next are known. Each part reads what the part before it has brought.
constexpr std::size_t cells_ahead = 16;
constexpr std::size_t links_ahead = 12;
constexpr std::size_t messages_ahead = 8;
constexpr std::size_t outputs_ahead = 4;

}  // namespace

void run_cells(const std::vector<Cell*>& cells, Environment& environment, const Prefetch& prefetch) {
    Scheduler& scheduler = environment.scheduler;
    const Cycle now = scheduler.now();
    const std::size_t count = cells.size();
    // Most cells of the next cycle are already known: they are prefetched behind the last cell of this one.
    // `i` starts below zero, so that the first cells are prefetched before any runs: it wraps to values
    // beyond `count`, for which no cell is run.
    const std::vector<Client*>& next_cycle = scheduler.foreseen(now + 1);
    for (std::size_t i = 0 - cells_ahead; i != count; ++i) {
        if (i + cells_ahead < count) {
            Prefetch::cell(cells[i + cells_ahead]);
        } else if (i + cells_ahead - count < next_cycle.size()) {
            Prefetch::cell(next_cycle[i + cells_ahead - count]);
        }
        if (i + links_ahead < count) {
            Prefetch::links(*cells[i + links_ahead]);
        } else if (i + links_ahead - count < next_cycle.size()) {
            next_cycle[i + links_ahead - count]->foreseen();
        }
        if (i + messages_ahead < count) prefetch.messages(*cells[i + messages_ahead]);
        if (i + outputs_ahead < count) prefetch.outputs(*cells[i + outputs_ahead]);
        if (i >= count) continue;
        const Cycle next = cells[i]->step(now);
        if (next != never) scheduler.wake(*cells[i], next);
    }
}

CellTile::CellTile(sc_core::sc_module_name name, Environment& environment, const Prefetch& prefetch)
    : sc_module(name), environment_(environment), prefetch_(prefetch) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

void CellTile::run() {
    run_cells(active_, environment_, prefetch_);
    active_.clear();
}

}  // namespace raycell
