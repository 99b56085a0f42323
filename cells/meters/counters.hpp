// The counters of a run.
#pragma once

#include "cells/clock/scheduler.hpp"
#include "model/machine/untimed.hpp"

namespace raycell {

/// Counters of a run: sums and, last, three maxima, so they do not depend on the order in which cells run.
struct Counters {
    RayCounts rays;
    std::uint64_t load_hops = 0;
    std::uint64_t rays_sent = 0;       ///< launched, also again after a postponement
    std::uint64_t rays_answered = 0;   ///< ended in an answer
    std::uint64_t rays_silent = 0;     ///< precast rays that reached their source
    std::uint64_t rays_destroyed = 0;  ///< postponed
    std::uint64_t answers_sent = 0;
    std::uint64_t answers_delivered = 0;
    std::uint64_t loads_sent = 0;       ///< spans and broadcast messages put into a row
    std::uint64_t loads_delivered = 0;  ///< of these, ended in their last cell
    std::uint64_t packed = 0;           ///< rays and answers packed and unpacked, with a wire check
    std::uint64_t packed_load = 0;      ///< load messages, the same
    std::uint64_t cells_loaded = 0;     ///< end-of-scene marks seen
    std::uint64_t pixels_done = 0;
    std::uint64_t slots_used = 0;   ///< slots in use now, over all cells
    std::uint64_t slot_cycles = 0;  ///< sum over accepted rays of the cycles in the ray store
    std::uint64_t traversal_cycles = 0;
    std::uint64_t shading_cycles = 0;
    std::uint64_t most_kept = 0;       ///< spans that a cell kept at a time until their voxels were made
    std::uint64_t most_load_bits = 0;  ///< of a cell's memory of voxels, with the spans that wait in it
    Cycle last_progress =
        0;  ///< last cycle in which an end-of-scene mark, or an answer other than "postponed", came home
};

/// Adds the counters of another part of the same machine.
void join(Counters& sum, const Counters& other);

}  // namespace raycell
