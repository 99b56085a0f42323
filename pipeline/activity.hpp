// A run's activity over time, for charts: a bounded number of buckets of equal width.
#pragma once

#include <vector>

#include "cells/environment.hpp"

namespace raycell {

/// Bucket i covers the cycles [start + i · bucket_cycles, start + (i + 1) · bucket_cycles); the last one ends
/// at `end`.
struct Activity {
    struct Bucket {
        // Levels, summed over cycles: divide by the bucket's cycles for the mean.
        std::uint64_t rays_in_flight = 0;     ///< in buffers, registers, units and the exterior
        std::uint64_t answers_in_flight = 0;  ///< on their way home
        std::uint64_t slots_used = 0;
        // Events in the bucket.
        std::uint64_t hops = 0;  ///< of rays and answers
        std::uint64_t load_hops = 0;
        std::uint64_t pixels_done = 0;
        std::uint64_t cells_loaded = 0;
        std::uint64_t postponed = 0;

        Bucket& operator+=(const Bucket& other);
    };
    Cycle start = 0;
    Cycle end = 0;
    Cycle bucket_cycles = 1;
    std::vector<Bucket> buckets;

    /// Cycles of buckets[index].
    Cycle cycles_of(std::size_t index) const;
};

/// Fills an Activity from a run's counters. Buckets begin with one cycle and double their width whenever
/// there would be more than `most_buckets`, so the run's length need not be known. The counters are sums over
/// all cells, so the order in which cells run does not matter.
class ActivityRecorder {
  public:
    static constexpr std::size_t most_buckets = 200;

    /// Begins to record at cycle `start`. Without `levels` only events are counted, for phases without rays.
    void begin(Cycle start, const Counters& counters, bool levels);
    /// To be called before each cycle `now` that is run: the levels have held since the cycle run before.
    void observe(Cycle now, const Counters& counters) {
        while (now >= bucket_end_) close_bucket(counters);
        if (levels_) extend(now, counters);
    }
    /// `end`: the cycle after the last one.
    void finish(Cycle end, const Counters& counters);
    const Activity& activity() const { return activity_; }

  private:
    void extend(Cycle to, const Counters& c) {
        const Cycle cycles = to - seen_;
        seen_ = to;
        current_.rays_in_flight +=
            cycles * (c.rays_sent - c.rays_answered - c.rays_silent - c.rays_destroyed - c.slots_used);
        current_.answers_in_flight += cycles * (c.answers_sent - c.answers_delivered);
        current_.slots_used += cycles * c.slots_used;
    }
    void close_bucket(const Counters& counters);
    void take_events(const Counters& counters);

    Activity activity_;
    Activity::Bucket current_;
    Activity::Bucket before_;  ///< events before the current bucket
    bool levels_ = true;
    Cycle seen_ = 0;  ///< cycle up to which levels are summed
    Cycle bucket_end_ = 0;
};

}  // namespace raycell
