// A host of a block of cells: one sc_module with one SC_METHOD, for large arrays.
#pragma once

#include <systemc>
#include <vector>

#include "cells/hosts/prefetch.hpp"

namespace raycell {

/// Runs each cell of a list once, in the scheduler's cycle, and enters the next cycle in which it must run.
/// Prefetches the memory of cells farther down the list.
void run_cells(const std::vector<Cell*>& cells, Environment& environment, const Prefetch& prefetch);

/// Runs those of its cells that the scheduler has woken; the others cost nothing. Its cells call their links
/// directly, without ports.
class CellTile : public sc_core::sc_module, public CellHost {
  public:
    SC_HAS_PROCESS(CellTile);
    /// `prefetch` must outlive it.
    CellTile(sc_core::sc_module_name name, Environment& environment, const Prefetch& prefetch);

    void activate(Cell& cell) override {
        if (active_.empty()) wake_.notify();
        active_.push_back(&cell);
    }
    void foresee(const Cell& cell) const override { Prefetch::links(cell); }

  private:
    void run();

    Environment& environment_;
    const Prefetch& prefetch_;
    std::vector<Cell*> active_;  ///< cells to run in this cycle
    sc_core::sc_event wake_;
};

}  // namespace raycell
