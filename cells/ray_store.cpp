#include "cells/ray_store.hpp"

#include <algorithm>

namespace raycell {

RayStore::RayStore(int capacity, int generations, Slots policy) : capacity_(capacity), shared_(capacity) {
    if (policy == Slots::reserved) {
        const int groups = std::max(1, std::min(capacity, generations));
        used_by_.assign(std::size_t(groups), 0);
        shared_ = capacity - groups;
    }
}

std::size_t RayStore::group(int generation) const {
    return std::min(std::size_t(generation), used_by_.size() - 1);
}

bool RayStore::has_room(int generation) const {
    if (used_ >= capacity_) return false;
    if (used_by_.empty() || used_by_[group(generation)] == 0) return true;
    // The reserved slot is taken: one of those free for all, if any is left.
    int borrowed = 0;
    for (const std::uint16_t used : used_by_) borrowed += std::max(0, used - 1);
    return borrowed < shared_;
}

std::optional<std::uint32_t> RayStore::allocate(int generation) {
    if (!has_room(generation)) return std::nullopt;
    if (!used_by_.empty()) ++used_by_[group(generation)];
    ++used_;
    peak_ = std::max(peak_, used_);
    if (!free_.empty()) {
        const std::uint32_t index = free_.back();
        free_.pop_back();
        return index;
    }
    slots_.emplace_back();
    return std::uint32_t(slots_.size() - 1);
}

void RayStore::release(std::uint32_t index, int generation) {
    slots_[index] = Slot();
    free_.push_back(index);
    --used_;
    if (!used_by_.empty()) --used_by_[group(generation)];
}

Cycle RayStore::waiting_cycles(Cycle now) const {
    Cycle sum = 0;
    for (const Slot& slot : slots_) {
        if (slot.state != Slot::State::empty) sum += now - slot.since;
    }
    return sum;
}

}  // namespace raycell
