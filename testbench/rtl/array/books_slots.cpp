// The ray store of an RTL cell in the array: hits that take a slot, their children, jobs of the shading unit,
// replies. The array's own cell keeps the slots, and its units say what should have come of each job.
#include "testbench/rtl/array/books.hpp"

namespace raycell {

Slot& RtlBooks::slot_at(int index) const {
    RayStore& store = cell_.ray_store();
    if (index < 0 || std::uint32_t(index) >= store.touched())
        fail("slot " + std::to_string(index) + " acts, which holds nothing");
    return store[std::uint32_t(index)];
}

// ---- hits

void RtlBooks::accept(RayPacket& packet, const rtl::CellAct& act) {
    const std::uint64_t id = packet.ray.id;
    if (port_used_ == now()) disagree("ray " + ray_name(id) + " takes a slot; the store's port was used");
    const auto index = cell_.ray_store().allocate(packet.ray.generation);
    if (!index || int(*index) != act.slot)
        fail("ray " + ray_name(id) + " takes slot " + std::to_string(act.slot) + ", expected " +
             (index ? "slot " + std::to_string(*index) : "to be postponed"));
    remove_from(act.place);
    port_used_ = now();
    Slot& slot = cell_.ray_store()[*index];
    slot.state = Slot::State::to_set_up;
    slot.packet = &packet;
    slot.since = slot.changed = now();
    slot.wait = {now(), Stall::shading};
    ++env_.meters.counters.slots_used;
    record(CellEvent::accept, std::uint32_t(id), id, *index);
}

void RtlBooks::postpone(RayPacket& packet, const rtl::CellAct& act) {
    const std::uint64_t id = packet.ray.id;
    if (cell_.ray_store().has_room(packet.ray.generation))
        disagree("ray " + ray_name(id) + " is postponed; a slot is free");
    const Answer notice = answer_to(packet.ray, Answer::Kind::postponed);
    leave(notice, act.to);
    cell_.meter().postponed(env_.meters.counters);
    env_.meters.ledger.add(packet, cell_.x(), cell_.y(), now());
    if (env_.phase == Phase::trace) ++env_.picture.pixels[pixel_of(id)].postponed;
    record(CellEvent::postpone, std::uint32_t(id), id, 0);
    remove_from(act.place);
    env_.pools.rays.give_back(&packet);
}

// ---- children

void RtlBooks::launch_child(int index) {
    Slot& slot = slot_at(index);
    if (slot.state != Slot::State::waiting || slot.child)
        fail("slot " + std::to_string(index) + " makes a child; it can't have one now");
    const Ray& parent = slot.packet->ray;
    Ray ray = next_child(slot);
    ray.slot = std::uint32_t(index);
    slot.child = raycell::launch(ray, env_);
    if (env_.meters.observer) env_.meters.observer->launched(cell_, now(), ray, &parent);
    tell(CellEvent::launch, ray.id, std::uint32_t(ray.kind));
}

Ray RtlBooks::next_child(Slot& slot) {
    const Ray& parent = slot.packet->ray;
    const CellHit& hit = slot.packet->visit.hit;
    RayCounts& rays = env_.meters.counters.rays;
    if (slot.to_ask) {
        const auto source = unsigned(__builtin_ctzll(slot.to_ask));
        slot.to_ask &= ~(std::uint64_t(1) << source);
        ++rays.shadow;
        return shadow_ray(env_.context, cell_.store(), parent, hit, slot.setup, source, cell_.x(), cell_.y());
    }
    for (std::size_t child = 0; child < 2; ++child) {
        if (!slot.send_child[child] || now() < slot.retry[child].at()) continue;
        slot.send_child[child] = false;
        if (slot.retry[child].attempts() == 0) ++(child == 0 ? rays.reflected : rays.refracted);
        return child == 0
                   ? reflected_ray(env_.context, cell_.store(), parent, hit, slot.setup, cell_.x(), cell_.y())
                   : refracted_ray(env_.context, cell_.store(), parent, hit, slot.setup, cell_.x(),
                                   cell_.y());
    }
    fail("a child of ray " + ray_name(parent.id) + " is made; expected none now");
}

void RtlBooks::deliver_to_slot(const Answer& answer) {
    Slot& slot = slot_at(int(answer.slot));
    slot.wait = {now(), Stall::shading};
    if (answer.ray_kind == RayKind::shadow) {
        const std::uint64_t bit = std::uint64_t(1) << answer.child;
        slot.awaited &= ~bit;
        if (answer.kind == Answer::Kind::lit) slot.lit |= bit;
        return;
    }
    const std::size_t child = answer.child;
    if (answer.kind == Answer::Kind::postponed) {
        slot.send_child[child] = true;
        slot.retry[child].postponed(env_.machine, answer.id, now());
        return;
    }
    slot.await_child[child] = false;
    slot.colour[child] = answer.colour;
}

// ---- jobs

void RtlBooks::begin_job(const rtl::CellAct& act) {
    using Job = ShadingUnit::Job;
    const Job job = act.first ? Job::set_up : Job::shade;
    Slot& slot = slot_at(act.slot);
    const auto next = ShadingUnit::choose(cell_.ray_store(), cell_.store(), env_.settings.shadows);
    if (!cell_.shading().idle() || !next || int(next->slot) != act.slot || next->job != job)
        fail("a job of slot " + std::to_string(act.slot) + " begins; expected " +
             (next ? "one of slot " + std::to_string(next->slot) : "none"));
    const Ray& ray = slot.packet->ray;
    std::uint32_t cycles = 0;
    if (job == Job::shade) {
        cycles = ShadingUnit::shade(slot, cell_.store(), env_.context, env_.costs());
    } else {
        cycles = ShadingUnit::set_up(slot, cell_.store(), env_.context, env_.costs(), cell_.x(), cell_.y());
        if (shows_first_hit(ray))
            record_first_hit(env_.picture.pixels[pixel_of(ray.id)], slot.setup,
                             cell_.store().voxels[slot.packet->visit.hit.voxel].polygon);
    }
    settle(slot.wait, ray.id);
    slot.wait.cause = Stall::none;
    cell_.shading().start(job, next->slot, now() + cycles);
    cell_.meter().shaded(env_.meters.counters, cycles);
}

void RtlBooks::end_job(const rtl::CellAct& act) {
    ShadingUnit& unit = cell_.shading();
    if (unit.idle() || int(unit.slot()) != act.slot)
        fail("a job of slot " + std::to_string(act.slot) + " ends, which did not begin");
    if (unit.done() != now())
        disagree("the job of slot " + std::to_string(act.slot) + " ends, expected in cycle " +
                 std::to_string(unit.done()));
    Slot& slot = slot_at(act.slot);
    if (unit.job() == ShadingUnit::Job::set_up) {
        ShadingUnit::await(slot, env_.settings.shadows, 0);
        slot.wait = {now(), Stall::shading};
    } else {
        slot.state = Slot::State::to_answer;
    }
    slot.changed = now();
    record(CellEvent::shade, unit.slot(), slot.packet->ray.id, unit.slot());
    unit.free();
}

// ---- replies

void RtlBooks::reply(const rtl::CellAct& act) {
    Slot& slot = slot_at(act.slot);
    if (slot.state != Slot::State::to_answer)
        fail("slot " + std::to_string(act.slot) + " replies; it has no reply");
    Answer answer = answer_to(slot.packet->ray, Answer::Kind::intensity);
    answer.colour = slot.result;
    if (act.waits) return wait(slot.wait, answer.id, act, true);
    const Wait waited = slot.wait;  // copied: a local answer may change a slot of this same store
    leave(answer, act.to);
    settle(waited, answer.id);
    ++env_.meters.counters.rays_answered;
    cell_.meter().slot_left(env_.meters.counters, now() - slot.since);
    const int generation = slot.packet->ray.generation;
    env_.pools.rays.give_back(slot.packet);
    cell_.ray_store().release(std::uint32_t(act.slot), generation);
}

/// An answer of this cell's leaves at once.
void RtlBooks::leave(const Answer& answer, int to) {
    ++env_.meters.counters.answers_sent;
    tell(CellEvent::answer, answer.id, std::uint32_t(answer.kind));
    if (to == rtl::to_home) return deliver(answer);
    Answer* copy = env_.pools.answers.take();
    *copy = answer;
    send(*copy, to);
}

}  // namespace raycell
