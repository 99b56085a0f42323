// Slots, children, answers and the shading unit of a cell (paper, sections 3.2 and 4.1).
#include <algorithm>

#include "cells/cell.hpp"

namespace raycell {
namespace {

constexpr std::uint8_t most_attempts = 250;

std::uint64_t jitter(std::uint64_t seed, std::uint64_t id, std::uint64_t attempt) {
    std::uint64_t h =
        seed * 0x9e3779b97f4a7c15ULL ^ id * 0xbf58476d1ce4e5b9ULL ^ attempt * 0x94d049bb133111ebULL;
    h ^= h >> 31;
    h *= 0x7fb5d329728ea185ULL;
    return h ^ h >> 27;
}

}  // namespace

Cycle Cell::backoff(std::uint64_t id, unsigned attempt) const {
    const Cycle base = env_.costs().backoff << std::min(attempt, 6U);
    return base + jitter(env_.machine.seed, id, attempt) % base;
}

RayPacket* Cell::launch(const Ray& ray, const Ray* parent) {
    RayPacket* packet = env_.pools.rays.take();
    packet->ray = ray;
    packet->launched = env_.scheduler.now();
    packet->wait = {env_.scheduler.now(), Stall::traversal};
    ++env_.counters.rays_sent;
    if (env_.observer) env_.observer->launched(*this, env_.scheduler.now(), ray, parent);
    tell(env_.scheduler.now(), CellEvent::launch, ray.id, std::uint32_t(ray.kind));
    return packet;
}

// ---- answers
// -------------------------------------------------------------------------------------------------

void Cell::deliver(const Answer& answer, Cycle now) {
    store_port_ = now;
    ++env_.counters.answers_delivered;
    record(now, CellEvent::deliver, std::uint32_t(answer.id), answer.id, std::uint32_t(answer.kind));
    if (answer.kind != Answer::Kind::postponed) env_.counters.last_progress = now;
    want(now + 1);
    const std::uint64_t bit = std::uint64_t(1) << answer.child;
    switch (answer.ray_kind) {
        case RayKind::primary: {
            if (answer.kind == Answer::Kind::postponed) {
                root_to_send_ = true;
                own_at_ = now + backoff(answer.id, own_attempts_);
                own_attempts_ = std::uint8_t(std::min<int>(own_attempts_ + 1, most_attempts));
                return;
            }
            Pixel& pixel = env_.picture.at(x_, y_);
            pixel.colour = answer.colour;
            pixel.cycle = std::uint32_t(now - env_.phase_start);
            root_waits_ = false;
            ++env_.counters.pixels_done;
            return;
        }
        case RayKind::precast:
            store_.lit[answer.slot] &= ~bit;
            return;
        case RayKind::memo:
            if (answer.kind == Answer::Kind::blocked) store_.lit[answer.slot] &= ~bit;
            store_.known[answer.slot] |= bit;
            for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {  // others may have waited for it too
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
    slot.wait = {now, Stall::shading};  // counts if it was the last answer missing
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
        slot.send_at[child] = now + backoff(answer.id, slot.attempts[child]);
        slot.attempts[child] = std::uint8_t(std::min<int>(slot.attempts[child] + 1, most_attempts));
        return;
    }
    slot.await_child[child] = false;
    slot.colour[child] = answer.colour;
}

// ---- own rays and children
// -----------------------------------------------------------------------------------

void Cell::feed_own(Cycle now) {
    if (env_.draining) return;
    if (env_.phase == Phase::precast) {
        const std::uint64_t sources = env_.context.scene.sources.size();
        if (precast_next_ >= store_.voxels.size() * sources) return;
        const std::uint32_t voxel = std::uint32_t(precast_next_ / sources);
        own_ = launch(voxel_shadow_ray(env_.context, store_, voxel, std::size_t(precast_next_ % sources),
                                       RayKind::precast, x_, y_),
                      nullptr);
        ++precast_next_;
        ++env_.counters.rays.precast;
        return;
    }
    if (!root_to_send_) return;
    if (now < own_at_) {
        want(own_at_);
        return;
    }
    if (!root_waits_) {
        ++env_.counters.rays.primary;
        record_background(env_.picture.at(x_, y_));
    }
    own_ = launch(primary_ray(env_.context, x_, y_), nullptr);
    root_to_send_ = false;
    root_waits_ = true;
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
        if (slot.to_ask != to_ask) look_to_shade_ = true;  // nothing left to ask may complete it
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
            if (asked_[hit.voxel] & bit) {  // another hit has asked already
                slot.wait = {now, Stall::shading};
                return next_child(slot, index, now);
            }
            asked_[hit.voxel] |= bit;
            ++env_.counters.rays.shadow;
            Ray ray = voxel_shadow_ray(env_.context, store_, hit.voxel, source, RayKind::memo, x_, y_);
            ray.id = ray_id(pixel_of(parent.id), branch_of(ray.id));  // its hops belong to this pixel
            return launch(ray, &parent);
        }
        ++env_.counters.rays.shadow;
        Ray ray = shadow_ray(env_.context, store_, parent, hit, slot.setup, source, x_, y_);
        ray.slot = index;
        return launch(ray, &parent);
    }
    for (std::size_t child = 0; child < 2; ++child) {
        if (!slot.send_child[child]) continue;
        if (now < slot.send_at[child]) {
            want(slot.send_at[child]);
            feed_at_ = std::min(feed_at_, slot.send_at[child]);
            continue;
        }
        slot.send_child[child] = false;
        if (slot.attempts[child] == 0)
            ++(child == 0 ? env_.counters.rays.reflected : env_.counters.rays.refracted);
        Ray ray = child == 0 ? reflected_ray(env_.context, store_, parent, hit, slot.setup, x_, y_)
                             : refracted_ray(env_.context, store_, parent, hit, slot.setup, x_, y_);
        ray.slot = index;
        return launch(ray, &parent);
    }
    return nullptr;
}

