// The traversal units (paper, section 4.1): each tests one ray at a time against the cell's voxels, and finds
// what the ray needs next.
#pragma once

#include <array>

#include "cells/channels/message.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// The units are alike, and a ray does not depend on which of them tests it: it is the first that is free.
class TraversalUnits {
  public:
    /// `count`: units of the cell, 1..most_units.
    explicit TraversalUnits(int count) : count_(std::uint8_t(count)) {}

    /// The inputs that all tests of a cell share.
    struct Setting {
        const CellStore& store;
        const IndexTable& index;
        const Context& context;
        const BufferClasses& classes;
        int x;
        int y;
    };
    /// Tests a ray. Writes the result into the packet at once; it counts only when the test's time is over.
    /// Returns the cycles of the test.
    static std::uint32_t test(RayPacket& packet, const Setting& setting, const CostTable& costs);

    /// Starts the test of the ray at `place` in the first free unit; it lasts until cycle `done`.
    void start(RayPacket& packet, std::uint32_t place, Cycle done) {
        packet.stage = RayPacket::Stage::in_test;
        last_ = 0;
        while (packets_[last_]) ++last_;
        packets_[last_] = &packet;
        done_[last_] = done;
        places_[last_] = std::uint16_t(place);
        ++busy_;
        next_ = place + 1;
    }
    /// Marks the rays whose tests are over as decided, frees their units and calls decided(place) for each.
    template <typename Decided>
    void finish(Cycle now, Wakeup& wakeup, const Decided& decided) {
        for (std::size_t unit = 0; unit < count_; ++unit) {
            if (!packets_[unit]) continue;
            if (now < done_[unit]) {
                wakeup.at(done_[unit]);
                continue;
            }
            packets_[unit]->stage = RayPacket::Stage::decided;
            packets_[unit]->decided = now;
            packets_[unit] = nullptr;
            --busy_;
            decided(places_[unit]);
        }
    }

    bool idle() const { return busy_ == 0; }
    bool free() const { return busy_ < count_; }  ///< one at least
    std::size_t count() const { return count_; }
    // Of a unit, 0..count() - 1.
    const RayPacket* packet(std::size_t unit) const { return packets_[unit]; }  ///< null: the unit is free
    Cycle done(std::size_t unit) const { return done_[unit]; }
    std::uint32_t place(std::size_t unit) const { return places_[unit]; }
    /// The unit that began last.
    std::size_t last() const { return last_; }
    /// The place at which the round robin starts to look for the next ray.
    std::uint32_t next() const { return next_; }

  private:
    std::uint32_t next_ = 0;
    std::uint8_t busy_ = 0;
    std::uint8_t count_;
    std::uint8_t last_ = 0;                           ///< the unit that began last
    std::array<std::uint16_t, most_units> places_{};  ///< of the rays in test; there are at most 1024 slots
    std::array<RayPacket*, most_units> packets_{};
    std::array<Cycle, most_units> done_{};
};

}  // namespace raycell
