// Retrying: when a ray that was postponed is sent again (paper, section 4.2).
#pragma once

#include <cstdint>

#include "cells/clock/scheduler.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// A back-off that doubles with each attempt up to six times, with jitter: else rays that were refused
/// together come back together.
class Retry {
  public:
    /// Cycles until the next attempt: backoff · 2^min(attempt, 6), and up to as much again by a hash of the
    /// seed, the ray and the attempt.
    static Cycle backoff(const MachineSettings& machine, std::uint64_t ray, unsigned attempt);

    void postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now);
    Cycle at() const { return at_; }  ///< not before this cycle
    unsigned attempts() const { return attempts_; }

  private:
    static constexpr std::uint8_t most_attempts = 250;  ///< counted, not allowed
    Cycle at_ = 0;
    std::uint8_t attempts_ = 0;
};

}  // namespace raycell
