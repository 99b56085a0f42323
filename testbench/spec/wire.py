"""Messages as the wires carry them, and as words in a record."""

from links import Answer, Packet
from load_wire import LOAD_TYPES, LoadWire, packed, width
from rays import Ray
from words import Value, ZERO, bits_to

TYPES = {"ray": 0, "shadow_ray": 1, "intensity": 2, "lit": 3, "blocked": 4, "postponed": 5}
VERDICTS = ("lit", "blocked", "postponed")


class Wire:
    def __init__(self, S):
        self.S = S
        f, W, option = S.formats, S.formats.W, S.option
        slot = bits_to(option["ray-store"] + 1)
        if option["shadows"] != "per-hit":
            slot = max(slot, 10)                    # a voxel's number
        self.pixel_slot = (1 << slot) - 1
        way = [("type", 3), ("x", W), ("y", W), ("z", f.depth.bits), ("dx", W), ("dy", W), ("dz", W),
               ("1/dx", W + 6), ("1/dy", W + 6)]
        home = [("home_x", bits_to(S.width)), ("home_y", bits_to(S.height)), ("slot", slot), ("child", 6)]
        self.layouts = {
            "ray": way + [("weight", W), ("polygon_left", 20), ("generation", 6), ("outside", 1)] + home,
            "shadow_ray": way + [("reach", W), ("polygon_left", 20), ("outside", 1)] + home,
            "intensity": [("type", 3), ("red", W), ("green", W), ("blue", W)] + home,
            "verdict": [("type", 3)] + home}
        self.lengths = {name: width(layout) for name, layout in self.layouts.items()}
        self.load = LoadWire(S)

    def layout(self, name):
        return self.layouts["verdict" if name in VERDICTS else name]

    def length(self, message):
        """Its bits."""
        name = name_of(message)
        if name in LOAD_TYPES:
            return self.load.length(message)
        return self.lengths["verdict" if name in VERDICTS else name]

    def words(self, message):
        """The fields of a ray or an answer, as integers; 1/dx and 1/dy are (mantissa, exponent)."""
        fields = {"home_x": message.home[0], "home_y": message.home[1], "slot": message.slot, "child": message.child}
        if isinstance(message, Answer):
            fields.update(zip(("red", "green", "blue"), (c.raw for c in message.colour)))
        else:
            fields.update(zip("xyz", (p.raw for p in message.p)))
            fields.update(zip(("dx", "dy", "dz"), (d.raw for d in message.d)))
            fields.update(zip(("1/dx", "1/dy"), (self.carried(i) for i in message.inverse)))
            fields.update(weight=message.weight.raw, reach=message.reach.raw, polygon_left=message.leaves,
                          generation=message.generation, outside=int(message.outside))
        kind = message.ray_kind if isinstance(message, Answer) else message.kind
        if kind == "primary":
            fields["slot"] = self.pixel_slot
        return fields

    def carried(self, inverse):
        if inverse.raw == 0:
            return 0, 0
        bits = self.S.formats.W - 1                 # a power of two, 2^bits, is sent as half of it
        m, exponent = abs(inverse.raw), bits - inverse.frac
        return (m >> 1, exponent + 1) if m >> bits else (m, exponent)

    def pack(self, name, fields):
        """Hexadecimal digits, or "-" where a voxel's number does not fit."""
        layout = self.layout(name)
        values = []
        for field, _ in layout:
            word = TYPES[name] if field == "type" else fields[field]
            if field in ("1/dx", "1/dy"):
                word = word[0] << 6 | word[1] & 63
            elif field == "slot" and word > self.pixel_slot:
                return "-"
            values.append(word)
        return packed(layout, values)

    def bits_and_words(self, message):
        """As in a record: hexadecimal digits, and the words without the type."""
        name = name_of(message)
        if name in LOAD_TYPES:
            return self.load.pack(message), message.words()
        fields = self.words(message)
        return self.pack(name, fields), self.field_texts(name, fields)

    def field_texts(self, name, fields):
        return [self.word_text(field, fields[field]) for field, _ in self.layout(name)[1:]]

    def word_names(self, message):
        name = name_of(message)
        if name in LOAD_TYPES:
            return self.load.word_names(message)
        return [field for field, _ in self.layout(name)[1:]]

    def word_text(self, field, word):
        if field in ("1/dx", "1/dy"):
            return f"{word[0]}:{word[1]}"
        if field == "slot" and word == self.pixel_slot:
            return "pixel"
        if field == "reach" and word == self.S.formats.reach.high:
            return "inf"
        return str(word)

    def parse(self, name, words):
        """Fields of a ray or an answer in words."""
        layout = self.layout(name)[1:]
        if len(words) != len(layout):
            raise ValueError(f"'{name}' has {len(layout)} fields, not {len(words)}")
        fields = {}
        for (field, _), word in zip(layout, words):
            if field in ("1/dx", "1/dy"):
                fields[field] = tuple(int(part) for part in word.split(":"))
            elif word == "pixel":
                fields[field] = self.pixel_slot
            elif word == "inf":
                fields[field] = self.S.formats.reach.high
            else:
                fields[field] = int(word)
        return fields

    def message(self, name, fields, identity):
        """A Packet, or an Answer. `identity`: pixel and branch."""
        f, W, shadows = self.S.formats, self.S.formats.W, self.S.option["shadows"]
        child = fields["child"]
        if name in ("shadow_ray", "lit", "blocked"):
            kind = "shadow" if shadows == "per-hit" else shadows
        elif fields["slot"] == self.pixel_slot:
            kind = "primary"
        else:
            kind = ("reflected", "refracted")[child]
        ray = Ray(self.S, kind, (fields["home_x"], fields["home_y"]))
        ray.pixel, ray.branch = identity
        ray.slot, ray.child = fields["slot"], child
        if name not in ("ray", "shadow_ray"):
            colour = [f.intensity.word(fields[c]) for c in ("red", "green", "blue")] if name == "intensity" else None
            return Answer(name, ray, colour)
        ray.p = [f.unit.word(fields["x"]), f.unit.word(fields["y"]), f.depth.word(fields["z"])]
        ray.d = [f.unit.word(fields[d]) for d in ("dx", "dy", "dz")]
        ray.inverse = [Value(-m if d.raw < 0 else m, W - 1 - e) if m else ZERO
                       for d, (m, e) in zip(ray.d, (fields["1/dx"], fields["1/dy"]))]
        ray.leaves, ray.outside, ray.fresh = fields["polygon_left"], bool(fields["outside"]), False
        if name == "ray":
            ray.weight, ray.generation = f.unit.word(fields["weight"]), fields["generation"]
        else:
            ray.reach = f.reach.word(fields["reach"])
        return Packet(ray)


def name_of(message):
    if isinstance(message, Ray):
        return "shadow_ray" if message.is_shadow() else "ray"
    return message.kind
