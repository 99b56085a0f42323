// A host: one sc_module with its own SC_METHOD and FIFO ports for one cell, for waveforms, probes and
// exchange with a user's own module.
#pragma once

#include <memory>
#include <systemc>
#include <vector>

#include "cells/hosts/cell_ports.hpp"
#include "cells/hosts/link_relay.hpp"
#include "cells/hosts/prefetch.hpp"

namespace raycell {

/// Its ports may be bound to any channels of their interfaces.
class CellModule : public CellPorts, public CellHost {
  public:
    SC_HAS_PROCESS(CellModule);
    /// Runs a cell of somebody else's, who must keep it.
    CellModule(sc_core::sc_module_name name, Environment& environment, Cell& cell);
    /// Runs a cell of its own.
    CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y);

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
    Link* link_of(Port<LinkIn>& port);
    Link* link_of(Port<LinkOut>& port);
    void run();
    void ring() { wake_.notify(); }

    Environment& environment_;
    std::unique_ptr<Cell> own_;  ///< null: somebody else's
    Cell& cell_;
    sc_core::sc_event wake_;
    std::vector<std::unique_ptr<InputRelay>> input_relays_;  ///< for channels that are no Links
    std::vector<std::unique_ptr<Link>> output_relays_;
    std::vector<const sc_core::sc_event*> channel_events_;
};

}  // namespace raycell
