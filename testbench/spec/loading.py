"""The loading units: a message at a time, from the west to the east."""

from links import InBuffer
from rays import EAST, WEST
from voxels import store_voxel


class LoadMessage:
    """setup, features or end_of_scene: passed on as it is. `number`: of the object that features are of."""

    def __init__(self, kind, words, bits):
        self.kind, self.text, self.bits = kind, words, bits
        self.number = int(words[0]) if kind == "features" else None

    def words(self):
        return self.text


class Loading:
    def start_loading(self):
        # In the first column over a link of its own.
        self.load_input = self.inputs[WEST, 0] if WEST in self.outputs and self.x > 0 else InBuffer()
        self.loading, self.load_done = None, 0
        self.kept = []                              # when the voxels of the spans kept are made, in order
        self.object = None                          # whose features have come last

    def load(self, now):
        buffer = self.load_input
        item = buffer.head(now)
        if item is None:
            return
        span = item.kind == "span"
        makes = span and item.x1 == self.x
        if self.loading is not item:
            self.loading = item
            self.load_done = now + self.S.cost("load_advance" if makes else "load_forward")
            self.moved += 1
        ends = (item.last if span else self.S.width - 1) == self.x
        if now < self.load_done or makes and not self.has_room(now):
            return
        if not (ends or self.outputs[EAST].can_send(0, now)):
            return
        if makes:
            begins = max(now, self.made_until(self.S.option["loading-units"] - 1))
            self.kept = [made for made in self.kept if made > now] + [begins + self.S.cost("load_" + self.S.option["hit"])]
            store_voxel(self.S, self.voxels, item, self.object)
            if not ends:
                item.advance()
        if item.kind == "features":
            self.object = item.number
        buffer.messages.pop(0)
        self.loading = None
        self.watcher.take(now, WEST if self.x > 0 else "load", 0)
        self.moved += 1
        if not ends:
            self.send(EAST, 0, item, now)

    def made_until(self, left):
        """The cycle from which no more than `left` of the spans kept are left."""
        return self.kept[-left - 1] if len(self.kept) > left else 0

    def has_room(self, now):
        most = self.S.option["load-queue"]
        return most == 0 or now >= self.made_until(most - 1)
