// The traffic that every case of the benchmark carries: each cell sends a ray, which hits after some cells or
// ends at the border; its answer goes home.
#pragma once

#include <cstdint>
#include <memory>

#include "cells/environment.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell::bench {

/// What a case measures. All cases of one array make the same hops: the same rays, cell by cell.
struct Measured {
    double seconds = 0;         ///< of tracing
    std::uint64_t hops = 0;     ///< of rays and answers, cell to cell
    std::uint64_t cycles = 0;   ///< simulated; 0: the case has none
    double build_seconds = 0;   ///< to the end of elaboration
    double bytes_per_cell = 0;  ///< after that, nothing under way; 0: the case has no cells
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

/// What a ray comes to in a cell: it goes on, or an answer takes its place.
bool goes_on(const Environment& environment, const Visit& visit, int x, int y);
/// Where an answer goes on to; call only away from its home.
Side way_home(const Answer& answer, int x, int y);

/// Processor time so far, in seconds: one thread, so the wall time on an idle machine, and nearly the same on
/// a busy one. The process's resident bytes.
double clock_seconds();
double resident_bytes();

}  // namespace raycell::bench
