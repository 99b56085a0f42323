#include "testbench/common/time_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace raycell {
namespace {

// Cost of each quantity of a Forecast in the simulator, nanoseconds, on one core of a server. The terms
// described 54 runs of the Standard Procedural Databases at 64x64 to 256x256 cells to within a factor of 1.7.
// When hops had become cheaper, those of rays were fitted again to teapot-s4 and balls-s2 at 64x64 to 512x512
// cells (docs/measured/bench_growth.md).
constexpr double load_hop = 150;
constexpr double load_step = 170;
constexpr double load_cell = 2000;
constexpr double ray_hop = 230;       ///< with one voxel to look at and the array in the caches
constexpr double ray_voxel = 10;      ///< per voxel of the mean cell
constexpr double ray_doubling = 10;   ///< per doubling of the array above small_array
constexpr double small_array = 4096;  ///< cells
constexpr double modules = 2.5;       ///< factor if every cell is a module
constexpr double rank = 0.85;  ///< share of a rank's time for rays, the rest is waiting (docs/use/ranks.md)

}  // namespace

ExpectedSeconds expected_seconds(const Forecast& forecast, std::size_t cells, bool every_cell_is_a_module,
                                 int ranks) {
    const double each = 1e-9 * (every_cell_is_a_module ? modules : 1);
    const double doublings = std::max(0.0, std::log2(double(cells) / small_array));
    const double hop = ray_hop + ray_doubling * doublings + ray_voxel * forecast.voxels / double(cells);
    ExpectedSeconds seconds;
    seconds.load =
        each * (load_hop * forecast.load_hops + load_step * forecast.load_steps + load_cell * double(cells));
    // Ranks do not speed up loading.
    const double rays = each * hop / (ranks > 1 ? rank * ranks : 1);
    seconds.precast = rays * forecast.precast_hops;
    seconds.trace = rays * forecast.trace_hops;
    return seconds;
}

std::string duration(double seconds) {
    struct Unit {
        double seconds;
        const char* name;
    };
    constexpr Unit units[] = {{86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}};
    // The largest unit of which there are two or more: 90 s, 119 min.
    for (const Unit& unit : units) {
        const double count = seconds / unit.seconds;
        if (count < 2 && unit.seconds > 1) continue;
        char text[32];
        const bool whole = count >= 10 || unit.seconds == 1;
        std::snprintf(text, sizeof text, "%.*f %s", whole ? 0 : 1, count, unit.name);
        return text;
    }
    return "";
}

std::string expectation(const Forecast& forecast, const ExpectedSeconds& seconds) {
    char hops[32];
    std::snprintf(hops, sizeof hops, "%.3g M hops", forecast.hops() / 1e6);
    std::string text = "about " + duration(seconds.sum()) + " for " + hops + ":";
    const char* separator = " ";
    const std::pair<const char*, double> phases[] = {
        {"load ", seconds.load}, {"precast ", seconds.precast}, {"trace ", seconds.trace}};
    for (const auto& [name, phase] : phases) {
        if (phase < 0.5) continue;
        text += separator + (name + duration(phase));
        separator = ", ";
    }
    return text;
}

double seconds_left(const RunProgress& progress) {
    // Below these, no estimate is possible.
    constexpr double least_share = 0.005;
    constexpr double least_seconds = 2;
    if (progress.share < least_share || progress.seconds < least_seconds) return -1;
    return progress.seconds * std::max(1 - progress.share, 0.0) / progress.share;
}

std::string progress_line(const RunProgress& p) {
    const bool load = std::string(p.phase) == "load";
    std::string text = std::string(p.phase) + ": cycle " + std::to_string(p.cycle) + ", ";
    if (load) {
        text += std::to_string(int(100 * p.share)) + " % of the polygons, ";
    } else if (std::string(p.phase) == "precast") {
        text += std::to_string(int(100 * p.share)) + " % of the rays, ";
    } else {
        text += std::to_string(p.done) + " of " + std::to_string(p.all) + " pixels done, ";
    }
    text += std::to_string(p.hops) + " hops";
    const double left = seconds_left(p);
    if (left >= 0) text += ", about " + duration(left) + (load ? " of loading left" : " left");
    return text;
}

}  // namespace raycell
