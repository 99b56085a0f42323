// The deadlock detector that a chip could have: a time-out in each cell (design, section 5).
#pragma once

#include <array>
#include <cstdint>

#include "cells/clock/scheduler.hpp"
#include "cells/memory/pool.hpp"

namespace raycell {

/// Counts the cycles in which a cell holds a message that can't move on while nothing else of it moves
/// either; any movement starts it anew. With a time-out of T it gives alarm in the T-th. The model keeps the
/// lengths of all such waits, so that one run tells of every T.
class TimeOut {
  public:
    /// Time-outs that are told apart: powers of two.
    static constexpr int least_log = 4;
    static constexpr int most_log = 20;
    /// Waits by their length: of 2^least_log cycles and more, and so on.
    struct Counts {
        std::array<std::uint32_t, most_log - least_log + 1> ended{};
    };

    /// The end of a cycle in which the cell ran; between such cycles nothing changes. `counts` must outlive
    /// it.
    void step(bool moved, bool blocked, Cycle now, Pool<Counts>& counts) {
        if (since_ != never && (moved || !blocked)) {
            count(now - since_, counts);
            since_ = never;
        }
        if (blocked && since_ == never) since_ = now;
    }
    /// Waits of 2^log cycles and more that came to an end: each would have been an alarm.
    std::uint64_t ended(int log) const {
        if (!ended_) return 0;
        std::uint64_t sum = 0;
        for (int i = log; i <= most_log; ++i) sum += ended_->ended[std::size_t(i - least_log)];
        return sum;
    }
    /// Since when the cell waits; `never` if it doesn't.
    Cycle since() const { return since_; }

  private:
    friend class Prefetch;
    void count(Cycle length, Pool<Counts>& counts) {
        int log = least_log - 1;
        while (log < most_log && length >> (log + 1)) ++log;
        if (log < least_log) return;
        if (!ended_) ended_ = counts.take();
        ++ended_->ended[std::size_t(log - least_log)];
    }
    Cycle since_ = never;
    Counts* ended_ = nullptr;  ///< most cells never wait for long
};

}  // namespace raycell
