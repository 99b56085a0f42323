"""Golden vectors, version 2: the head, and the events of a cell."""

import json
from fractions import Fraction

from load_wire import LOAD_TYPES, SOURCE_KINDS
from loading import LoadMessage
from rays import SIDES, Machine, Material, Source
from voxels import Span
from wire import TYPES, Wire
from words import Format, Value, exact, read_floating


class WrongFile(Exception):
    pass


class Event:
    """A line. side: 0 to 3, or "load"; `bits` and `message` as in the file."""

    def __init__(self, line, cycle, what):
        self.line, self.cycle, self.what = line, cycle, what
        self.side = self.index = self.cycles = self.bits = self.name = None
        self.fields, self.words, self.identity, self.value = None, [], (0, 0), None
        self.done = False                           # by the cell, of what is expected

    def buffer(self):
        return self.what, self.side, self.index


def read_source(words, f):
    """A point is its place and its intensity; another source begins with its kind."""
    words = list(words)
    source = Source(words.pop(0) if words[0] in SOURCE_KINDS else "point", None, None)

    def take(form):
        return [form.word(int(words.pop(0))) for _ in range(3)]
    if source.is_area():
        read_extent(source, words, take, Format(1, f.W + 11))
    elif source.kind != "directional":
        source.position = [read_floating(words.pop(0), f.W + 12) for _ in range(3)]
    if source.kind not in ("point", "sphere"):
        source.axis = take(f.unit)
    if source.kind == "spot":
        source.cut_off = f.unit.word(int(words.pop(0)))
        source.falloff = read_floating(words.pop(0), f.shine_bits - 4)
    source.intensity = take(f.intensity)
    return source


def read_extent(source, words, take, mantissa):
    """Mantissas of one exponent, which comes last."""
    source.position = take(mantissa)
    if source.kind == "sphere":
        source.radius = mantissa.word(int(words.pop(0)))
    else:
        source.edge_u, source.edge_v = take(mantissa), take(mantissa)
    e = source.exponent = int(words.pop(0))

    def scaled(m):
        return Value(m.raw, m.frac - e)
    source.position = [scaled(m) for m in source.position]
    if source.kind == "sphere":
        source.radius = scaled(source.radius)
    else:
        source.edge_u, source.edge_v = [scaled(m) for m in source.edge_u], [scaled(m) for m in source.edge_v]


