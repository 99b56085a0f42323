// A host: one sc_module with its own SC_METHOD and FIFO ports for one cell, for waveforms, probes and
// exchange with a user's own module.
#pragma once

#include <memory>
#include <systemc>

#include "cells/hosts/prefetch.hpp"

namespace raycell {

/// Ports are bound to links (cells/channels/link.hpp); those over the array's border may stay unbound.
class CellModule : public sc_core::sc_module, public CellHost {
  public:
    template <typename Interface>
    using Port = sc_core::sc_port<Interface, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

    SC_HAS_PROCESS(CellModule);
    /// Runs a cell of somebody else's, who must keep it.
    CellModule(sc_core::sc_module_name name, Environment& environment, Cell& cell);
    /// Runs a cell of its own.
    CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y);

    sc_core::sc_vector<Port<LinkIn>> in;    ///< by Side
    sc_core::sc_vector<Port<LinkOut>> out;  ///< by Side
    Port<LinkIn> load_in;                   ///< from the row's distributor (first column only)

    /// All that run in a cycle are woken before the first of them runs: time to ask for their memory.
    void activate(Cell& cell) override {
        Prefetch::cell(&cell);
        Prefetch::links(cell);
        wake_.notify();
    }
    void foresee(const Cell& cell) const override { Prefetch::links(cell); }
    Cell& cell() { return cell_; }
    const Cell& cell() const { return cell_; }

  private:
    void end_of_elaboration() override;
    void run();

    Environment& environment_;
    std::unique_ptr<Cell> own_;  ///< null: somebody else's
    Cell& cell_;
    sc_core::sc_event wake_;
};

}  // namespace raycell
