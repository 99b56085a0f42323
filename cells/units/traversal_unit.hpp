// The traversal units (paper, section 4.1): each tests one ray at a time against the cell's voxels, and finds
// what the ray needs next.
#pragma once

#include <array>

#include "cells/channels/message.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// The units are alike, and a ray does not depend on which of them tests it: the model keeps the tests that
/// are going on, in the order in which they began.
class TraversalUnits {
  public:
    /// `count`: units of the cell, 1..most_units.
    explicit TraversalUnits(int count) : count_(std::uint8_t(count)) {}

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

    /// Starts the test of the ray at `place` in a free unit; it lasts until cycle `done`.
    void start(RayPacket& packet, std::uint32_t place, Cycle done) {
        packet.stage = RayPacket::Stage::in_test;
        tests_[busy_++] = {&packet, done, place};
        next_ = place + 1;
    }
    /// Marks the rays whose tests are over as decided, frees their units and calls decided(place) for each.
    template <typename Decided>
    void finish(Cycle now, Wakeup& wakeup, const Decided& decided) {
        std::size_t left = 0;
        for (std::size_t i = 0; i < busy_; ++i) {
            const Test test = tests_[i];
            if (now < test.done) {
                wakeup.at(test.done);
                tests_[left++] = test;
                continue;
            }
            test.packet->stage = RayPacket::Stage::decided;
            test.packet->decided = now;
            decided(test.place);
        }
        busy_ = std::uint8_t(left);
    }

    struct Test {
        RayPacket* packet = nullptr;
        Cycle done = 0;
        std::uint32_t place = 0;
    };
    bool idle() const { return busy_ == 0; }
    bool free() const { return busy_ < count_; }  ///< one at least
    std::size_t busy() const { return busy_; }
    /// A test that is going on, 0..busy() - 1: the one that began first comes first.
    const Test& operator[](std::size_t i) const { return tests_[i]; }
    /// The test that began last; one must be going on.
    const Test& last() const { return tests_[busy_ - 1U]; }
    /// The place at which the round robin starts to look for the next ray.
    std::uint32_t next() const { return next_; }

  private:
    std::uint32_t next_ = 0;
    std::uint8_t busy_ = 0;
    std::uint8_t count_;
    std::array<Test, most_units> tests_;
};

}  // namespace raycell
