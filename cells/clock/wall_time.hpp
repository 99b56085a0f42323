// The wall-clock time of a run, as opposed to the machine's cycles.
#pragma once

#include <chrono>

namespace raycell {

using WallClock = std::chrono::steady_clock;

inline double seconds_since(WallClock::time_point start) {
    return std::chrono::duration<double>(WallClock::now() - start).count();
}

}  // namespace raycell
