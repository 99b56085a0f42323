#include "cells/ray_store.hpp"

#include <algorithm>

namespace raycell {

RayStore::RayStore(int capacity, int generations, Slots policy)
    : capacity_(capacity), shared_(capacity), nested_(policy == Slots::nested) {
    if (policy != Slots::free) {
        const int groups = std::max(1, std::min(capacity, generations));
        used_by_.assign(std::size_t(groups), 0);
        shared_ = capacity - groups;
    }
}

std::size_t RayStore::group(int generation) const {
    return std::min(std::size_t(generation), used_by_.size() - 1);
}

/// Slots taken of those that are free for all.
int RayStore::borrowed() const {
    int sum = 0;
    for (const std::uint16_t used : used_by_) sum += std::max(0, used - 1);
    return sum;
}

/// The first group from `from` on up to which so many slots are taken that one for each deeper group is left;
/// their number if there is none.
std::size_t RayStore::full_from(std::size_t from) const {
    int up_to = 0;
    for (std::size_t g = 0; g < used_by_.size(); ++g) {
        up_to += used_by_[g];
        if (g >= from && up_to >= shared_ + 1 + int(g)) return g;
    }
    return used_by_.size();
}

bool RayStore::has_room(int generation) const {
    if (used_ >= capacity_) return false;
    if (nested_) return full_from(group(generation)) == used_by_.size();
    // Where the reserved slot is taken: one of those free for all, if any is left.
    return used_by_.empty() || used_by_[group(generation)] == 0 || borrowed() < shared_;
}

bool RayStore::would_help(int held, int wanting) const {
    if (used_by_.empty()) return true;
    if (nested_) return group(held) <= full_from(group(wanting));
    return group(held) == group(wanting) || used_by_[group(held)] > 1;
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
