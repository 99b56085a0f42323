// A cell while the scene is loaded: spans and what is broadcast go through it from the west to the east.
#include "cells/cell.hpp"

namespace raycell {

void Cell::step_load(Cycle now) {
    if (!load_in_) return;
    LoadItem* item = loading_.work(*load_in_, x_, env_.costs(), now, wakeup_);
    if (!item) return;
    const bool last =
        LoadingUnit::ends_at(*item, x_, env_.width());  // before a span goes on to the next cell
    if (!last && router_.ask(Side::east, 0, 0, wakeup_) != Link::Room::free) return;
    record(now, CellEvent::load, std::uint32_t(item->kind), 0, std::uint32_t(item->kind));
    LoadingUnit::take(*item, x_, store_, env_.context);
    if (item->kind == LoadItem::Kind::end_of_scene) {
        ++env_.counters.cells_loaded;
        env_.counters.last_progress = now;
    }
    load_in_->pop(0);
    loading_.finish();
    if (last) {
        ++env_.counters.loads_delivered;
        env_.pools.loads.give_back(item);
    } else {
        ++env_.counters.load_hops;
        ++statistics_.load_hops;
        router_.send(Side::east, 0, Message(item), env_.cycles_for(env_.load_bits(*item)));
    }
    if (load_in_->front(0).kind != Message::Kind::none) want(now + 1);
}

}  // namespace raycell
