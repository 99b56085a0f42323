// A place in the array for a user's own cell: the ports of a cell, and an event.
#pragma once

#include <functional>
#include <memory>

#include "cells/hosts/cell_ports.hpp"

namespace raycell {

class Cell;
struct Environment;

/// The base of a user's module that replaces one of the array's cells. The array binds its ports. Its process
/// is sensitive to woken() and runs one cycle at a time; Scheduler::wake(*this, cycle) makes it run in a
/// cycle of its choice. It must count its messages in Environment::meters.counters, as a Cell does: a run
/// ends when every pixel is done.
class CellSocket : public CellPorts, public Client {
  public:
    using CellPorts::CellPorts;

    /// Called once, before the links are bound: the array's own cell of this place, which is never run
    /// by the array. Reports read its meter and its voxels, so a module may keep its books there.
    virtual void replaces(Cell& /*cell*/) {}
    /// The environment's phase begins in the next cycle; the module is woken in it.
    virtual void begin_phase() {}
    /// The primary ray of a pixel of its block is to be sent once more; phase trace is over.
    virtual void begin_tree(int /*pixel*/) {}
    /// Notified in every cycle in which a message arrives, and in the cycle after room was made behind an
    /// output that had refused a message.
    const sc_core::sc_event& woken() const { return woken_; }
    void activate() override { woken_.notify(); }

  private:
    sc_core::sc_event woken_;
};

/// Makes the module for cell (x, y); null where the array's own cell stays.
using CellFactory = std::function<std::unique_ptr<CellSocket>(const char* name, Environment&, int x, int y)>;

}  // namespace raycell
