// SIGINT and SIGTERM end a machine's run, not the program: what there is so far gets written.
#pragma once

#include <csignal>

#include "pipeline/machine.hpp"

namespace raycell {

/// While it lives. One at a time; a second signal ends the program at once, as signals usually do.
class Interruptible {
  public:
    explicit Interruptible(Machine& machine);
    ~Interruptible();
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;

  private:
    Machine& machine_;
    struct sigaction old_interrupt_ {};
    struct sigaction old_terminate_ {};
};

}  // namespace raycell
