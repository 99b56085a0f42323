// When a postponed ray is sent again (paper, section 4.2).
#pragma once

#include <cstdint>

#include "cells/clock/scheduler.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// A back-off that doubles with each attempt, up to six times. Its jitter keeps rays that were refused
/// together from coming back together.
class Retry {
  public:
    /// Cycles until the next attempt: backoff · 2^min(attempt, 6), plus a jitter below that value, a hash of
    /// the seed, the ray and the attempt.
    static Cycle backoff(const MachineSettings& machine, std::uint64_t ray, unsigned attempt);

    /// When a primary ray is sent for the first time, cycles after the phase's beginning: a hash of the seed
    /// and the ray, below machine.start_within.
    static Cycle first_start(const MachineSettings& machine, std::uint64_t ray);

    void wait_until(Cycle at) { at_ = at; }
    void postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now);
    Cycle at() const { return at_; }  ///< first cycle in which the ray may be sent again
    unsigned attempts() const { return attempts_; }

  private:
    static constexpr std::uint8_t most_attempts = 250;  ///< the count saturates here
    Cycle at_ = 0;
    std::uint8_t attempts_ = 0;
};

}  // namespace raycell
