// Rays that a cell sends: its own, and the children of its slots (paper, section 3.2).
#include <algorithm>

#include "cells/cell.hpp"

namespace raycell {

RayPacket* Cell::launch(const Ray& ray, const Ray* parent) {
    RayPacket* packet = raycell::launch(ray, env_);
    if (env_.meters.observer) env_.meters.observer->launched(*this, env_.scheduler.now(), ray, parent);
    tell(env_.scheduler.now(), CellEvent::launch, ray.id, std::uint32_t(ray.kind));
    return packet;
}

void Cell::feed_own(Cycle now) {
    if (env_.draining) return;
    if (env_.phase == Phase::precast) {
        const auto next = injector_.next_precast(store_.voxels.size(), env_.context.lights.rays.size());
        if (!next) return;
        injector_.load(*launch(
            voxel_shadow_ray(env_.context, store_, next->voxel, next->source, RayKind::precast, x_, y_),
            nullptr));
        ++env_.meters.counters.rays.precast;
        return;
    }
    const auto number = injector_.primary_due(now, wakeup_);
    if (number) injector_.load(*launch(begin_primary(*number, injector_, env_, x_, y_), nullptr));
}

void Cell::feed_children(Cycle now) {
    if (env_.draining) return;
    feed_at_ = never;
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        Slot& slot = ray_store_[i];
        if (slot.state != Slot::State::waiting || slot.child) continue;
        const std::uint64_t to_ask = slot.to_ask;
        slot.child = next_child(slot, i, now);
        children_ += slot.child != nullptr;
        if (slot.to_ask != to_ask) look_to_shade_ = true;  // the slot may be complete now
    }
}

RayPacket* Cell::next_child(Slot& slot, std::uint32_t index, Cycle now) {
    const Ray& parent = slot.packet->ray;
    const CellHit& hit = slot.packet->visit.hit;
    if (slot.to_ask) {
        const unsigned source = unsigned(__builtin_ctzll(slot.to_ask));
        const std::uint64_t bit = std::uint64_t(1) << source;
        slot.to_ask &= ~bit;
        if (env_.context.settings.shadows == Shadows::memo) {
            if (asked_[hit.voxel] & bit) {  // another hit has already asked
                slot.wait = {now, Stall::shading};
                return next_child(slot, index, now);
            }
            asked_[hit.voxel] |= bit;
            ++env_.meters.counters.rays.shadow;
            Ray ray = voxel_shadow_ray(env_.context, store_, hit.voxel, source, RayKind::memo, x_, y_);
            ray.id = ray_id(pixel_of(parent.id), branch_of(ray.id),
                            sample_of_id(parent.id));  // its hops belong to this pixel
            return launch(ray, &parent);
        }
        ++env_.meters.counters.rays.shadow;
        Ray ray = shadow_ray(env_.context, store_, parent, hit, slot.setup, source, x_, y_);
        ray.slot = index;
        return launch(ray, &parent);
    }
    for (std::size_t child = 0; child < 2; ++child) {
        if (!slot.send_child[child]) continue;
        const Retry& retry = slot.retry[child];
        if (now < retry.at()) {
            want(retry.at());
            feed_at_ = std::min(feed_at_, retry.at());
            continue;
        }
        slot.send_child[child] = false;
        if (retry.attempts() == 0)
            ++(child == 0 ? env_.meters.counters.rays.reflected : env_.meters.counters.rays.refracted);
        Ray ray = child == 0 ? reflected_ray(env_.context, store_, parent, hit, slot.setup, x_, y_)
                             : refracted_ray(env_.context, store_, parent, hit, slot.setup, x_, y_);
        ray.slot = index;
        return launch(ray, &parent);
    }
    return nullptr;
}

}  // namespace raycell
