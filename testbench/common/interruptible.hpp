// SIGINT, SIGTERM and SIGHUP end a machine's run, not the program: the results so far are written.
#pragma once

#include <exception>

#include "pipeline/machine.hpp"
#include "testbench/common/signals.hpp"

namespace raycell {

/// While it lives, the first signal ends the run and a second one the program. Keep it until the results are
/// published.
class Interruptible {
  public:
    explicit Interruptible(Machine& machine) { machine.interrupt_by(noted_signal()); }

  private:
    NotedSignals noted_;
};

/// A signal cut short the work after the machine's run.
struct Interrupted : std::exception {};

/// Throws Interrupted if a signal was noted.
inline void stop_if_interrupted() {
    if (*noted_signal()) throw Interrupted();
}

}  // namespace raycell
