// How a run ended: its verdict, the proof, and what was stuck.
#pragma once

#include "pipeline/joined.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

/// Looks at a machine in which nobody has anything to do any more, or that was stopped.
class Judge {
  public:
    /// `totals`: what all ranks have counted.
    Judge(MachineParts& parts, const Joined& joined, const Counters& totals)
        : parts_(parts), joined_(joined), totals_(totals) {}

    /// Whether the phase has done all that it had to.
    bool phase_complete() const;
    /// Of a phase that has not: writes verdict, wait-for graph, knots and report. Throws std::logic_error if
    /// the model is at fault: a cell that could move was not woken, or what stands still has no knot.
    void judge(bool interrupted, RunResult& result);

  private:
    Verdict verdict_of(bool locked);
    bool buffers_empty() const;
    void expect_no_work();
    std::vector<std::string> stuck_report() const;

    MachineParts& parts_;
    const Joined& joined_;
    const Counters& totals_;
};

/// Cells, (x, y), in which something stands: those with the oldest messages first, `most` at most.
std::vector<std::pair<int, int>> blocked_cells(const Array& array, std::size_t most);

}  // namespace raycell
