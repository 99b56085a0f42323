// A host of one cell: an sc_module with its own SC_METHOD and FIFO ports, for waveforms, probes and exchange
// with a user's own module.
#pragma once

#include <memory>
#include <systemc>
#include <vector>

#include "cells/hosts/cell_ports.hpp"
#include "cells/hosts/link_relay.hpp"
#include "cells/hosts/prefetch.hpp"

namespace raycell {

/// The ports may be bound to any channels that implement their interfaces.
class CellModule : public CellPorts, public CellHost {
  public:
    SC_HAS_PROCESS(CellModule);
    /// Runs a cell of the caller's, which must outlive it.
    CellModule(sc_core::sc_module_name name, Environment& environment, Cell& cell);
    /// Runs a cell of its own.
    CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y);

    /// All cells of a cycle are activated before the first of them runs, so their memory is prefetched here.
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
    std::unique_ptr<Cell> own_;  ///< null: the caller owns the cell
    Cell& cell_;
    sc_core::sc_event wake_;
    std::vector<std::unique_ptr<InputRelay>> input_relays_;  ///< for channels other than Link
    std::vector<std::unique_ptr<Link>> output_relays_;
    std::vector<const sc_core::sc_event*> channel_events_;
};

}  // namespace raycell
