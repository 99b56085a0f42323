#include "testbench/raycell/interruptible.hpp"

namespace raycell {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) { interrupted = 1; }

}  // namespace

Interruptible::Interruptible(Machine& machine) : machine_(machine) {
    struct sigaction action {};
    action.sa_handler = interrupt;
    action.sa_flags = int(SA_RESETHAND);  // the next one finds the usual way
    sigaction(SIGINT, &action, &old_interrupt_);
    sigaction(SIGTERM, &action, &old_terminate_);
    machine.interrupt_by(&interrupted);
}

Interruptible::~Interruptible() {
    machine_.interrupt_by(nullptr);
    sigaction(SIGINT, &old_interrupt_, nullptr);
    sigaction(SIGTERM, &old_terminate_, nullptr);
}

}  // namespace raycell
