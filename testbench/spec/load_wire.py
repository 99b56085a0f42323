"""Load messages as the wires carry them: setup, features, span, end_of_scene."""

from words import Value, ZERO, bits_to

LOAD_TYPES = {"setup": 0, "features": 1, "span": 5, "end_of_scene": 6}
FIELD_OF_NORMALS = ["n0x", "n0y", "n0z", "nux", "nuy", "nuz", "nvx", "nvy", "nvz"]
CENTRE = ["ncx", "ncy", "ncz", "dncx", "dncy", "dncz"]
COLOURS = ["red", "green", "blue", "d_red", "d_green", "d_blue"]
FACES = ["left", "right", "top", "bottom", "front", "back"]


class LoadWire:
    """Layouts of one machine. What repeats (sources, edges) stands once."""

    def __init__(self, S):
        self.S = S
        f, W, L = S.formats, S.formats.W, S.formats.loading.bits
        option = S.option
        self.place = [("place_x", W + 12), ("place_y", W + 12), ("place_z", W + 12), ("place_exponent", 6)]
        colour = [("red", W), ("green", W), ("blue", W)]
        self.viewer = ([("type", 3)] + self.place + [("at_infinity", 1)] + [("beyond_" + face, 1) for face in FACES] +
                       colour + [("levels", 16), ("level", 16), ("level_exponent", 6), ("sources", 7)])
        self.source = self.place + colour
        share = f.feature.bits - 1
        self.features = ([("type", 3)] + [(name, share) for name in ("red", "green", "blue", "Kd", "Ks", "T")] +
                         [("Shine_exponent", 5), ("Shine_fraction", f.shine_bits - 5), ("index", f.ior.bits - 1),
                          ("mirror", 1)])
        column = bits_to(S.width)
        self.span = [("type", 3), ("polygon", 20), ("X1", column), ("Xr", column)]
        self.edge = []
        if option["hit"] == "depth":
            normals = components("N", "DN") if option["normals"] == "voxel" else components("n", "nu", "nv")
            self.span += [("Z", L), ("DZ", L), ("axis", 2), ("sign", 1), ("slope_u", W), ("slope_v", W)]
            self.span += [(name, L) for name in normals]
        else:
            self.span += [("axis", 2), ("sign", 1), ("slope_u", L), ("slope_v", L), ("offset", L), ("slack", L)]
            self.span += [(name, L) for name in components("n", "nu", "nv")] + [("edges", 3)]
            self.edge = [("edge_a", L), ("edge_b", L), ("edge_c", L)]
        colours = components("I", "DI", axes=("red", "green", "blue")) if option["display"] == "gouraud" else []
        self.colours = [(name, L) for name in colours]

    def layout_of_span(self, edges):
        return self.span + self.edge * edges + self.colours

    def layouts(self):
        """As in a record's head: with one source, one edge."""
        return {"setup": self.viewer + self.source, "features": self.features, "span": self.layout_of_span(1),
                "end_of_scene": [("type", 3)]}

    def length(self, item):
        if item.kind == "setup":
            return width(self.viewer) + len(self.S.sources) * width(self.source)
        if item.kind == "span":
            return width(self.layout_of_span(len(item.edges)))
        return width(self.features) if item.kind == "features" else 3

    def pack(self, item):
        """Hexadecimal digits of a span; the others are passed on as they came."""
        if item.kind != "span":
            return item.bits
        return packed(self.layout_of_span(len(item.edges)), item.wire_values())

    def word_names(self, item):
        return item.word_names() if item.kind == "span" else ["object"]

    # What the machine latches from the wires has to be what the head says.

    def check(self, kind, number, bits):
        S, f = self.S, self.S.formats
        if kind == "features":
            v = unpacked(self.features, bits)
            seen = [v["red"], v["green"], v["blue"], v["Kd"], v["Ks"], v["T"], v["index"], v["mirror"]]
            o = S.objects[number]
            known = [c.raw for c in o.colour] + [o.kd.raw, o.ks.raw, o.t.raw, o.ior.raw, int(o.mirror)]
            digits = f.shine_bits - 5
            shine = Value((1 << digits) + v["Shine_fraction"], digits + 9 - v["Shine_exponent"])
            if seen != known or (shine if v["Shine_exponent"] else ZERO) != o.shine:
                raise ValueError(f"features are {v}, the head says otherwise")
        elif kind == "setup":
            v = unpacked(self.viewer, bits)
            self.check_viewer(v)
            at = width(self.viewer)
            for source in S.sources:
                self.check_source(unpacked(self.source, bits, at), source)
                at += width(self.source)

    def check_viewer(self, v):
        S = self.S
        told = {"at_infinity": int(S.eye is None), "levels": S.option["depth"] - 1, "sources": len(S.sources)}
        told.update(zip(("beyond_" + face for face in FACES), map(int, S.faces)))
        told.update(zip(("red", "green", "blue"), (c.raw for c in S.background)))
        wrong = [name for name in told if v[name] != told[name]]
        if S.level != Value(v["level"], 15 - signed(v["level_exponent"], 6)):
            wrong.append("level")
        if S.eye and any(a != b for a, b in zip(self.place_of(v), S.eye)):
            wrong.append("place")
        if wrong:
            raise ValueError(f"the setup message has another {', '.join(wrong)} than the head")

    def check_source(self, v, source):
        seen, known = self.place_of(v), source.position
        colour = [v["red"], v["green"], v["blue"]]
        if any(a != b for a, b in zip(seen, known)) or colour != [c.raw for c in source.intensity]:
            raise ValueError(f"the setup message has the source {v}, the head another")

    def place_of(self, v):
        bits = self.S.formats.W + 12
        frac = bits - 1 - signed(v["place_exponent"], 6)
        return [Value(signed(v[axis], bits), frac) for axis in ("place_x", "place_y", "place_z")]


def components(*vectors, axes="xyz"):
    return [f"{vector}_{axis}" for vector in vectors for axis in axes]


def width(layout):
    return sum(bits for _, bits in layout)


def signed(word, bits):
    return word - (1 << bits) if word >> (bits - 1) else word


def packed(layout, values):
    """The fields of a layout, the first one leftmost, as hexadecimal digits filled with zeros."""
    bits = 0
    for (_, size), word in zip(layout, values):
        bits = bits << size | word & ((1 << size) - 1)
    fill = -width(layout) % 4
    return format(bits << fill, f"0{(width(layout) + fill) // 4}x")


def unpacked(layout, text, start=0):
    """Words without a sign, by field; the layout begins at bit `start`."""
    bits, end = int(text, 16), 4 * len(text)
    words, at = {}, start
    for name, size in layout:
        at += size
        if at > end:
            raise ValueError("BITS end within a field")
        words[name] = bits >> (end - at) & ((1 << size) - 1)
    return words
