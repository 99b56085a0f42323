// Why a message in a cell does not move: the causes that a cell's step tests, and the counters of a cell.
#pragma once

#include <array>
#include <cstdint>

#include "cells/clock/scheduler.hpp"

namespace raycell {

/// What a ray or an answer waits for. The first cause that the cell finds counts.
enum class Stall : std::uint8_t {
    none,
    traversal,    ///< an untested ray at the head of its buffer or register: the traversal unit is at work
    output_full,  ///< a tested ray: no room in the next cell's buffer
    output_busy,  ///< a tested ray: room, but the link's wires carry another message
    answer_full,  ///< an answer, or a ray that is to end in one: no room in the next cell's buffer
    answer_busy,  ///< the same: room, but the link's wires carry another message
    no_slot,      ///< a hit: no slot that it may take, and `--recovery none`
    shading,      ///< a hit or a slot: the shading unit is at work or has something more urgent to do
    store_port    ///< a hit or an answer that is home: the ray store's write port is taken in this cycle
};
constexpr std::size_t stall_causes = 8;  ///< without `none`
constexpr std::array<const char*, stall_causes + 1> stall_names = {
    "none",        "traversal", "output_full", "output_busy", "answer_full",
    "answer_busy", "no_slot",   "shading",     "store_port"};

/// A wait: its first cycle and its cause. A cause only changes in a cycle in which the cell runs in any case,
/// so the counts do not depend on additional wakes.
struct Wait {
    Cycle since : 56;  ///< shares a word with the cause: every message and every side of a cell has a Wait
    Stall cause : 8;
    constexpr Wait(Cycle cycle = 0, Stall why = Stall::none) : since(cycle), cause(why) {}
};
static_assert(sizeof(Wait) == sizeof(std::uint64_t));

/// Cycles by cause; `none` has no entry.
class StallCycles {
  public:
    std::uint64_t& operator[](Stall cause) { return cycles_[std::size_t(cause) - 1]; }
    const std::uint64_t& operator[](Stall cause) const { return cycles_[std::size_t(cause) - 1]; }
    auto begin() const { return cycles_.begin(); }
    auto end() const { return cycles_.end(); }
    bool operator==(const StallCycles& other) const { return cycles_ == other.cycles_; }

  private:
    std::array<std::uint64_t, stall_causes> cycles_{};
};

/// Counters of a cell over precast and trace (load_hops, loading_cycles: over loading). They are sums, so the
/// order of cells does not matter. The counters of every hop and the most frequent causes come first, in one
/// cache line.
struct CellStatistics {
    std::uint64_t ray_hops = 0;     ///< rays sent to neighbours
    std::uint64_t return_hops = 0;  ///< answers sent, and rays sent over the array's border
    std::uint64_t traversal_cycles = 0;
    StallCycles stalls;           ///< summed over all waits
    std::uint64_t load_hops = 0;  ///< load messages passed on
    std::uint64_t postponed = 0;  ///< rays destroyed here for lack of a slot
    std::uint64_t shading_cycles = 0;
    std::uint64_t loading_cycles = 0;  ///< of making voxels
    std::uint64_t slot_cycles = 0;     ///< summed over slots: cycles in which each was taken
};

}  // namespace raycell
