// The common base of the stages before the array and of the exterior: woken by the scheduler, with a
// throughput and a utilisation.
#pragma once

#include <systemc>

#include "cells/channels/link.hpp"
#include "cells/deadlock/cell_waits.hpp"
#include "cells/passing.hpp"

namespace raycell {

struct StageStatistics {
    std::uint64_t items = 0;        ///< polygons, trapezes or spans sent; in the exterior, rays taken
    std::uint64_t busy_cycles = 0;  ///< at work, without waits for room downstream
    StageStatistics& operator+=(const StageStatistics& other) {
        items += other.items;
        busy_cycles += other.busy_cycles;
        return *this;
    }
};

/// What every stage has, whichever process runs it.
class StageWork : public Client {
  public:
    explicit StageWork(Environment& environment) : environment_(environment) {}
    /// Statistics up to now; an operation that is still going on counts with the cycles that are over.
    StageStatistics statistics() const {
        StageStatistics so_far = statistics_;
        const Cycle now = environment_.scheduler.now();
        if (busy_until_ > now) so_far.busy_cycles -= busy_until_ - now;
        return so_far;
    }
    /// Restores the statistics of a saved stage, with which this one goes on.
    void restore(const StageStatistics& statistics) { statistics_ = statistics; }
    /// Runs the cycle of the scheduler, and asks to be woken again when that is needed.
    void run() {
        const Cycle next = step(environment_.scheduler.now());
        if (next != never) environment_.scheduler.wake(*this, next);
    }

  protected:
    /// Runs one cycle. Returns the next cycle in which the stage must run without being woken; `never` if
    /// there is none.
    virtual Cycle step(Cycle now) = 0;
    Environment& environment() { return environment_; }
    const Environment& environment() const { return environment_; }
    /// Counts an operation of `cycles` cycles that begins now.
    void work(Cycle now, Cycle cycles) {
        statistics_.busy_cycles += cycles;
        busy_until_ = now + cycles;
    }
    StageStatistics statistics_;

  private:
    Environment& environment_;
    Cycle busy_until_ = 0;
};

/// A stage that is a module with a process of its own.
class Stage : public sc_core::sc_module, public StageWork {
  public:
    SC_HAS_PROCESS(Stage);
    Stage(sc_core::sc_module_name name, Environment& environment) : sc_module(name), StageWork(environment) {
        SC_METHOD(run);
        sensitive << wake_;
        dont_initialize();
    }
    void activate() override { wake_.notify(); }

  private:
    void run() { StageWork::run(); }
    sc_core::sc_event wake_;
};

}  // namespace raycell
