"""One cell, cycle by cycle: its places, the traversal units, the router, ages."""

from links import Answer, InBuffer, OutLink, Packet
from loading import Loading
from rays import ANSWERS, EAST, NORTH, SOUTH, WEST, cross, move_along, need_of, visit
from store import Store

EPOCH, BOUND = 8192, 65536                          # ages count in epochs; the bound on starvation


class Cell(Store, Loading):
    """`watcher` is told what the cell does: take(now, side, class), out(now, side, class, message)."""

    def __init__(self, S, x, y, sides, wire, watcher):
        self.S, self.x, self.y, self.home = S, x, y, (x, y)
        self.wire, self.watcher = wire, watcher
        networks = S.option["networks"]
        self.answers = ANSWERS[networks]
        classes = range(self.answers + 1)
        self.inputs = {(side, index): InBuffer() for side in sides for index in classes}
        self.outputs = {side: OutLink(len(classes), S.option["buffer"]) for side in sides}
        self.ray_inputs = [(side, index) for side, index in sorted(self.inputs) if S.carries_rays(index, side)]
        self.answer_inputs = [side for side in range(4) if side in sides]
        self.voxels = []
        self.phase, self.draining = "load", False
        self.in_test, self.next_place = [], 0       # [(packet, when its test is over)]
        self.port_used, self.replies_first = None, False
        self.moved = 0                              # grows with everything that the cell does
        self.start_store()
        self.start_loading()

    # Places of rays, in the order of their numbers.

    def places(self):
        return len(self.ray_inputs) + 1 + len(self.slots)

    def packet_at(self, place, now):
        n = len(self.ray_inputs)
        if place < n:
            head = self.inputs[self.ray_inputs[place]].head(now)
            return head if isinstance(head, Packet) else None
        return self.own if place == n else self.slots[place - n - 1].child

    def remove_from(self, place, now):
        n = len(self.ray_inputs)
        self.moved += 1
        if place < n:
            self.inputs[self.ray_inputs[place]].messages.pop(0)
            self.watcher.take(now, *self.ray_inputs[place])
        elif place == n:
            self.own = None
        else:
            self.slots[place - n - 1].child = None

    # A cycle. Each part sees what those before it have done.

    def step(self, now):
        if self.phase == "load":
            self.load(now)
            return
        self.answer_moved, self.sides_done = False, set()
        for packet, done in self.in_test:
            if now >= done:
                packet.stage, packet.decided = "decided", now
                self.moved += 1
        self.in_test = [test for test in self.in_test if now < test[1]]
        self.finish_shading(now)
        self.move_overdue(now)
        if self.replies_first:
            self.move_replies(now)
            self.move_answers(now)
        else:
            self.move_answers(now)
            self.move_replies(now)
        if not self.draining:
            self.feed_own(now)
            self.feed_children(now)
        self.move_rays(now)
        self.start_test(now)
        self.start_shading(now)

    def wakes(self, now):
        """Cycles after `now` in which the cell may do something that it can't do yet."""
        times = [self.job_done, self.own_retry_at, self.load_done, now - now % EPOCH + EPOCH]
        if self.phase == "load":
            times += self.kept
        times += [done for _, done in self.in_test]
        times += [link.wires_free for link in self.outputs.values()]
        for slot in self.slots:
            times += slot.retry_at
        route = self.S.cost("route_return")
        for buffer in list(self.inputs.values()) + [self.load_input]:
            if buffer.messages:
                times += [buffer.arrival(), buffer.arrival() + route]
        return [time for time in times if time > now]

    def start_test(self, now):
        """Round robin over the places, from the one behind the last that was tested on."""
        count = self.places()
        start = self.next_place if self.next_place < count else 0
        for place in list(range(start, count)) + list(range(start)):
            if len(self.in_test) == self.S.option["traversal-units"]:
                return
            packet = self.packet_at(place, now)
            if packet and packet.stage == "untested":
                packet.visit = visit(packet.ray, self.voxels, self.S)
                packet.need = need_of(packet.ray, packet.visit, self.voxels, self.S, self.x, self.y)
                packet.stage, self.next_place = "in test", place + 1
                self.in_test.append((packet, now + packet.visit.cycles(self.S)))
                self.moved += 1

    def decided(self, now):
        """(since, place) of rays that wait to move, oldest decision first."""
        packets = [(place, self.packet_at(place, now)) for place in range(self.places())]
        return sorted((packet.decided, place) for place, packet in packets if packet and packet.stage == "decided")

    def move_rays(self, now):
        waiting = [(place, self.packet_at(place, now)) for _, place in self.decided(now)]
        for place, packet in waiting:
            self.move_ray(packet, place, now)

    def move_ray(self, packet, place, now):
        """A ray that can't move now stays in its place and tries again."""
        ray, need = packet.ray, packet.need
        if need.kind == "output":
            if self.outputs[need.side].can_send(need.index, now):
                self.remove_from(place, now)
                if not need.over_border:
                    cross(ray, packet.visit.crossing, self.S)
                self.send(need.side, need.index, ray, now)
        elif need.kind == "response":
            if self.send_answer(Answer(need.answer, ray, self.S.background if need.lost else None), now):
                self.remove_from(place, now)
        elif need.kind == "nothing":
            self.remove_from(place, now)
        elif need.kind == "border_walk":
            move_along(ray, packet.visit.t_leave, self.S)
            ray.outside, packet.stage = True, "untested"
            self.moved += 1
        elif need.kind == "slot":
            self.accept_hit(packet, place, now)
        else:
            self.accept_direct(packet, place, now)

    def send(self, side, index, message, now):
        cycles = -(-self.wire.length(message) // self.S.option["link-bits"])
        self.outputs[side].send(index, cycles, now)
        self.watcher.out(now, side, index, cycles, message)
        self.moved += 1

    # Answers: along x, then along y.

    def way_home(self, answer):
        x, y = answer.home
        if x != self.x:
            return EAST if x > self.x else WEST
        if y != self.y:
            return SOUTH if y > self.y else NORTH
        return None

    def send_answer(self, answer, now):
        """False: it can't leave in this cycle."""
        side = self.way_home(answer)
        if side is None:
            if self.port_used == now:
                return False
            self.deliver(answer, now)
        else:
            if not self.outputs[side].can_send(self.answers, now):
                return False
            self.send(side, self.answers, answer, now)
        self.moved += 1
        return True

    def head_answer(self, side, now):
        head = self.inputs[side, self.answers].head(now)
        return head if isinstance(head, Answer) else None

    def move_answers(self, now):
        sides = [side for side in self.answer_inputs if side not in self.sides_done and self.head_answer(side, now)]
        for side in sorted(sides, key=lambda side: self.inputs[side, self.answers].arrival()):
            self.move_answer(side, now)

    def ready_since(self, side):
        return self.inputs[side, self.answers].arrival() + self.S.cost("route_return")

    def move_answer(self, side, now):
        buffer = self.inputs[side, self.answers]
        if now < self.ready_since(side) or not self.send_answer(buffer.head(now), now):
            return False
        buffer.messages.pop(0)
        self.watcher.take(now, side, self.answers)
        self.answer_moved = True
        return True

    def move_replies(self, now):
        """The cell's own: of the shading unit, then of the slots."""
        waits = went = False
        if self.job == "direct_answer":
            if self.send_answer(Answer("intensity", self.direct.ray, self.direct_result), now):
                self.job, went = None, True
            else:
                waits = True
        for slot in self.slots:
            if slot.state == "to_answer":
                if self.send_answer(Answer("intensity", slot.packet.ray, slot.result), now):
                    self.release(slot)
                    went = True
                else:
                    waits = True
        if went:
            self.replies_first = False
        elif waits and self.answer_moved:
            self.replies_first = True

    def move_overdue(self, now):
        bound = now - now % EPOCH - BOUND           # older than this: overdue
        if bound <= 0:
            return
        waiting = [(self.ready_since(side), 0, side) for side in self.answer_inputs if self.head_answer(side, now)]
        if self.job == "direct_answer":
            waiting.append((self.job_done, 1, 0))
        waiting += [(slot.changed, 1, 0) for slot in self.slots if slot.state == "to_answer"]
        waiting += [(since, 2, place) for since, place in self.decided(now)]
        for since, kind, index in sorted(waiting):
            if since >= bound:
                break
            if kind == 0:
                if self.move_answer(index, now):
                    self.sides_done.add(index)
            elif kind == 1:
                self.move_replies(now)
            else:
                self.move_ray(self.packet_at(index, now), index, now)
