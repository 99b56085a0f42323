#include "cells/units/ray_store.hpp"

namespace raycell {

RayStore::RayStore(int capacity, int generations, Slots policy)
    : capacity_(capacity), shared_(capacity), nested_(policy == Slots::nested) {
    if (policy != Slots::free) {
        groups_ = std::max(1, std::min(capacity, generations));
        shared_ = capacity - groups_;
    }
}

/// Number of slots in use among those free for all.
int RayStore::borrowed() const {
    int sum = 0;
    for (int g = 0; g < groups_; ++g) sum += std::max(0, used_by(g) - 1);
    return sum;
}

/// The first group g >= `from` such that groups 0 to g have taken all slots but one for each deeper group;
/// the number of groups if there is none.
int RayStore::full_from(int from) const {
    int up_to = 0;
    for (int g = 0; g < groups_; ++g) {
        up_to += used_by(g);
        if (g >= from && up_to >= shared_ + 1 + g) return g;
    }
    return groups_;
}

bool RayStore::has_room(int generation) const {
    if (used_ >= capacity_) return false;
    if (nested_) return full_from(group(generation)) == groups_;
    // If the group's reserved slot is taken, it needs one of those free for all.
    return groups_ == 0 || used_by(group(generation)) == 0 || borrowed() < shared_;
}

bool RayStore::would_help(int held, int wanting) const {
    if (groups_ == 0) return true;
    if (nested_) return group(held) <= full_from(group(wanting));
    return group(held) == group(wanting) || used_by(group(held)) > 1;
}

std::optional<std::uint32_t> RayStore::allocate(int generation) {
    if (!has_room(generation)) return std::nullopt;
    if (groups_ > 0) {
        if (!used_by_) used_by_ = std::make_unique<std::uint16_t[]>(std::size_t(groups_));
        ++used_by_[std::size_t(group(generation))];
    }
    ++used_;
    peak_ = std::max(peak_, used_);
    if (free_ != none) {
        const std::uint32_t index = free_;
        free_ = slots_[index].next_free;
        return index;
    }
    slots_.emplace_back();
    return std::uint32_t(slots_.size() - 1);
}

void RayStore::release(std::uint32_t index, int generation) {
    slots_[index] = Slot();
    slots_[index].next_free = free_;
    free_ = index;
    --used_;
    if (groups_ > 0) --used_by_[std::size_t(group(generation))];
}

Cycle RayStore::waiting_cycles(Cycle now) const {
    Cycle sum = 0;
    for (const Slot& slot : slots_) {
        if (slot.state != Slot::State::empty) sum += now - slot.since;
    }
    return sum;
}

}  // namespace raycell
