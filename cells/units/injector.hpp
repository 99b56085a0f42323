// The injector: the register from which the cell's own rays are sent, one at a time (design, section 6). In
// phase trace these are the primary rays of its block of pixels, each sent again if it was postponed; in
// phase precast, the precast rays of its voxels.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "cells/channels/message.hpp"
#include "cells/units/retry.hpp"
#include "cells/units/wakeup.hpp"

namespace raycell {

class Injector {
  public:
    /// So many primary rays may be under way at once, 1..most_own_rays. An answer names the one that it is
    /// for by its number, from 0.
    explicit Injector(int own_rays)
        : own_(new OwnRay[std::size_t(own_rays)]), count_(std::uint8_t(own_rays)) {}

    /// Begins a phase; the primary rays of the samples first to last - 1 must be sent in it, from cycle
    /// `start` on. They are numbered through all pixels of the cell's block.
    void begin_phase(int first, int last, Cycle start = 0) {
        next_ = std::uint32_t(first);
        end_ = stop_ = std::uint32_t(last);
        made_ = start;
    }
    /// The next sample to be sent is `next`; from `stop` on none is before this is called again.
    void go_on(int next, int stop) {
        next_ = std::min(std::uint32_t(next), end_);
        stop_ = std::min(std::uint32_t(stop), end_);
    }

    /// The own ray that waits to leave; null if the register is free.
    RayPacket* ray() const { return ray_; }
    void load(RayPacket& packet) { ray_ = &packet; }
    void left() { ray_ = nullptr; }

    /// Whether a primary ray must be sent, for the first time or again, now or later, and may be under way
    /// beside the others.
    bool primary_to_send() const { return to_send_ || begins_another(); }
    /// The number of the primary ray that may be sent now: of those that were postponed the next in turn, or
    /// the next sample's. If only later, asks for a step in that cycle.
    std::optional<unsigned> primary_due(Cycle now, Wakeup& wakeup) const;
    /// Notes that a primary ray was sent; true the first time. Then the next one is made, and can be
    /// sent from cycle `made` on.
    bool primary_sent(unsigned number, Cycle made);
    /// The sample that a primary ray under way is for.
    int sample(unsigned number) const { return own_[number].sample; }
    void primary_postponed(unsigned number, const MachineSettings& machine, std::uint64_t ray, Cycle now);
    void primary_answered(unsigned number) { awaited_ &= std::uint16_t(~(1U << number)); }
    /// Whether a sample's intensity is still missing or an own ray stands in the register.
    bool unfinished() const { return awaited_ || next_ < end_ || ray_; }

    /// The voxel and the source of the next precast ray; each pair comes once in a phase.
    struct Precast {
        std::uint32_t voxel;
        std::size_t source;
    };
    std::optional<Precast> next_precast(std::size_t voxels, std::size_t sources);

  private:
    /// A primary ray under way or postponed.
    struct OwnRay {
        Retry retry;
        int sample = 0;
    };
    std::uint32_t all() const { return (1U << count_) - 1; }
    /// Not while one is postponed: more rays would only be refused too, and each costs its tests again.
    bool begins_another() const { return next_ < stop_ && awaited_ != all() && !to_send_; }

    RayPacket* ray_ = nullptr;
    std::unique_ptr<OwnRay[]> own_;
    Cycle made_ = 0;             ///< first cycle in which the next sample's ray can be sent
    std::uint32_t next_ = 0;     ///< sample to begin with next; precast: voxel · sources + source
    std::uint32_t end_ = 0;      ///< behind the last sample of this phase
    std::uint32_t stop_ = 0;     ///< behind the last that may be sent as yet
    std::uint16_t to_send_ = 0;  ///< bits of own rays that were postponed
    std::uint16_t awaited_ = 0;  ///< bits of own rays that are not answered
    std::uint8_t turn_ = 0;      ///< of those postponed, the first to be looked at
    std::uint8_t count_;
    static_assert(most_own_rays <= 16);  // bits of a word
};

}  // namespace raycell
