"""The ray store: slots of hits that wait, their children and answers, and the jobs of the shading unit."""

from links import Answer, Packet
from rays import primary_ray
from shading import Setup, intensity_of, secondary_ray, shadow_ray, voxel_shadow_ray
from words import ZERO

ATTEMPTS = 250                                      # a back-off counts no further


class Slot:
    def __init__(self, number):
        self.number, self.state = number, "empty"   # to_set_up, in_setup, waiting, in_shading, to_answer
        self.packet = self.setup = self.child = self.result = None
        self.since = self.changed = 0               # the hit was accepted; its state began
        self.to_ask, self.awaited, self.lit = set(), set(), set()
        self.send_child, self.await_child = [False, False], [False, False]
        self.retry_at, self.attempts = [0, 0], [0, 0]
        self.colour = [[ZERO] * 3, [ZERO] * 3]

    def voxel(self):
        return self.packet.visit.hit[1]


def back_off(S, answer, attempt):
    """64 to 4096 cycles, and a jitter that is drawn from the ray's id."""
    base = S.cost("backoff") << min(attempt, 6)
    return base + drawn(S, answer.pixel << 32 | answer.branch, attempt) % base


def first_start(S, pixel):
    """Cycles after the phase's beginning."""
    within = S.option["start-within"]
    return drawn(S, pixel << 32, ATTEMPTS + 1) % within if within else 0


def drawn(S, ray, attempt):
    seed = S.option["seed"]
    h = (seed * 0x9e3779b97f4a7c15 ^ ray * 0xbf58476d1ce4e5b9 ^ attempt * 0x94d049bb133111eb) & 0xffffffffffffffff
    h = (h ^ h >> 31) * 0x7fb5d329728ea185 & 0xffffffffffffffff
    return h ^ h >> 27


