// The rays that recovery destroyed: when, where, and at what cost (paper, section 4.2: "destroy one or more
// sub-trees and ... postpone the corresponding computations").
#pragma once

#include <cstdint>
#include <vector>

#include "cells/channels/message.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

class Ledger {
  public:
    /// A ray that found no slot. Only its own way was wasted: it had no children yet.
    struct Entry {
        std::uint64_t cycle = 0;     ///< cycle in which it was destroyed
        std::uint64_t launched = 0;  ///< cycle in which its parent sent it
        std::uint64_t ray = 0;
        std::uint32_t hops = 0;  ///< since its launch
        std::uint16_t x = 0;     ///< cell that had no slot
        std::uint16_t y = 0;
        std::uint16_t home_x = 0;  ///< cell that will send it again
        std::uint16_t home_y = 0;
        std::uint8_t generation = 0;
    };
    /// Further rays count only in the sums.
    static constexpr std::size_t most_entries = 1000000;

    void add(const RayPacket& packet, int x, int y, std::uint64_t cycle);

    /// Passes a ledger to another rank of the same machine; add() merges it and keeps the earliest entries.
    void write(ByteWriter& bytes) const;
    void add(ByteReader& bytes);

    const std::vector<Entry>& entries() const { return entries_; }
    std::uint64_t destroyed() const { return destroyed_; }
    /// Hops of the destroyed rays and of their postponed notices.
    std::uint64_t wasted_hops() const { return wasted_hops_; }
    /// Sum of the cycles from sending to destruction.
    std::uint64_t wasted_cycles() const { return wasted_cycles_; }
    const std::vector<std::uint64_t>& by_generation() const { return by_generation_; }

  private:
    std::vector<Entry> entries_;
    std::vector<std::uint64_t> by_generation_;
    std::uint64_t destroyed_ = 0;
    std::uint64_t wasted_hops_ = 0;
    std::uint64_t wasted_cycles_ = 0;
};

}  // namespace raycell
