// Loading (paper, section 3.1): a cell latches what is broadcast and makes its voxels from the spans that
// cross it.
#include "cells/cell.hpp"

namespace raycell {

void Cell::step_load(Cycle now) {
    if (!load_in_) return;
    const Message message = load_in_->front(0);
    if (message.kind != Message::Kind::load) return;
    if (load_item_ != message.load) {  // just arrived: the cell works on it for so long
        load_item_ = message.load;
        const bool makes_voxel = load_item_->kind == LoadItem::Kind::span && load_item_->span.x == x_;
        load_done_ = now + (makes_voxel ? env_.costs().load_voxel : env_.costs().load_forward);
    }
    if (now < load_done_) {
        want(load_done_);
        return;
    }
    LoadItem& item = *load_item_;
    const bool last = drops(item);  // before a span goes on to the next cell
    Link* east = out_[std::size_t(Side::east)];
    if (!last && !east->can_send(0, next_)) return;
    record(now, CellEvent::load, std::uint32_t(item.kind), 0, std::uint32_t(item.kind));
    take_load(item);
    load_in_->pop(0);
    load_item_ = nullptr;
    if (last) {
        ++env_.counters.loads_delivered;
        env_.pools.loads.give_back(&item);
    } else {
        ++env_.counters.load_hops;
        ++statistics_.load_hops;
        east->send(0, Message(&item), env_.cycles_for(env_.load_bits(item)));
    }
    if (load_in_->front(0).kind != Message::Kind::none) want(now + 1);
}

/// Whether a load message ends here.
bool Cell::drops(const LoadItem& item) const {
    return item.kind == LoadItem::Kind::span ? item.span.last == x_ : x_ + 1 == env_.width();
}

void Cell::take_load(LoadItem& item) {
    switch (item.kind) {
        case LoadItem::Kind::span:
            if (item.span.x != x_) break;  // not there yet
            store_voxel(store_, item.span, env_.context.settings, env_.context.scene.frame.level(),
                        env_.context.arithmetic);
            if (item.span.last != x_) advance(item.span, env_.context.arithmetic);
            break;
        case LoadItem::Kind::end_of_scene:
            ++env_.counters.cells_loaded;
            env_.counters.last_progress = env_.scheduler.now();
            break;
        // Latched in hardware; the model keeps one copy for all cells.
        case LoadItem::Kind::setup:
        case LoadItem::Kind::features:
        case LoadItem::Kind::polygon:
        case LoadItem::Kind::trapeze:
            break;
    }
}

}  // namespace raycell
