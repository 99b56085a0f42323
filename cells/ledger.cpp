#include "cells/ledger.hpp"

#include <cstdlib>

namespace raycell {

void Ledger::add(const RayPacket& packet, int x, int y, std::uint64_t cycle) {
    const Ray& ray = packet.ray;
    ++destroyed_;
    wasted_hops_ += packet.hops + std::uint64_t(std::abs(x - ray.home_x) + std::abs(y - ray.home_y));
    wasted_cycles_ += cycle - packet.launched;
    if (by_generation_.size() <= ray.generation) by_generation_.resize(ray.generation + std::size_t(1), 0);
    ++by_generation_[ray.generation];
    if (entries_.size() >= most_entries) return;
    entries_.push_back({cycle, packet.launched, ray.id, packet.hops, std::uint16_t(x), std::uint16_t(y),
                        ray.home_x, ray.home_y, ray.generation});
}

}  // namespace raycell
