"""Load messages as the wires carry them: setup, features, span, end_of_scene."""

from rays import sample_steps
from words import Value, ZERO, bits_to

SOURCE_KINDS = ["point", "directional", "spot", "rectangle", "triangle", "sphere"]
VIEWER_OF_KINDS = 7
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
        axis = [("axis_x", W), ("axis_y", W), ("axis_z", W)]
        cone = [("cut-off", W), ("falloff_exponent", 5), ("falloff_fraction", f.shine_bits - 5)]
        kind = [("kind", 3)]
        self.tells_kinds = any(source.kind != "point" for source in S.sources)
        extent = [("place_exponent", 6)] + self.place[:3]
        edges = [(name, W + 12) for name in ("u_x", "u_y", "u_z", "v_x", "v_y", "v_z")]
        pattern = [("samples", 7), ("step_u", 16), ("step_v", 16), ("share", W), ("share_exponent", 6)]
        flat = kind + extent + edges + axis + pattern + colour
        self.of_kind = {"point": kind + self.place + colour, "directional": kind + axis + colour,
                        "spot": kind + self.place + axis + cone + colour, "rectangle": flat, "triangle": flat,
                        "sphere": kind + extent + [("radius", W + 12)] + pattern + colour}
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
        layouts = {"setup": self.viewer + self.source, "features": self.features, "span": self.layout_of_span(1),
                   "end_of_scene": [("type", 3)]}
        layouts.update(("setup_" + kind, self.viewer + source) for kind, source in self.of_kind.items())
        return layouts

    def layout_of_source(self, source):
        return self.of_kind[source.kind] if self.tells_kinds else self.source

    def length(self, item):
        if item.kind == "setup":
            return width(self.viewer) + sum(width(self.layout_of_source(source)) for source in self.S.sources)
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
            shine = floating_of(v["Shine_exponent"], v["Shine_fraction"], f.shine_bits - 5)
            if seen != known or shine != o.shine:
                raise ValueError(f"features are {v}, the head says otherwise")
        elif kind == "setup":
            v = unpacked(self.viewer, bits)
            self.check_viewer(v)
            at = width(self.viewer)
            for source in S.sources:
                layout = self.layout_of_source(source)
                self.check_source(unpacked(layout, bits, at), source)
                at += width(layout)

    def check_viewer(self, v):
        S = self.S
        told = {"type": VIEWER_OF_KINDS if self.tells_kinds else 0, "at_infinity": int(S.eye is None),
                "levels": S.option["depth"] - 1, "sources": len(S.sources)}
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
        f = self.S.formats
        right = [v["red"], v["green"], v["blue"]] == [c.raw for c in source.intensity]
        right &= v.get("kind", 0) == SOURCE_KINDS.index(source.kind)
        if source.position:
            right &= not any(a != b for a, b in zip(self.place_of(v), source.position))
        if source.axis:
            right &= [signed(v["axis_" + axis], f.W) for axis in "xyz"] == [c.raw for c in source.axis]
        if source.kind == "spot":
            falloff = floating_of(v["falloff_exponent"], v["falloff_fraction"], f.shine_bits - 5)
            right &= v["cut-off"] == source.cut_off.raw and falloff == source.falloff
        if source.is_area():
            right &= self.is_right_area(v, source)
        if not right:
            raise ValueError(f"the setup message has the source {v}, the head another")

    def is_right_area(self, v, source):
        S, bits = self.S, self.S.formats.W + 12
        words = {"u": source.edge_u, "v": source.edge_v} if source.is_flat() else {}
        seen = {name: [v[f"{name}_{axis}"] for axis in "xyz"] for name in words}
        scale = bits - 1 - source.exponent
        right = all(Value(signed(w, bits), scale) == c for name in words for w, c in zip(seen[name], words[name]))
        if source.kind == "sphere":
            right &= Value(signed(v["radius"], bits), scale) == source.radius
        samples = S.option["source-samples"]
        share = Value(v["share"], S.formats.W - 1 - signed(v["share_exponent"], 6))
        return (right and signed(v["place_exponent"], 6) == source.exponent and share == S.share and
                [v["samples"], v["step_u"], v["step_v"]] == [samples, *sample_steps(samples)])

    def place_of(self, v):
        bits = self.S.formats.W + 12
        frac = bits - 1 - signed(v["place_exponent"], 6)
        return [Value(signed(v[axis], bits), frac) for axis in ("place_x", "place_y", "place_z")]


def floating_of(exponent, fraction, digits):
    return Value((1 << digits) + fraction, digits + 9 - exponent) if exponent else ZERO


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
