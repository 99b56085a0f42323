#include "cells/cell_tile.hpp"

namespace raycell {
namespace {

/// A cell that has not run for a while is in no cache, and which cells run next is known: so their memory is
/// asked for some cells ahead, and that of their links once the cells have come.
constexpr std::size_t cells_ahead = 8;
constexpr std::size_t links_ahead = 4;

void fetch(const Cell& cell) {
    constexpr std::size_t line = 64;
    constexpr std::size_t lines = 6;  // what every step looks at comes first in a cell
    const char* at = reinterpret_cast<const char*>(&cell);
    for (std::size_t i = 0; i < lines; ++i) __builtin_prefetch(at + i * line, 1);
}

void fetch_links(const Cell& cell) {
    for (int side = 0; side < side_count; ++side) {
        for (const Link* link : {cell.input(Side(side)), cell.output(Side(side))}) {
            const char* at = reinterpret_cast<const char*>(link);
            __builtin_prefetch(at, 1);
            __builtin_prefetch(at + sizeof(Link) - 1, 1);
        }
    }
}

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
        if (i + cells_ahead < active_.size()) fetch(*active_[i + cells_ahead]);
        if (i + links_ahead < active_.size()) fetch_links(*active_[i + links_ahead]);
        const Cycle next = active_[i]->step(now);
        if (next != never) scheduler.wake(*active_[i], next);
    }
    active_.clear();
}

}  // namespace raycell