class Store:
    def start_store(self):
        option = self.S.option
        self.shadows = option["shadows"]
        waits = self.shadows != "precast" and len(self.S.sources) > 0
        generations = option["max-depth"] + waits
        self.size = option["ray-store"]
        self.slots, self.free = [], []              # the slot that became free last is used first
        self.groups = 0 if option["slots"] == "free" else max(1, min(self.size, generations))
        self.used_by = [0] * self.groups
        self.own, self.primary_to_send, self.own_retry_at, self.own_attempts = None, False, 0, 0
        self.precast_next = 0
        self.job, self.job_slot, self.job_done = None, None, 0
        self.direct = self.direct_result = self.pixel = None
        self.voxel_lit, self.voxel_known, self.asked = [], [], []

    def begin_phase(self, phase, now):
        if self.phase == "load":
            self.voxel_lit = [set(range(len(self.S.lights))) for _ in self.voxels]
            self.voxel_known = [set() for _ in self.voxels]
        self.phase = phase
        self.primary_to_send = phase == "trace"
        self.own_retry_at = now + first_start(self.S, self.y * self.S.width + self.x)
        self.precast_next = 0
        self.asked = [set() for _ in self.voxels]
        self.moved += 1

    # Slots

    def group(self, generation):
        return min(generation, self.groups - 1)

    def has_room(self, generation):
        if sum(slot.state != "empty" for slot in self.slots) == self.size:
            return False
        if self.groups == 0:
            return True
        g, shared = self.group(generation), self.size - self.groups
        if self.S.option["slots"] == "nested":
            return all(sum(self.used_by[:k + 1]) < shared + 1 + k for k in range(g, self.groups))
        return self.used_by[g] == 0 or sum(max(0, used - 1) for used in self.used_by) < shared

    def allocate(self, generation):
        if self.groups:
            self.used_by[self.group(generation)] += 1
        if self.free:
            return self.slots[self.free.pop()]
        self.slots.append(Slot(len(self.slots)))
        return self.slots[-1]

    def release(self, slot):
        if self.groups:
            self.used_by[self.group(slot.packet.ray.generation)] -= 1
        slot.__init__(slot.number)
        self.free.append(slot.number)

    # Hits

    def accept_hit(self, packet, place, now):
        generation = packet.ray.generation
        room = self.has_room(generation)
        if self.port_used == now or (not room and self.S.option["recovery"] == "none"):
            return
        if not room:
            if self.send_answer(Answer("postponed", packet.ray), now):
                self.remove_from(place, now)
            return
        slot = self.allocate(generation)
        self.remove_from(place, now)
        self.port_used = now
        slot.state, slot.packet, slot.since, slot.changed = "to_set_up", packet, now, now

    def accept_direct(self, packet, place, now):
        """A hit that waits for nothing goes through the shading unit without a slot."""
        if self.job or any(self.complete(slot) for slot in self.slots):
            return
        self.remove_from(place, now)
        S, (t, index) = self.S, packet.visit.hit
        setup = Setup(S, packet.ray, t, self.voxels[index], self.x, self.y)
        lit = set() if self.shadows == "per-hit" else set(self.voxel_lit[index])
        self.direct, self.direct_result = packet, intensity_of(S, setup, lit, [[ZERO] * 3] * 2)
        self.job, self.job_done = "direct", now + setup.cycles(S) + setup.lit_cycles(S, lit, False)

    # The shading unit

    def complete(self, slot):
        if slot.state != "waiting" or slot.child or slot.to_ask or slot.awaited:
            return False
        if any(slot.send_child) or any(slot.await_child):
            return False
        return self.shadows != "memo" or self.voxel_known[slot.voxel()].issuperset(slot.setup.facing)

    def start_shading(self, now):
        if self.job:
            return
        S = self.S
        ready = [slot for slot in self.slots if self.complete(slot)]
        fresh = [slot for slot in self.slots if slot.state == "to_set_up"]
        if ready:
            slot = min(ready, key=lambda slot: slot.since)
            if self.shadows != "per-hit":
                slot.lit = set(self.voxel_lit[slot.voxel()])
            slot.result = intensity_of(S, slot.setup, slot.lit, slot.colour)
            slot.state, self.job = "in_shading", "shade"
            cycles = slot.setup.lit_cycles(S, slot.lit, True)
        elif fresh:
            slot = min(fresh, key=lambda slot: slot.since)
            t, index = slot.packet.visit.hit
            slot.setup = Setup(S, slot.packet.ray, t, self.voxels[index], self.x, self.y)
            slot.state, self.job = "in_setup", "set_up"
            cycles = slot.setup.cycles(S)
        else:
            return
        self.job_slot, self.job_done = slot, now + cycles
        self.moved += 1

    def finish_shading(self, now):
        if self.job in (None, "direct_answer") or now < self.job_done:
            return
        self.moved += 1
        if self.job == "direct":
            self.job = "direct_answer"              # the unit keeps the answer until it leaves
            return
        slot = self.job_slot
        if self.job == "set_up":
            facing = set(slot.setup.facing)
            if self.shadows == "per-hit":
                slot.to_ask, slot.awaited = set(facing), set(facing)
            elif self.shadows == "memo":
                slot.to_ask = facing - self.asked[slot.voxel()]
            slot.send_child, slot.await_child = list(slot.setup.sends), list(slot.setup.sends)
            slot.state = "waiting"
        else:
            slot.state = "to_answer"
        slot.changed, self.job = now, None

    # Rays that the cell sends

    def feed_own(self, now):
        S = self.S
        if self.own:
            return
        if self.phase == "precast":
            if self.precast_next < len(self.voxels) * len(S.lights):
                index, source = divmod(self.precast_next, len(S.lights))
                self.precast_next += 1
                self.own = Packet(voxel_shadow_ray(S, self.voxels, index, source, "precast", self.home))
        elif self.primary_to_send and now >= self.own_retry_at:
            self.primary_to_send = False
            self.own = Packet(primary_ray(S, self.x, self.y))
        self.moved += self.own is not None

    def feed_children(self, now):
        for slot in self.slots:
            if slot.state == "waiting" and not slot.child:
                ray = self.next_child(slot, now)
                if ray:
                    slot.child = Packet(ray)
                    self.moved += 1

    def next_child(self, slot, now):
        S, parent, index = self.S, slot.packet.ray, slot.voxel()
        while slot.to_ask:
            source = min(slot.to_ask)
            slot.to_ask.remove(source)
            self.moved += 1
            if self.shadows == "per-hit":
                return shadow_ray(S, parent, slot.setup, self.voxels[index], source, slot.number, self.home)
            if source not in self.asked[index]:
                self.asked[index].add(source)
                ray = voxel_shadow_ray(S, self.voxels, index, source, "memo", self.home)
                ray.pixel = parent.pixel
                return ray
        for child in (0, 1):
            if slot.send_child[child] and now >= slot.retry_at[child]:
                slot.send_child[child] = False
                return secondary_ray(S, parent, slot.setup, self.voxels[index], child, slot.number, self.home)
        return None

    # Answers that are home

    def deliver(self, answer, now):
        self.port_used = now
        kind, child = answer.ray_kind, answer.child
        if kind == "primary":
            if answer.kind == "postponed":
                self.primary_to_send = True
                self.own_retry_at = now + back_off(self.S, answer, self.own_attempts)
                self.own_attempts = min(self.own_attempts + 1, ATTEMPTS)
            else:
                self.pixel = (now, answer.colour)
        elif kind == "precast":
            self.voxel_lit[answer.slot].discard(child)
        elif kind == "memo":
            if answer.kind == "blocked":
                self.voxel_lit[answer.slot].discard(child)
            self.voxel_known[answer.slot].add(child)
        elif kind == "shadow":
            slot = self.slots[answer.slot]
            slot.awaited.discard(child)
            if answer.kind == "lit":
                slot.lit.add(child)
        else:
            slot = self.slots[answer.slot]
            if answer.kind == "postponed":
                slot.send_child[child] = True
                slot.retry_at[child] = now + back_off(self.S, answer, slot.attempts[child])
                slot.attempts[child] = min(slot.attempts[child] + 1, ATTEMPTS)
            else:
                slot.await_child[child], slot.colour[child] = False, answer.colour
