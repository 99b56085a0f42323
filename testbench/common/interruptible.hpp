// SIGINT and SIGTERM end a machine's run, not the program: what there is so far gets written.
#pragma once

#include <exception>

#include "pipeline/machine.hpp"
#include "testbench/common/signals.hpp"

namespace raycell {

/// While it lives, until its results are published. A second signal ends the program at once.
class Interruptible {
  public:
    explicit Interruptible(Machine& machine) { machine.interrupt_by(noted_signal()); }

  private:
    NotedSignals noted_;
};

/// What comes after the machine's run was cut short by a signal.
struct Interrupted : std::exception {};

/// Throws Interrupted if a signal was noted.
inline void stop_if_interrupted() {
    if (*noted_signal()) throw Interrupted();
}

}  // namespace raycell
