"""What stands in buffers, the buffers, and the links that they belong to."""

from words import ZERO


class Packet:
    """A ray in a place: untested, in test, or decided."""

    def __init__(self, ray):
        self.ray, self.stage = ray, "untested"
        self.visit = self.need = self.decided = None


class Answer:
    """intensity, lit, blocked or postponed"""

    def __init__(self, kind, ray, colour=None):
        self.kind, self.ray_kind, self.pixel, self.branch = kind, ray.kind, ray.pixel, ray.branch
        self.home, self.slot, self.child = ray.home, ray.slot, ray.child
        self.colour = colour or [ZERO] * 3


class InBuffer:
    """Messages of one side and class, each with the first cycle in which it can be seen."""

    def __init__(self):
        self.messages = []

    def head(self, now):
        return self.messages[0][0] if self.messages and self.messages[0][1] <= now else None

    def arrival(self):
        return self.messages[0][1]


class OutLink:
    def __init__(self, classes, depth):
        self.depth, self.wires_free = depth, 0
        self.held = [0] * classes                   # places taken at the far end

    def can_send(self, index, now):
        return self.held[index] < self.depth and self.wires_free <= now

    def send(self, index, cycles, now):
        self.held[index] += 1
        self.wires_free = now + cycles
