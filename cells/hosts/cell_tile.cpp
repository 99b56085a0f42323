#include "cells/hosts/cell_tile.hpp"

namespace raycell {
namespace {

// A cell that has not run for a while is in no cache, and which cells run next is known. How many cells ahead
// each part is asked for; each step reads what the one before it brought.
constexpr std::size_t cells_ahead = 16;
constexpr std::size_t links_ahead = 12;
constexpr std::size_t messages_ahead = 8;
constexpr std::size_t ways_ahead = 4;

}  // namespace

void run_cells(const std::vector<Cell*>& cells, Environment& environment) {
    Scheduler& scheduler = environment.scheduler;
    const Cycle now = scheduler.now();
    const std::size_t count = cells.size();
    // Who runs in the next cycle is mostly known, and asked for behind the last of this one; the first ones
    // are asked for before anything runs. Beyond the last there is none, so below zero, which wraps, neither.
    const std::vector<Client*>& next_cycle = scheduler.foreseen(now + 1);
    for (std::size_t i = 0 - cells_ahead; i != count; ++i) {
        if (i + cells_ahead < count) {
            cells[i + cells_ahead]->fetch();
        } else if (i + cells_ahead - count < next_cycle.size()) {
            Cell::fetch(next_cycle[i + cells_ahead - count]);
        }
        if (i + links_ahead < count) {
            cells[i + links_ahead]->fetch_links();
        } else if (i + links_ahead - count < next_cycle.size()) {
            next_cycle[i + links_ahead - count]->fetch_ahead();
        }
        if (i + messages_ahead < count) cells[i + messages_ahead]->fetch_messages();
        if (i + ways_ahead < count) cells[i + ways_ahead]->fetch_ways();
        if (i >= count) continue;
        const Cycle next = cells[i]->step(now);
        if (next != never) scheduler.wake(*cells[i], next);
    }
}

CellTile::CellTile(sc_core::sc_module_name name, Environment& environment)
    : sc_module(name), environment_(environment) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

void CellTile::run() {
    run_cells(active_, environment_);
    active_.clear();
}

}  // namespace raycell
