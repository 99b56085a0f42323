// The end of a run: its verdict, the proof, and what is stuck.
#pragma once

#include "pipeline/joined.hpp"
#include "pipeline/run_result.hpp"

namespace raycell {

/// Judges a machine in which no client has work any more, or that was stopped.
class Judge {
  public:
    /// `totals`: the counters summed over all ranks.
    Judge(MachineParts& parts, const Joined& joined, const Counters& totals)
        : parts_(parts), joined_(joined), totals_(totals) {}

    /// Whether the phase has done all its work.
    bool phase_complete() const;
    /// For a phase that is not complete: writes verdict, wait-for graph, knots and report. Throws
    /// std::logic_error if the model is at fault: a cell that could move was not woken, or a run stands still
    /// without a knot.
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

/// At most `most` cells (x, y) that hold messages or rays, those with the oldest messages first.
std::vector<std::pair<int, int>> blocked_cells(const Array& array, std::size_t most);

}  // namespace raycell
