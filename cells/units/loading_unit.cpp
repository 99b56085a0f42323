#include "cells/units/loading_unit.hpp"

namespace raycell {

LoadItem* LoadingUnit::work(const LinkIn& from, int x, const CostTable& costs, Cycle now, Wakeup& wakeup) {
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

bool LoadingUnit::has_room(int most, Cycle cycles, Cycle now, Wakeup& wakeup) const {
    if (most == 0 || kept(cycles, now) < most) return true;
    wakeup.at(made_ - Cycle(most - 1) * cycles);
    return false;
}

bool LoadingUnit::closes(Cycle now, Wakeup& wakeup) {
    if (!closing_) return false;
    if (now < made_) {
        wakeup.at(made_);
        return false;
    }
    closing_ = false;
    return true;
}

bool LoadingUnit::ends_at(const LoadItem& item, int x, int width) {
    return item.kind == LoadItem::Kind::span ? item.span.last == x : x + 1 == width;
}

void LoadingUnit::take(LoadItem& item, int x, CellStore& store, const Context& context) {
    // Hardware latches broadcast messages in every cell; the model keeps one copy for all cells.
    if (!makes_voxel(item, x)) return;
    store_voxel(store, item.span, context.settings, context.scene.frame.level(), context.arithmetic);
    if (item.span.last != x) advance(item.span, context.arithmetic);
}

}  // namespace raycell
