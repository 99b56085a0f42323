// Collects the counts of a run at its end.
#pragma once

#include "pipeline/joined.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

class Results {
  public:
    /// `totals`: the counters summed over all ranks.
    Results(const MachineParts& parts, const Joined& joined, const Counters& totals)
        : parts_(parts), joined_(joined), totals_(totals) {}

    /// The messages in the machine now, counted in their places.
    InFlight in_flight() const;
    /// Checks that every message sent has ended or is still in the machine, however the run ended; throws
    /// std::logic_error if not. `completed`: none may be left.
    void check_conservation(const InFlight& there, bool completed) const;
    /// Fills in all results but the verdict, the cycles and the measurements of single phases.
    void collect(RunResult& result) const;
    /// Peak and mean occupancy of one buffer class over the array's links since their last reset; the mean is
    /// over `cycles` cycles.
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
