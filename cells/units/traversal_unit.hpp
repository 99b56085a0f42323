// The traversal unit (paper, section 4.1): tests one ray at a time against the cell's voxels, and finds what
// the ray needs next.
#pragma once

#include "cells/channels/message.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

class TraversalUnit {
  public:
    /// The inputs that all tests of a cell share.
    struct Setting {
        const CellStore& store;
        const DepthRuns& runs;
        const Context& context;
        const BufferClasses& classes;
        int x;
        int y;
    };
    /// Tests a ray. Writes the result into the packet at once; it counts only when the test's time is over.
    /// Returns the cycles of the test.
    static std::uint32_t test(RayPacket& packet, const Setting& setting, const CostTable& costs);

    /// Starts the test of the ray at `place`; it lasts until cycle `done`.
    void start(RayPacket& packet, std::uint32_t place, Cycle done) {
        packet.stage = RayPacket::Stage::in_test;
        packet_ = &packet;
        done_ = done;
        place_ = place;
        next_ = place + 1;
    }
    /// If the test is over, marks the ray as decided, frees the unit and returns true.
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
    /// The place at which the round robin starts to look for the next ray.
    std::uint32_t next() const { return next_; }

  private:
    RayPacket* packet_ = nullptr;
    Cycle done_ = 0;
    std::uint32_t place_ = 0;
    std::uint32_t next_ = 0;
};

}  // namespace raycell
