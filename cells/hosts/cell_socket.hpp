// A place in the array for a cell of somebody else's: the ports of a cell, and an event.
#pragma once

#include <functional>
#include <memory>

#include "cells/hosts/cell_ports.hpp"

namespace raycell {

struct Environment;

/// A module that stands in the array instead of one of its own cells. The array binds its ports. Its process
/// is sensitive to woken() and runs one cycle at a time; for a cycle of its own choice it asks
/// Scheduler::wake(*this, cycle). What it does with messages it must count in Environment::counters, as a
/// Cell does: a run ends when every pixel is done.
class CellSocket : public CellPorts, public Client {
  public:
    using CellPorts::CellPorts;

    /// The environment's phase begins in the next cycle, in which the module is woken.
    virtual void begin_phase() {}
    /// Notified in every cycle in which a message arrives, or in the cycle after room was made behind an
    /// output that had refused one.
    const sc_core::sc_event& woken() const { return woken_; }
    void activate() override { woken_.notify(); }

  private:
    sc_core::sc_event woken_;
};

/// Makes the module for cell (x, y), or null where the array's own cell is to stand.
using CellFactory = std::function<std::unique_ptr<CellSocket>(const char* name, Environment&, int x, int y)>;

}  // namespace raycell
