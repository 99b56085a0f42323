// Hits go into a slot or straight into the shading unit; the unit's jobs; the replies that leave (paper,
// sections 3.2 and 4.1).
#include "cells/cell.hpp"

namespace raycell {

bool Cell::accept_hit(RayPacket& packet, std::size_t place, Cycle now) {
    if (env_.machine.recovery == Recovery::none && !ray_store_.has_room(packet.ray.generation)) {
        cause_ = Stall::no_slot;  // named before store_port: the store may stay full for long
        return false;
    }
    if (store_port_ == now) {
        want(now + 1);
        cause_ = Stall::store_port;
        return false;
    }
    const auto index = ray_store_.allocate(packet.ray.generation);
    if (!index) return postpone(packet, place, now);
    // Removed before the slot is filled: a child that hits its own cell comes from a slot of this same store.
    remove_from(place);
    store_port_ = now;
    Slot& slot = ray_store_[*index];
    slot.state = Slot::State::to_set_up;
    slot.packet = &packet;
    slot.since = slot.changed = now;
    slot.wait = {now, Stall::shading};
    slot_changed();
    ++env_.meters.counters.slots_used;
    record(now, CellEvent::accept, std::uint32_t(packet.ray.id), packet.ray.id, *index);
    return true;
}

/// A hit that waits for no other ray needs no slot.
bool Cell::accept_direct(RayPacket& packet, std::size_t place, Cycle now) {
    if (!shading_.idle() || slot_complete()) {
        cause_ = Stall::shading;
        return false;
    }
    remove_from(place);
    begin_direct(packet, now);
    return true;
}

void Cell::start_shading(Cycle now) {
    const auto next = ShadingUnit::choose(ray_store_, store_, env_.settings.shadows);
    if (!next) {
        look_to_shade_ = false;
        return;
    }
    Slot& slot = ray_store_[next->slot];
    const Ray& ray = slot.packet->ray;
    std::uint32_t cycles = 0;
    if (next->job == ShadingUnit::Job::shade) {
        cycles = ShadingUnit::shade(slot, store_, env_.context, env_.costs());
    } else {
        cycles = ShadingUnit::set_up(slot, store_, env_.context, env_.costs(), x_, y_);
        if (shows_first_hit(ray)) {
            record_first_hit(env_.picture.pixels[pixel_of(ray.id)], slot.setup,
                             store_.voxels[slot.packet->visit.hit.voxel].polygon);
        }
    }
    settle(slot.wait, ray.id, now);
    slot.wait.cause = Stall::none;
    use_shading_unit(next->job, next->slot, cycles, now);
}

void Cell::begin_direct(RayPacket& packet, Cycle now) {
    tell(now, CellEvent::direct, packet.ray.id, 0);
    const CellHit& hit = packet.visit.hit;
    const HitSetup setup = set_up_hit(env_.context, store_, packet.ray, hit, x_, y_);
    if (shows_first_hit(packet.ray)) {
        record_first_hit(env_.picture.pixels[pixel_of(packet.ray.id)], setup,
                         store_.voxels[hit.voxel].polygon);
    }
    const std::uint32_t cycles = shading_.direct(packet, setup, store_, env_.context, env_.costs());
    use_shading_unit(ShadingUnit::Job::direct, 0, cycles, now);
}

void Cell::use_shading_unit(ShadingUnit::Job job, std::uint32_t slot, std::uint32_t cycles, Cycle now) {
    cycles = unit_cycles(cycles);
    shading_.start(job, slot, now + cycles);
    meter_.shaded(env_.meters.counters, cycles);
    want(shading_.done());
}

void Cell::finish_shading(Cycle now) {
    using Job = ShadingUnit::Job;
    if (shading_.job() == Job::direct_answer || !shading_.finished(now, wakeup_)) return;
    if (shading_.job() == Job::direct) {
        shading_.hold_answer();  // the reply leaves in move_replies()
        ++replies_;
        return;
    }
    Slot& slot = ray_store_[shading_.slot()];
    if (shading_.job() == Job::set_up) {
        const bool memo = env_.settings.shadows == Shadows::memo;
        ShadingUnit::await(slot, env_.settings.shadows, memo ? asked_[slot.packet->visit.hit.voxel] : 0);
        slot.wait = {now, Stall::shading};
    } else {
        slot.state = Slot::State::to_answer;
        ++replies_;
    }
    slot.changed = now;
    slot_changed();
    record(now, CellEvent::shade, shading_.slot(), slot.packet->ray.id, shading_.slot());
    shading_.free();
}

void Cell::move_replies(Cycle now) {
    bool waits = false;
    bool went = false;
    if (shading_.job() == ShadingUnit::Job::direct_answer) {
        RayPacket* packet = shading_.direct_ray();
        Answer answer = answer_to(packet->ray, Answer::Kind::intensity);
        answer.colour = shading_.direct_result();
        if (send_answer(answer, now)) {
            settle(shading_.direct_wait(), answer.id, now);
            shading_.direct_wait().cause = Stall::none;
            ++env_.meters.counters.rays_answered;
            env_.pools.rays.give_back(packet);
            shading_.free();
            --replies_;
            went = true;
        } else {
            stall(shading_.direct_wait(), cause_, answer.id, now);
            waits = true;
        }
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        Slot& slot = ray_store_[i];
        if (slot.state != Slot::State::to_answer) continue;
        Answer answer = answer_to(slot.packet->ray, Answer::Kind::intensity);
        answer.colour = slot.result;
        const Wait wait = slot.wait;  // copied: a local answer may change a slot of this same store
        if (!send_answer(answer, now)) {
            stall(slot.wait, cause_, answer.id, now);
            waits = true;
            continue;
        }
        settle(wait, answer.id, now);
        ++env_.meters.counters.rays_answered;
        release_slot(i, now);
        --replies_;
        went = true;
    }
    if (waits) blocked_ = true;
    // The turn changes with messages moved, not with steps run, so that a cell that runs in every cycle does
    // the same.
    if (went) {
        replies_first_ = false;
    } else if (waits && answer_moved_) {
        replies_first_ = true;
    }
}

void Cell::release_slot(std::uint32_t index, Cycle now) {
    Slot& slot = ray_store_[index];
    meter_.slot_left(env_.meters.counters, now - slot.since);
    const int generation = slot.packet->ray.generation;
    env_.pools.rays.give_back(slot.packet);
    ray_store_.release(index, generation);
}

}  // namespace raycell
