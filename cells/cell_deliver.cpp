// Answers that have come home go to the pixel, to the slot that waits for them, or to a voxel's shadow bits
// (paper, sections 3.2 and 4.1).
#include "cells/cell.hpp"

namespace raycell {

void Cell::deliver(const Answer& answer, Cycle now) {
    store_port_ = now;
    meter_.delivered(env_.meters.counters, answer.kind, now);
    record(now, CellEvent::deliver, std::uint32_t(answer.id), answer.id, std::uint32_t(answer.kind));
    want(now + 1);
    const std::uint64_t bit = std::uint64_t(1) << answer.child;
    switch (answer.ray_kind) {
        case RayKind::primary:
            end_primary(answer, injector_, env_, x_, y_);
            return;
        case RayKind::precast:
            store_.lit[answer.slot] &= ~bit;
            return;
        case RayKind::memo:
            if (answer.kind == Answer::Kind::blocked) store_.lit[answer.slot] &= ~bit;
            store_.known[answer.slot] |= bit;
            for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {  // other slots may wait for it too
                Slot& slot = ray_store_[i];
                if (slot.state == Slot::State::waiting && slot.packet->visit.hit.voxel == answer.slot)
                    slot.wait = {now, Stall::shading};
            }
            slot_changed();
            return;
        case RayKind::reflected:
        case RayKind::refracted:
        case RayKind::shadow:
            deliver_to_slot(answer, now);
            return;
    }
}

void Cell::deliver_to_slot(const Answer& answer, Cycle now) {
    Slot& slot = ray_store_[answer.slot];
    slot.wait = {now, Stall::shading};  // counts only if this was the last missing answer
    slot_changed();
    if (answer.ray_kind == RayKind::shadow) {
        const std::uint64_t bit = std::uint64_t(1) << answer.child;
        slot.awaited &= ~bit;
        if (answer.kind == Answer::Kind::lit) slot.lit |= bit;
        return;
    }
    const std::size_t child = answer.child;
    if (answer.kind == Answer::Kind::postponed) {
        slot.send_child[child] = true;
        slot.retry[child].postponed(env_.machine, answer.id, now);
        return;
    }
    slot.await_child[child] = false;
    slot.colour[child] = answer.colour;
}

}  // namespace raycell
