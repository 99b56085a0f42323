#include "cells/cell_tile.hpp"

namespace raycell {
namespace {

// A cell that has not run for a while is in no cache, and which cells run next is known. How many cells ahead
// each part is asked for; each step reads what the one before it brought.
constexpr std::size_t cells_ahead = 16;
constexpr std::size_t links_ahead = 12;
constexpr std::size_t messages_ahead = 8;
constexpr std::size_t ways_ahead = 4;

}  // namespace

CellTile::CellTile(sc_core::sc_module_name name, Environment& environment)
    : sc_module(name), environment_(environment) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

void CellTile::run() {
    Scheduler& scheduler = environment_.scheduler;
    const Cycle now = scheduler.now();
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (i + cells_ahead < active_.size()) active_[i + cells_ahead]->fetch();
        if (i + links_ahead < active_.size()) active_[i + links_ahead]->fetch_links();
        if (i + messages_ahead < active_.size()) active_[i + messages_ahead]->fetch_messages();
        if (i + ways_ahead < active_.size()) active_[i + ways_ahead]->fetch_ways();
        const Cycle next = active_[i]->step(now);
        if (next != never) scheduler.wake(*active_[i], next);
    }
    active_.clear();
}

}  // namespace raycell