// ---- shading unit
// --------------------------------------------------------------------------------------------

bool Cell::complete(const Slot& slot) const {
    if (slot.state != Slot::State::waiting || slot.child || slot.to_ask || slot.awaited) return false;
    if (slot.send_child[0] || slot.send_child[1] || slot.await_child[0] || slot.await_child[1]) return false;
    if (env_.context.settings.shadows != Shadows::memo) return true;
    return (slot.setup.facing & ~store_.known[slot.packet->visit.hit.voxel]) == 0;
}

bool Cell::slot_complete() const {
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        if (complete(ray_store_[i])) return true;
    }
    return false;
}

bool Cell::accept_hit(RayPacket& packet, std::size_t place, Cycle now) {
    if (store_port_ == now) {
        want(now + 1);
        cause_ = Stall::store_port;
        return false;
    }
    const auto index = ray_store_.allocate(packet.ray.generation);
    if (!index) {
        if (env_.machine.recovery == Recovery::none) {
            cause_ = Stall::no_slot;
            return false;
        }
        return respond(packet, place, Answer::Kind::postponed, dvec3(0), now);
    }
    // Before the slot is filled: a child that hits its own cell comes from a slot of this same store.
    remove_from(place);
    store_port_ = now;
    Slot& slot = ray_store_[*index];
    slot.state = Slot::State::to_set_up;
    slot.packet = &packet;
    slot.since = slot.changed = now;
    slot.wait = {now, Stall::shading};
    slot_changed();
    ++env_.counters.slots_used;
    record(now, CellEvent::accept, std::uint32_t(packet.ray.id), packet.ray.id, *index);
    return true;
}

/// A hit that waits for nothing needs no slot.
bool Cell::accept_direct(RayPacket& packet, std::size_t place, Cycle now) {
    if (shading_.job != Shading::Job::idle || slot_complete()) {
        cause_ = Stall::shading;
        return false;
    }
    remove_from(place);
    begin_direct(packet, now);
    return true;
}

void Cell::start_shading(Cycle now) {
    // Finish before you begin: a shaded slot is a slot free again. Oldest first among equals.
    constexpr std::uint32_t none = ~std::uint32_t(0);
    std::uint32_t shade = none;
    std::uint32_t set_up = none;
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        const Slot& slot = ray_store_[i];
        if (complete(slot) && (shade == none || slot.since < ray_store_[shade].since)) shade = i;
        if (slot.state == Slot::State::to_set_up &&
            (set_up == none || slot.since < ray_store_[set_up].since)) {
            set_up = i;
        }
    }
    if (shade != none) {
        begin_shade(shade, now);
    } else if (set_up != none) {
        begin_set_up(set_up, now);
    } else {
        look_to_shade_ = false;
    }
}

void Cell::begin_shade(std::uint32_t index, Cycle now) {
    Slot& slot = ray_store_[index];
    const CellHit& hit = slot.packet->visit.hit;
    if (env_.context.settings.shadows != Shadows::per_hit) slot.lit = store_.lit[hit.voxel];
    slot.result = shade_hit(env_.context, slot.setup, store_.voxels[hit.voxel].object, slot.lit,
                            slot.colour[0], slot.colour[1]);
    slot.state = Slot::State::in_shading;
    settle(slot.wait, slot.packet->ray.id, now);
    slot.wait.cause = Stall::none;
    const std::uint32_t cycles =
        unit_cycles(shade_cycles(env_.context, slot.lit & slot.setup.facing, env_.costs()));
    shading_ = {Shading::Job::shade, index, now + cycles};
    env_.counters.shading_cycles += cycles;
    statistics_.shading_cycles += cycles;
    want(shading_.done);
}

