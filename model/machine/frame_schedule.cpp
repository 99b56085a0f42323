#include "model/machine/frame_schedule.hpp"

#include <algorithm>

namespace raycell {

std::vector<FrameTimes> schedule_of(const std::vector<FrameCycles>& frames) {
    std::vector<FrameTimes> all;
    for (const FrameCycles& frame : frames) {
        const std::size_t n = all.size();
        const std::uint64_t loaded = n > 0 ? all[n - 1].load_ends : 0;
        const std::uint64_t store_free = n > 1 ? all[n - 2].done : 0;
        const std::uint64_t traced = n > 0 ? all[n - 1].done : 0;
        FrameTimes times;
        times.load_begins = std::max(loaded, store_free);
        times.load_ends = times.load_begins + frame.load;
        times.trace_begins = std::max(times.load_ends, traced);
        times.done = times.trace_begins + frame.trace;
        all.push_back(times);
    }
    return all;
}

SteadyState steady_state_of(const std::vector<FrameCycles>& frames) {
    SteadyState steady;
    steady.frames = frames.size();
    // The trace of a frame and the loading of the next begin together: both wait for the frame's own loading
    // and for the trace before.
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameCycles& next = frames[(i + 1) % frames.size()];
        steady.period += std::max(frames[i].trace, next.load);
        steady.load += frames[i].load;
        steady.trace += frames[i].trace;
        steady.bound_by_load += next.load > frames[i].trace;
    }
    return steady;
}

}  // namespace raycell
