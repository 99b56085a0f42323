#include "pipeline/stages/precomputation.hpp"

#include <algorithm>

namespace raycell {

void Precomputation::take(LoadItem& item) {
    if (item.kind != LoadItem::Kind::polygon) {
        item_ = &item;  // broadcast: passed on in its order
        return;
    }
    const Environment& env = environment();
    trapezes_ = precompute(item.polygon, env.context.arithmetic, env.width(), env.height());
    const auto beside = [&](const Trapeze& t) {
        return t.rows.last < rows_.first || t.rows.first > rows_.last;
    };
    trapezes_.erase(std::remove_if(trapezes_.begin(), trapezes_.end(), beside), trapezes_.end());
    next_ = 0;
    surface_sent_ = false;
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
    if (!item_ && next_ < trapezes_.size() && !surface_sent_) {
        item_ = env.pools.loads.take();
        item_->kind = LoadItem::Kind::surface;
        static_cast<Surface&>(item_->trapeze) = trapezes_[0];
        surface_sent_ = true;
    }
    if (!item_ && next_ < trapezes_.size()) {
        item_ = env.pools.loads.take();
        item_->kind = LoadItem::Kind::trapeze;
        item_->trapeze = trapezes_[next_++];
        if (env.context.settings.display == Display::gouraud) {
            item_->intensities = shade_corners(item_->trapeze, env.context.scene, env.context.arithmetic);
        }
        ready_ = now + env.costs().precomputation_trapeze;
        work(now, env.costs().precomputation_trapeze);
        ++statistics_.items;
    }
    if (!item_) return now + 1;
    if (now < ready_) return ready_;
    if (!out->can_send(0, retry)) return retry;
    send_feed(*out.operator->(), *item_, env);
    item_ = nullptr;
    return now + 1;
}

}  // namespace raycell
