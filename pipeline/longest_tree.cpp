#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "pipeline/machine.hpp"

namespace raycell {
namespace {

/// Pixels whose trees may be the longest: those with most hops.
std::vector<std::size_t> pixels_with_most_hops(const std::vector<std::uint32_t>& hops) {
    constexpr std::size_t most = 16;
    std::vector<std::size_t> pixels(hops.size());
    std::iota(pixels.begin(), pixels.end(), std::size_t(0));
    const auto end = pixels.begin() + std::ptrdiff_t(std::min(most, pixels.size()));
    std::partial_sort(pixels.begin(), end, pixels.end(), [&](std::size_t a, std::size_t b) {
        return hops[a] != hops[b] ? hops[a] > hops[b] : a < b;
    });
    pixels.erase(end, pixels.end());
    return pixels;
}

}  // namespace

Binding Machine::longest_tree() {
    Environment& env = parts_.environment;
    Binding longest;
    if (parts_.ranks || env.machine.stall > 0 || env.machine.max_cycles > 0) return longest;
    if (env.phase != Phase::trace) throw std::logic_error("internal error: there was no trace");
    before_cycle_ = {};
    progress_ = {};
    for (const std::size_t pixel : pixels_with_most_hops(env.meters.pixel_hops)) {
        const Frame& frame = env.context.scene.frame;
        const int column = int(pixel % std::size_t(frame.picture_width()));
        const int row = int(pixel / std::size_t(frame.picture_width()));
        const int x = column / frame.block_width;
        const int y = row / frame.block_height;
        const std::uint64_t destroyed = env.meters.counters.rays_destroyed;
        env.phase_start = parts_.scheduler.now();
        parts_.array.begin_tree(x, y,
                                row % frame.block_height * frame.block_width + column % frame.block_width);
        parts_.scheduler.begin();
        sc_core::sc_start();
        if (env.pools.rays.in_use() + env.pools.answers.in_use() > 0) return {};  // interrupted
        // With too few slots a tree is in its own way, and its back-offs are drawn anew.
        if (env.meters.counters.rays_destroyed > destroyed) continue;
        longest.consider(
            {Binding::Unit::tree, x, y, Side::east, env.meters.counters.last_progress - env.phase_start});
    }
    return longest;
}

}  // namespace raycell
