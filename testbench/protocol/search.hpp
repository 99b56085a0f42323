// A search over every order of events of a script: does it always end?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/protocol/script.hpp"

namespace raycell::protocol {

struct Rules {
    int ray_store = 1;  ///< M
    Slots slots = Slots::reserved;
    Recovery recovery = Recovery::postpone;
    int generations = 1;  ///< that may have to wait
    int processors = 1;   ///< of the exterior
    /// Primary rays of a cell that may be under way at once, in the script's order; while one is postponed no
    /// other begins. 0: all of them, in any order.
    int own_rays = 0;
};

/// Whether a cell whose slots hold `used[g]` rays of each generation g accepts one more of `generation`. The
/// rule of RayStore, as one over counts (a test compares the two).
bool accepts(const Rules& rules, const std::vector<int>& used, int generation);

struct Result {
    bool complete = false;        ///< all reachable states were visited; false: there are more than the limit
    std::uint64_t states = 0;     ///< reachable
    std::uint64_t moves = 0;      ///< between them
    std::uint64_t deadlocks = 0;  ///< states without a move in which a ray is not done
    std::uint64_t traps = 0;  ///< states from which neither the end nor a deadlock can be reached: livelock
    std::vector<std::string> way_to_deadlock;  ///< a shortest one, a move per line
    std::vector<std::string> way_to_trap;      ///< the same, and what waits there
    bool always_ends() const { return complete && deadlocks == 0 && traps == 0; }
};

/// Searches all orders of all moves, breadth first. Buffers hold one message. Throws std::length_error for a
/// script of more than `most_rays` rays or ways that are too long.
Result search(const Script& script, const Rules& rules, std::uint64_t most_states = 2000000);
constexpr std::size_t most_rays = 24;

}  // namespace raycell::protocol
