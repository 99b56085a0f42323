// The shading unit (paper, sections 3.2 and 4.1): sets a hit up for its children, and shades it when all
// their answers have come. It does one job at a time. Results are written when a job begins but count only
// when its time is over.
#pragma once

#include <optional>

#include "cells/units/ray_store.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

class ShadingUnit {
  public:
    enum class Job : std::uint8_t {
        idle,
        set_up,        ///< of a slot: its point, its normal, which children it has
        shade,         ///< of a slot that has all its answers
        direct,        ///< set_up and shade, for a hit that waits for no other ray and needs no slot
        direct_answer  ///< the reply of such a hit waits in the unit for its way out
    };

    /// Whether a slot has all its answers and can be shaded.
    static bool complete(const Slot& slot, const CellStore& store, Shadows shadows);
    /// Whether any slot is complete.
    static bool any_complete(const RayStore& slots, const CellStore& store, Shadows shadows);
    /// The next job: complete slots first, because shading frees a slot, then slots to set up; each oldest
    /// first.
    struct Choice {
        Job job;
        std::uint32_t slot;
    };
    static std::optional<Choice> choose(const RayStore& slots, const CellStore& store, Shadows shadows);

    // The jobs; each returns its cycles. (x, y): the cell.
    static std::uint32_t set_up(Slot& slot, const CellStore& store, const Context& context,
                                const CostTable& costs, int x, int y);
    static std::uint32_t shade(Slot& slot, const CellStore& store, const Context& context,
                               const CostTable& costs);
    std::uint32_t direct(RayPacket& packet, const HitSetup& setup, const CellStore& store,
                         const Context& context, const CostTable& costs);
    /// Notes after the set-up what the slot waits for. `asked`: the sources of its voxel that were already
    /// asked (memo).
    static void await(Slot& slot, Shadows shadows, std::uint64_t asked);

    void start(Job job, std::uint32_t slot, Cycle done) {
        job_ = job;
        slot_ = slot;
        done_ = done;
    }
    /// Whether the job's time is over.
    bool finished(Cycle now, Wakeup& wakeup) const {
        if (now < done_) wakeup.at(done_);
        return now >= done_;
    }
    void hold_answer() { job_ = Job::direct_answer; }
    void free() { job_ = Job::idle; }

    bool idle() const { return job_ == Job::idle; }
    Job job() const { return job_; }
    std::uint32_t slot() const { return slot_; }
    Cycle done() const { return done_; }
    RayPacket* direct_ray() const { return packet_; }
    const dvec3& direct_result() const { return result_; }
    Wait& direct_wait() { return wait_; }  ///< of the reply that stands in the unit
    const Wait& direct_wait() const { return wait_; }

  private:
    Job job_ = Job::idle;
    std::uint32_t slot_ = 0;
    Cycle done_ = 0;
    RayPacket* packet_ = nullptr;
    dvec3 result_{0, 0, 0};
    Wait wait_;
};

}  // namespace raycell
