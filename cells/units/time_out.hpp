// A deadlock detector that a chip could have: a time-out in each cell (design, section 5).
#pragma once

#include <array>
#include <cstdint>

#include "cells/clock/scheduler.hpp"
#include "cells/memory/pool.hpp"

namespace raycell {

/// Counts the cycles in which a cell holds a message that can't move while nothing else in the cell moves
/// either; any movement restarts the count. A detector with time-out T raises an alarm in the T-th cycle. The
/// model keeps the lengths of all such waits, so that one run gives the result for every T.
class TimeOut {
  public:
    /// The time-outs are the powers of two from 2^least_log to 2^most_log cycles.
    static constexpr int least_log = 4;
    static constexpr int most_log = 20;
    /// Ended waits by length: entry i for 2^(least_log + i) cycles and more, below the next entry's length.
    struct Counts {
        std::array<std::uint32_t, most_log - least_log + 1> ended{};
    };

    /// To be called at the end of each cycle in which the cell ran; between such cycles nothing changes.
    /// `counts` must outlive this object.
    void step(bool moved, bool blocked, Cycle now, Pool<Counts>& counts) {
        if (since_ != never && (moved || !blocked)) {
            count(now - since_, counts);
            since_ = never;
        }
        if (blocked && since_ == never) since_ = now;
    }
    /// Number of ended waits of at least 2^log cycles: each would have been an alarm.
    std::uint64_t ended(int log) const {
        if (!ended_) return 0;
        std::uint64_t sum = 0;
        for (int i = log; i <= most_log; ++i) sum += ended_->ended[std::size_t(i - least_log)];
        return sum;
    }
    /// First cycle of the current wait; `never` if the cell does not wait.
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