void Cell::begin_set_up(std::uint32_t index, Cycle now) {
    Slot& slot = ray_store_[index];
    const RayPacket& packet = *slot.packet;
    slot.setup = set_up_hit(env_.context, store_, packet.ray, packet.visit.hit, x_, y_);
    if (packet.ray.kind == RayKind::primary) {
        record_first_hit(env_.picture.pixels[pixel_of(packet.ray.id)], slot.setup,
                         store_.voxels[packet.visit.hit.voxel].polygon);
    }
    slot.state = Slot::State::in_setup;
    settle(slot.wait, packet.ray.id, now);
    slot.wait.cause = Stall::none;
    const std::uint32_t cycles = unit_cycles(setup_cycles(env_.context, slot.setup, env_.costs()));
    shading_ = {Shading::Job::set_up, index, now + cycles};
    env_.counters.shading_cycles += cycles;
    statistics_.shading_cycles += cycles;
    want(shading_.done);
}

void Cell::begin_direct(RayPacket& packet, Cycle now) {
    tell(now, CellEvent::direct, packet.ray.id, 0);
    const CellHit& hit = packet.visit.hit;
    const HitSetup setup = set_up_hit(env_.context, store_, packet.ray, hit, x_, y_);
    const Voxel& voxel = store_.voxels[hit.voxel];
    if (packet.ray.kind == RayKind::primary) {
        record_first_hit(env_.picture.pixels[pixel_of(packet.ray.id)], setup, voxel.polygon);
    }
    const std::uint64_t lit = env_.context.settings.shadows == Shadows::per_hit ? 0 : store_.lit[hit.voxel];
    const std::uint32_t cycles = unit_cycles(setup_cycles(env_.context, setup, env_.costs()) +
                                             shade_cycles(env_.context, lit & setup.facing, env_.costs()));
    shading_ = {Shading::Job::direct, 0, now + cycles};
    direct_ = {&packet, shade_hit(env_.context, setup, voxel.object, lit, dvec3(0), dvec3(0))};
    env_.counters.shading_cycles += cycles;
    statistics_.shading_cycles += cycles;
    want(shading_.done);
}

void Cell::finish_shading(Cycle now) {
    if (shading_.job == Shading::Job::direct_answer) return;
    if (now < shading_.done) {
        want(shading_.done);
        return;
    }
    if (shading_.job == Shading::Job::direct) {
        shading_.job = Shading::Job::direct_answer;  // leaves in move_replies
        ++replies_;
        return;
    }
    Slot& slot = ray_store_[shading_.slot];
    if (shading_.job == Shading::Job::set_up) {
        const bool memo = env_.context.settings.shadows == Shadows::memo;
        if (env_.context.settings.shadows == Shadows::per_hit) slot.to_ask = slot.awaited = slot.setup.facing;
        if (memo) slot.to_ask = slot.setup.facing & ~asked_[slot.packet->visit.hit.voxel];
        slot.send_child[0] = slot.await_child[0] = slot.setup.reflects;
        slot.send_child[1] = slot.await_child[1] = slot.setup.refracts;
        slot.state = Slot::State::waiting;
        slot.wait = {now, Stall::shading};
    } else {
        slot.state = Slot::State::to_answer;
        ++replies_;
    }
    slot.changed = now;
    slot_changed();
    record(now, CellEvent::shade, shading_.slot, slot.packet->ray.id, shading_.slot);
    shading_.job = Shading::Job::idle;
}

void Cell::move_replies(Cycle now) {
    bool waits = false;
    bool went = false;
    if (shading_.job == Shading::Job::direct_answer) {
        Answer answer = answer_to(direct_.packet->ray, Answer::Kind::intensity);
        answer.colour = direct_.result;
        RayPacket* packet = direct_.packet;
        if (send_answer(answer, now)) {
            settle(direct_wait_, answer.id, now);
            direct_wait_.cause = Stall::none;
            ++env_.counters.rays_answered;
            env_.pools.rays.give_back(packet);
            shading_.job = Shading::Job::idle;
            --replies_;
            went = true;
        } else {
            stall(direct_wait_, cause_, answer.id, now);
            waits = true;
        }
    }
    for (std::uint32_t i = 0; i < ray_store_.touched(); ++i) {
        Slot& slot = ray_store_[i];
        if (slot.state != Slot::State::to_answer) continue;
        Answer answer = answer_to(slot.packet->ray, Answer::Kind::intensity);
        answer.colour = slot.result;
        const Wait wait = slot.wait;  // a local answer may be for a slot of this same store
        if (!send_answer(answer, now)) {
            stall(slot.wait, cause_, answer.id, now);
            waits = true;
            continue;
        }
        settle(wait, answer.id, now);
        ++env_.counters.rays_answered;
        release_slot(i, now);
        --replies_;
        went = true;
    }
    if (waits) blocked_ = true;
    // By what has moved, not by how often the cell has run: a cell that runs in every cycle does the same.
    if (went) {
        replies_first_ = false;
    } else if (waits && answer_moved_) {
        replies_first_ = true;
    }
}

void Cell::release_slot(std::uint32_t index, Cycle now) {
    Slot& slot = ray_store_[index];
    env_.counters.slot_cycles += now - slot.since;
    statistics_.slot_cycles += now - slot.since;
    --env_.counters.slots_used;
    const int generation = slot.packet->ray.generation;
    env_.pools.rays.give_back(slot.packet);
    ray_store_.release(index, generation);
}

}  // namespace raycell
