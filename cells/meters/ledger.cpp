#include "cells/meters/ledger.hpp"

#include <algorithm>
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

void Ledger::write(ByteWriter& bytes) const {
    bytes.put(destroyed_);
    bytes.put(wasted_hops_);
    bytes.put(wasted_cycles_);
    bytes.put_all(by_generation_);
    bytes.put_all(entries_);
}

void Ledger::add(ByteReader& bytes) {
    destroyed_ += bytes.get<std::uint64_t>();
    wasted_hops_ += bytes.get<std::uint64_t>();
    wasted_cycles_ += bytes.get<std::uint64_t>();
    const auto generations = bytes.get_all<std::uint64_t>();
    by_generation_.resize(std::max(by_generation_.size(), generations.size()), 0);
    for (std::size_t i = 0; i < generations.size(); ++i) by_generation_[i] += generations[i];
    const auto more = bytes.get_all<Entry>();
    entries_.insert(entries_.end(), more.begin(), more.end());
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.cycle < b.cycle; });
    if (entries_.size() > most_entries) entries_.resize(most_entries);
}

}  // namespace raycell
