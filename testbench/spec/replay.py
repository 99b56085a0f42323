#!/usr/bin/python3
"""Replays golden vectors with a cell that is written from the specification alone.

    testbench/spec/replay.py FILE.golden_X_Y.txt ...

Code 0: the cell did what the file says; 2: it did not, and the first differences are printed; 1: a wrong file."""

import sys
from collections import Counter, deque

from cell import Cell
from record import Record, WrongFile
from rays import SIDES
from wire import name_of

MOST_DIFFERENCES = 10


class Replay:
    def __init__(self, record):
        self.record, self.wire = record, record.wire
        self.cell = Cell(record.S, *record.place, record.sides, record.wire, self)
        self.expected = {}                          # by buffer: lines of what the cell has to do
        for event in record.events:
            if event.what in ("take", "out"):
                self.expected.setdefault(event.buffer(), deque()).append(event)
        self.differences, self.compared = [], Counter()

    # What the cell does

    def take(self, now, side, index):
        event = self.next_expected(now, ("take", side, index), "")
        if event:
            self.compared["take"] += 1

    def out(self, now, side, index, cycles, message):
        name, wire = name_of(message), self.wire
        bits, words = wire.bits_and_words(message)
        event = self.next_expected(now, ("out", side, index), f" {cycles} {bits} {name} {' '.join(words)}")
        if not event:
            return
        self.compared[name] += 1
        if event.cycles != cycles:
            self.differ(event, now, f"cycles on the link are {cycles}, expected {event.cycles}")
        if event.name != name:
            self.differ(event, now, f"it is '{name}', expected '{event.name}'")
        elif bits != event.bits or (bits == "-" and words != event.words):
            names = wire.word_names(message)
            for field, own, other in zip(names, words, event.words):
                if own != other:
                    self.differ(event, now, f"field '{field}' is {own}, expected {other}")
            if words == event.words or len(words) != len(event.words):
                self.differ(event, now, f"its bits are {bits}")

    def next_expected(self, now, buffer, text):
        side = buffer[1] if buffer[1] == "load" else SIDES[buffer[1]]
        did = f"{buffer[0]} {side} {buffer[2]}{text}"
        lines = self.expected.get(buffer)
        if not lines:
            self.differ(None, now, f"nothing more is expected of it; it did: {did}")
            return None
        event = lines.popleft()
        event.done = True
        if event.cycle != now:
            self.differ(event, now, f"expected in cycle {event.cycle}; it did: {did}")
        return event

    def differ(self, event, now, text):
        line = f" (line {event.line})" if event else ""
        self.differences.append(f"{self.record.path}: cycle {now}{line}: {text}")

    # The run

    def tell(self, event):
        cell = self.cell
        if event.what == "phase":
            cell.begin_phase(event.value, event.cycle)
        elif event.what == "drain":
            cell.draining = event.value
        else:
            buffer = cell.load_input if event.side == "load" else cell.inputs[event.side, event.index]
            buffer.messages.append((self.record.message(event), event.cycle + event.cycles))

    def run(self):
        """Cycle by cycle, without those in which nothing can happen."""
        told = {}
        for event in self.record.events:
            told.setdefault(event.cycle, []).append(event)
        cycles = deque(sorted(told))
        now = 0
        while not self.differences:
            for event in told.get(now, ()):
                if event.what in ("phase", "drain", "in"):
                    self.tell(event)
            before = self.cell.moved
            self.cell.step(now)
            changed = self.cell.moved != before
            for event in told.get(now, ()):
                if event.what == "free":
                    self.cell.outputs[event.side].held[event.index] -= 1
                    changed = True
                elif event.what in ("take", "out") and not event.done:
                    self.differ(event, now, "it did not do this")
            while cycles and cycles[0] <= now:
                cycles.popleft()
            following = [now + 1] if changed else self.cell.wakes(now)
            now = min(following + [cycles[0]] if cycles else following)
            if now > self.record.end:
                break
        if not self.differences:
            self.compare_pixel()
        return self.differences

    def compare_pixel(self):
        event, pixel = self.record.pixel, self.cell.pixel
        if not event or not pixel:
            if event or pixel:
                self.differ(event, self.record.end, "only one of cell and file has a pixel")
            return
        self.compared["pixel"] += 1
        if pixel[0] != event.cycle:
            self.differ(event, pixel[0], f"pixel complete, expected in cycle {event.cycle}")
        words = [c.raw for c in pixel[1]]
        if words != event.value:
            self.differ(event, pixel[0], f"pixel {words}, expected {event.value}")


def replay(path):
    """(differences, what was compared)"""
    run = Replay(Record(path))
    differences = run.run()
    return differences, run.compared


def main(paths):
    if not paths:
        print(__doc__)
        return 1
    differ, total = 0, Counter()
    for path in paths:
        try:
            differences, compared = replay(path)
        except (WrongFile, OSError) as error:
            print(error, file=sys.stderr)
            return 1
        for difference in differences[:MOST_DIFFERENCES]:
            print(difference)
        differ += bool(differences)
        total += compared
    counts = ", ".join(f"{count} {what}" for what, count in sorted(total.items()))
    print(f"{len(paths)} files, {differ} with differences; compared: {counts}")
    return 2 if differ else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
