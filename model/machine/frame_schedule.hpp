// Frames in a row: an array with two stores of voxels is loaded with a frame while it traces the one before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raycell {

/// What a frame takes alone: cycles of loading, and of what follows (precast and trace).
struct FrameCycles {
    std::uint64_t load = 0;
    std::uint64_t trace = 0;
};

/// When a frame of a row is loaded and traced, in cycles from the beginning of the first frame's loading.
/// Each phase takes place in the cycles from its beginning up to, not including, its end.
struct FrameTimes {
    std::uint64_t load_begins = 0;
    std::uint64_t load_ends = 0;
    std::uint64_t trace_begins = 0;
    std::uint64_t done = 0;  ///< its trace ends
};

/// A frame is loaded when the one before it is loaded and the store of the one before that is free, since its
/// trace is done. It is traced when it is loaded and the one before it is done.
std::vector<FrameTimes> schedule_of(const std::vector<FrameCycles>& frames);

/// The list of frames repeated for ever.
struct SteadyState {
    std::uint64_t period = 0;       ///< cycles from a frame to the same frame of the next round
    std::uint64_t load = 0;         ///< of these, cycles in which a frame is loaded
    std::uint64_t trace = 0;        ///< in which a frame is traced
    std::size_t bound_by_load = 0;  ///< frames whose trace is shorter than the loading beside it
    std::size_t frames = 0;

    double cycles_per_frame() const { return double(period) / double(frames); }
    /// The same with one store: nothing is loaded while a frame is traced.
    double cycles_with_one_store() const { return double(load + trace) / double(frames); }
    /// What is at work for more of the cycles: "load", "trace" or "both".
    const char* binds() const { return load > trace ? "load" : load < trace ? "trace" : "both"; }
};

/// `frames` must not be empty.
SteadyState steady_state_of(const std::vector<FrameCycles>& frames);

}  // namespace raycell
