// What a run has counted, once it has ended.
#pragma once

#include "pipeline/joined.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

class Results {
  public:
    /// `totals`: what all ranks have counted.
    Results(const MachineParts& parts, const Joined& joined, const Counters& totals)
        : parts_(parts), joined_(joined), totals_(totals) {}

    /// Messages that are there now, counted where they stand.
    InFlight in_flight() const;
    /// What was sent has come home or is still there, however the run ended; else throws std::logic_error.
    void check_conservation(const InFlight& there, bool completed) const;
    /// All but verdict, cycles and what was measured phase by phase.
    void collect(RunResult& result) const;
    /// Peak and mean of one class over the array's links since their last reset.
    RunResult::BufferUse buffer_use(const char* buffer_class, int index, Cycle cycles) const;

  private:
    void collect_cells(RunResult& result) const;
    void collect_buffers(RunResult& result) const;
    void collect_time_outs(RunResult& result) const;

    const MachineParts& parts_;
    const Joined& joined_;
    const Counters& totals_;
};

}  // namespace raycell
