#include "cells/units/loading_unit.hpp"

namespace raycell {

LoadItem* LoadingUnits::work(const LinkIn& from, int x, const CostTable& costs, Cycle now, Wakeup& wakeup) {
    const Message message = from.front(0);
    if (message.kind != Message::Kind::load) return nullptr;
    if (item_ != message.load) {  // just arrived
        item_ = message.load;
        done_ = now + (makes_voxel(*item_, x) ? costs.load_advance : costs.load_forward);
    }
    if (now >= done_) return item_;
    wakeup.at(done_);
    return nullptr;
}

namespace {

/// Spans of which one unit makes voxels, the last of them by cycle `made`: they follow each other.
Cycle kept_by_unit(Cycle made, Cycle cycles, Cycle now) {
    return made > now ? (made - now + cycles - 1) / cycles : 0;
}

}  // namespace

int LoadingUnits::kept(Cycle cycles, Cycle now) const {
    Cycle sum = 0;
    for (const Cycle made : made_) sum += kept_by_unit(made, cycles, now);
    return int(sum);
}

void LoadingUnits::keep(Cycle cycles, Cycle ordering, Cycle now) {
    made_[turn_] = std::max(made_[turn_], now) + cycles;
    if (ordering > 0) ordered_ = std::max(ordered_, made_[turn_]) + ordering;
    turn_ = std::uint8_t(turn_ + 1 == count_ ? 0 : turn_ + 1);
}

Cycle LoadingUnits::to_make(Cycle now) const {
    Cycle sum = 0;
    for (const Cycle made : made_) sum += made > now ? made - now : 0;
    return sum;
}

bool LoadingUnits::has_room(int most, Cycle cycles, Cycle now, Wakeup& wakeup) const {
    if (most == 0 || kept(cycles, now) < most) return true;
    for (const Cycle made : made_) {  // the next voxel of each unit
        const Cycle kept = kept_by_unit(made, cycles, now);
        if (kept > 0) wakeup.at(made - (kept - 1) * cycles);
    }
    return false;
}

bool LoadingUnits::closes(Cycle now, Wakeup& wakeup) {
    if (!closing_) return false;
    if (now < made()) {
        wakeup.at(made());
        return false;
    }
    closing_ = false;
    return true;
}

bool LoadingUnits::ends_at(const LoadItem& item, int x, int width) {
    return item.kind == LoadItem::Kind::span ? item.span.last == x : x + 1 == width;
}

std::uint32_t LoadingUnits::take(LoadItem& item, int x, CellStore& store, const Context& context) {
    // Hardware latches broadcast messages in every cell; the model keeps one copy for all cells.
    if (!makes_voxel(item, x)) return 0;
    const std::uint32_t lines =
        store_voxel(store, item.span, context.settings, context.scene.frame.level(), context.arithmetic);
    if (item.span.last != x) advance(item.span, context.arithmetic);
    return lines;
}

}  // namespace raycell
