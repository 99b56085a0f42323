// The traffic that every case of the benchmark carries: each cell sends a ray, which hits after some cells or
// ends at the border; its answer goes home.
#pragma once

#include <cstdint>
#include <memory>

#include "cells/environment.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell::bench {

/// Measurements of one case. All cases of one array make the same hops: the same rays, cell by cell.
struct Measured {
    double seconds = 0;         ///< of tracing
    std::uint64_t hops = 0;     ///< of rays and answers, cell to cell
    std::uint64_t cycles = 0;   ///< simulated; 0: the case has none
    double build_seconds = 0;   ///< of construction and, but for `sc_fifo`, elaboration
    double bytes_per_cell = 0;  ///< once constructed; 0: the case has no cells
};

/// Scene, draws and settings of a square array.
class Traffic {
  public:
    explicit Traffic(int side);

    /// An environment in which tracing is about to begin.
    std::unique_ptr<Environment> environment(Scheduler& scheduler, Picture& picture) const;
    int side() const { return side_; }

  private:
    int side_;
    SyntheticTraffic draws_;
    PictureSettings picture_;
    CellScene scene_;
};

/// Whether a ray goes on to another cell; otherwise an answer takes its place.
bool goes_on(const Environment& environment, const Visit& visit, int x, int y);
/// The side over which an answer goes on; the cell must not be its home.
Side way_home(const Answer& answer, int x, int y);

/// Processor time of the process so far, in seconds. With one thread it equals the wall time on an idle
/// machine and is nearly the same on a busy one.
double clock_seconds();
/// Resident memory of the process, bytes.
double resident_bytes();

}  // namespace raycell::bench
