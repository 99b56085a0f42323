// The injector: the register from which the cell's own rays go out, one at a time: the primary ray of its
// pixel, sent again when it was postponed, or before tracing the precast rays of its voxels (design, section
// 6).
#pragma once

#include <optional>

#include "cells/channels/message.hpp"
#include "cells/units/retry.hpp"
#include "cells/units/wakeup.hpp"

namespace raycell {

class Injector {
  public:
    /// Begins a phase; `traces`: the pixel's primary ray is to be sent.
    void begin_phase(bool traces) {
        primary_to_send_ = traces;
        precast_next_ = 0;
    }

    /// The own ray on its way out, null if the register is free.
    RayPacket* ray() const { return ray_; }
    void load(RayPacket& packet) { ray_ = &packet; }
    void left() { ray_ = nullptr; }

    /// Whether the primary ray is to be sent, for the first time or again, at once or later.
    bool primary_to_send() const { return primary_to_send_; }
    /// Whether it may go now; else the cell is to run when it may.
    bool primary_due(Cycle now, Wakeup& wakeup) const;
    /// The primary ray has gone: true the first time.
    bool primary_sent();
    void primary_postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now);
    void primary_answered() { primary_awaited_ = false; }
    /// The pixel's intensity is still to come.
    bool unfinished() const { return primary_to_send_ || primary_awaited_ || ray_; }

    /// The next voxel and source of which a precast ray is to be sent; each pair comes once in a phase.
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