class Record:
    def __init__(self, path):
        self.path, self.option, self.place, self.sides = path, {}, None, []
        self.head, self.objects, self.sources, self.events = {}, [], [], []
        self.formats, self.layouts = {}, {}
        self.S = self.wire = self.pixel = self.end = None
        with open(path, encoding="ascii") as lines:
            if lines.readline().rstrip("\n") != "raycell-golden 2":
                raise WrongFile(f"{path}: line 1: no golden vectors of version 2")
            in_head = True
            for number, line in enumerate(lines, 2):
                if line.startswith("#"):
                    continue
                try:
                    in_head = self.read_head(line) if in_head else self.read_event(number, line)
                except (ValueError, KeyError, IndexError) as error:
                    raise WrongFile(f"{path}: line {number}: {error!r}") from error
        if self.end is None:
            raise WrongFile(f"{path}: it has no end")

    def read_head(self, line):
        words = line.split()
        key, rest = words[0], words[1:]
        if key == "config":
            name, text = line[len("config "):].split(" = ", 1)
            self.option[name] = json.loads(text)
        elif key == "cell":
            self.place = tuple(int(word) for word in rest)
        elif key == "links":
            self.sides = [SIDES.index(word) for word in rest]
        elif key == "object":
            self.objects.append(rest)
        elif key == "source":
            self.sources.append(rest)
        elif key == "format":
            self.formats[rest[0]] = rest[1]
        elif key == "layout":
            self.layouts[rest[0]] = rest[1:]
        elif key == "begin":
            self.make_machine()
            return False
        else:
            self.head[key] = rest
        return True

    def make_machine(self):
        option = self.option
        if option["arithmetic"] != "fixed":
            raise ValueError("only fixed arithmetic is specified")
        option["cost"] = {name: int(cycles) for name, cycles in (entry.split("=") for entry in option["cost"])}
        columns, rows = (int(n) for n in option["cells"].split("x"))
        depth, infinity, *eye = self.head["frame"]
        eye = None if int(infinity) else [exact(float.fromhex(c)) for c in eye]
        beyond = [bit == "1" for bit in self.head["beyond"]]
        S = self.S = Machine(option, columns, rows, Fraction(float.fromhex(depth)), eye, beyond)
        f = S.formats
        S.background = [f.intensity.word(int(c)) for c in self.head["background"]]
        for r, g, b, kd, ks, t, shine, ior, mirror in self.objects:
            colour = [f.feature.word(int(c)) for c in (r, g, b)]
            kd, ks, t = (f.feature.word(int(c)) for c in (kd, ks, t))
            shine = read_floating(shine, f.shine_bits - 5 + 1)
            S.objects.append(Material(colour, kd, ks, t, shine, f.ior.word(int(ior)), mirror == "1"))
        S.set_sources([read_source(words, f) for words in self.sources])
        self.wire = Wire(S)
        self.check_head()

    def check_head(self):
        """The formats and layouts of the head are those of the specification."""
        own = vars(self.S.formats)
        names = {"index_of_refraction": "ior"}
        for name, text in self.formats.items():
            form = own[names.get(name, name)]
            mine = f"UQ{form.i - 1}.{form.f}" if text.startswith("U") else f"Q{form.i}.{form.f}"
            if mine != text:
                raise ValueError(f"format {name} is {text}, specified is {mine}")
        for name, fields in self.layouts.items():
            mine = [f"{field}:{bits}" for field, bits in {**self.wire.layouts, **self.wire.load.layouts()}[name]]
            if mine != fields:
                raise ValueError(f"layout {name} is {' '.join(fields)}, specified is {' '.join(mine)}")

    def read_event(self, number, line):
        text, _, remark = line.partition(";")
        words = text.split()
        event = Event(number, int(words[0]), words[1])
        rest = words[2:]
        if event.what in ("in", "out", "take", "free"):
            event.side = rest[0] if rest[0] == "load" else SIDES.index(rest[0])
            event.index = int(rest[1])
        if event.what in ("in", "out"):
            event.cycles, event.bits, event.name, event.words = int(rest[2]), rest[3], rest[4], rest[5:]
            self.read_message(event, remark.split())
        elif event.what == "phase":
            event.value = rest[0]
        elif event.what == "drain":
            event.value = rest[0] == "1"
        elif event.what == "pixel":
            self.pixel = event
            event.value = [int(word) for word in rest]
            return False
        elif event.what == "end":
            self.end = event.cycle
            return False
        elif event.what not in ("take", "free"):
            raise ValueError(f"no event '{event.what}'")
        self.events.append(event)
        return False

    def read_message(self, event, remark):
        """Bits and words have to say the same."""
        if event.name in TYPES:
            event.fields = self.wire.parse(event.name, event.words)
            bits = self.wire.pack(event.name, event.fields)
            if "pixel" in remark:
                event.identity = int(remark[remark.index("pixel") + 1]), int(remark[remark.index("branch") + 1])
        elif event.name in LOAD_TYPES:
            message = self.message(event)
            bits = self.wire.load.pack(message)
            self.wire.load.check(event.name, getattr(message, "number", None), event.bits)
        else:
            raise ValueError(f"no message '{event.name}'")
        if event.bits != bits:
            raise ValueError(f"the words are {bits}, not {event.bits}")

    def message(self, event):
        """What an `in` line brings, for the cell's buffer."""
        if event.fields is None:
            if event.name == "span":
                return Span(self.S, event.words)
            return LoadMessage(event.name, event.words, event.bits)
        return self.wire.message(event.name, event.fields, event.identity)
