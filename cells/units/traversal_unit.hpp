// The traversal unit (paper, section 4.1): tests one ray at a time against the cell's voxels, and finds where
// it goes on.
#pragma once

#include "cells/channels/message.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

class TraversalUnit {
  public:
    /// What all tests of a cell have in common.
    struct Setting {
        const CellStore& store;
        const DepthRuns& runs;
        const Context& context;
        const BufferClasses& classes;
        int x;
        int y;
    };
    /// What a ray's test finds, written into the packet at once though it shows only when the time is over.
    /// Returns how many cycles it takes.
    static std::uint32_t test(RayPacket& packet, const Setting& setting, const CostTable& costs);

    /// The ray at `place` is in test until cycle `done`.
    void start(RayPacket& packet, std::uint32_t place, Cycle done) {
        packet.stage = RayPacket::Stage::in_test;
        packet_ = &packet;
        done_ = done;
        place_ = place;
        next_ = place + 1;
    }
    /// Whether the test is over; then the ray is decided and the unit free.
    bool finish(Cycle now, Wakeup& wakeup) {
        if (now < done_) {
            wakeup.at(done_);
            return false;
        }
        packet_->stage = RayPacket::Stage::decided;
        packet_->decided = now;
        packet_ = nullptr;
        return true;
    }

    const RayPacket* packet() const { return packet_; }  ///< null: the unit is free
    Cycle done() const { return done_; }
    std::uint32_t place() const { return place_; }  ///< of the ray in test, or tested last
    /// Where to begin to look for the next ray: round robin over the places.
    std::uint32_t next() const { return next_; }

  private:
    RayPacket* packet_ = nullptr;
    Cycle done_ = 0;
    std::uint32_t place_ = 0;
    std::uint32_t next_ = 0;
};

}  // namespace raycell
