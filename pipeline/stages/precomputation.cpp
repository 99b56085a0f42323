#include "pipeline/stages/precomputation.hpp"

namespace raycell {

void Precomputation::take(LoadItem& item) {
    if (item.kind != LoadItem::Kind::polygon) {
        item_ = &item;  // broadcast: passed on in its order
        return;
    }
    trapezes_ = precompute(item.polygon, environment().context.arithmetic);
    next_ = 0;
    environment().pools.loads.give_back(&item);
}

Cycle Precomputation::step(Cycle now) {
    Environment& env = environment();
    Cycle retry = never;
    if (!item_ && next_ == trapezes_.size()) {
        const Message message = in->front(0);
        if (message.kind != Message::Kind::load) return never;
        in->pop(0);
        take(*message.load);
        ready_ = now + 1;
    }
    if (!item_ && next_ < trapezes_.size()) {
        item_ = env.pools.loads.take();
        item_->kind = LoadItem::Kind::trapeze;
        item_->trapeze = trapezes_[next_++];
        if (env.context.settings.display == Display::gouraud) {
            item_->intensities = shade_corners(item_->trapeze, env.context.scene);
        }
        ready_ = now + env.costs().precomputation_trapeze;
        work(now, env.costs().precomputation_trapeze);
        ++statistics_.items;
    }
    if (!item_) return now + 1;
    if (now < ready_) return ready_;
    if (!out->can_send(0, retry)) return retry;
    out->send(0, Message(item_), env.cycles_for(env.load_bits(*item_)));
    item_ = nullptr;
    return now + 1;
}

}  // namespace raycell
