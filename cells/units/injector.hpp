// The injector: the register from which the cell's own rays are sent, one at a time (design, section 6). In
// phase trace this is the primary ray of its pixel, sent again if it was postponed; in phase precast, the
// precast rays of its voxels.
#pragma once

#include <optional>

#include "cells/channels/message.hpp"
#include "cells/units/retry.hpp"
#include "cells/units/wakeup.hpp"

namespace raycell {

class Injector {
  public:
    /// Begins a phase; `traces`: the pixel's primary ray must be sent in it, from cycle `start` on.
    void begin_phase(bool traces, Cycle start = 0) {
        primary_to_send_ = traces;
        retry_.wait_until(start);
        precast_next_ = 0;
    }

    /// The own ray that waits to leave; null if the register is free.
    RayPacket* ray() const { return ray_; }
    void load(RayPacket& packet) { ray_ = &packet; }
    void left() { ray_ = nullptr; }

    /// Whether the primary ray must still be sent, for the first time or again, now or later.
    bool primary_to_send() const { return primary_to_send_; }
    /// Whether the primary ray may be sent now. If only later, asks for a step in that cycle.
    bool primary_due(Cycle now, Wakeup& wakeup) const;
    /// Notes that the primary ray was sent; true the first time.
    bool primary_sent();
    void primary_postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now);
    void primary_answered() { primary_awaited_ = false; }
    /// Whether the pixel's intensity is still missing or an own ray stands in the register.
    bool unfinished() const { return primary_to_send_ || primary_awaited_ || ray_; }

    /// The voxel and the source of the next precast ray; each pair comes once in a phase.
    struct Precast {
        std::uint32_t voxel;
        std::size_t source;
    };
    std::optional<Precast> next_precast(std::size_t voxels, std::size_t sources);

  private:
    RayPacket* ray_ = nullptr;
    Retry retry_;
    std::uint64_t precast_next_ = 0;  ///< voxel · sources + source
    bool primary_to_send_ = false;
    bool primary_awaited_ = false;
};

}  // namespace raycell
