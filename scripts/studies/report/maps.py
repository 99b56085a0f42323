"""Maps of what every cell of a run did: the columns of its cells.csv as pictures, one pixel a cell."""
import array
import base64
import csv
import html
import struct
import zlib

# Column, title, whether the scale is linear; else it is of square roots, for values with a long tail.
GROUPS = [
    ("Waiting", "Cycles for which something in the cell could have gone on but for one cause, summed over all that "
     "waited: two rays that wait for 10 cycles each make 20. The scale is one of square roots.", [
         ("stall_cycles", "all causes", False),
         ("stall_traversal", "traversal unit at work", False),
         ("stall_output_full", "ray: next buffer full", False),
         ("stall_output_busy", "ray: wires busy", False),
         ("stall_no_slot", "hit: no slot free", False),
         ("stall_shading", "shading unit at work", False),
         ("stall_store_port", "ray store's port taken", False),
         ("stall_answer_full", "answer: next buffer full", False),
         ("stall_answer_busy", "answer: wires busy", False)]),
    ("Buffers", "Messages in the buffers that lead to the cell, over precast and trace: the fullest buffer's peak, and "
     "the mean of a buffer.", [
         ("ray_buffers_peak", "ray buffers, peak", True), ("ray_buffers_mean", "ray buffers, mean", True),
         ("answer_buffers_peak", "answer buffers, peak", True),
         ("answer_buffers_mean", "answer buffers, mean", True)]),
    ("Ray store", "Slots in use: the peak of the run, the mean of the trace; rays destroyed for want of a slot.", [
        ("ray_store_peak", "slots, peak", True), ("ray_store_mean", "slots, mean", True),
        ("postponed", "rays postponed here", False)]),
    ("Traffic and work", "Messages that the cell sent, and cycles in which its links and units were at work.", [
        ("hops", "hops of rays and answers", False), ("hops_load", "load messages passed on", False),
        ("link_busy_cycles", "input links busy, cycles", False),
        ("traversal_cycles", "traversal unit busy, cycles", False),
        ("shading_cycles", "shading unit busy, cycles", False)]),
    ("Scene", "What the cell stores of the scene.", [
        ("voxels", "voxels", False), ("edges", "edges", False)]),
]

VIRIDIS = ["440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"]
SHADES = 256


def palette():
    """The 256 shades of the maps, as bytes."""
    return palette_between([[int(c[i:i + 2], 16) for i in (0, 2, 4)] for c in VIRIDIS])


def palette_between(anchors):
    """256 shades, as bytes, evenly between these colours."""
    shades = bytearray()
    for i in range(SHADES):
        at = i * (len(anchors) - 1) / (SHADES - 1)
        low = min(int(at), len(anchors) - 2)
        shades += bytes(round(a + (b - a) * (at - low)) for a, b in zip(anchors[low], anchors[low + 1]))
    return bytes(shades)


def read_cells(path, width, height):
    """The columns of a cells.csv by name, in row-major order. Raises ValueError for any other file."""
    with open(path, newline="") as stream:
        lines = csv.reader(stream)
        names = next(lines, [])
        columns = [array.array("d") for _ in names]
        for line in lines:
            if len(line) != len(names):
                raise ValueError(f"line {lines.line_num} has {len(line)} fields, not {len(names)}")
            for column, field in zip(columns, line):
                column.append(float(field))
    cells = dict(zip(names, columns))
    if not {"x", "y", "voxels"} <= cells.keys():
        raise ValueError("expected the columns x, y, voxels, ...")
    if len(cells["x"]) != width * height:
        raise ValueError(f"{len(cells['x'])} cells, not {width} x {height}")
    if "hops_ray" in cells and "hops_return" in cells:
        cells["hops"] = array.array("d", map(sum, zip(cells["hops_ray"], cells["hops_return"])))
    return cells


def data_uri(png):
    return "data:image/png;base64," + base64.b64encode(png).decode()


def indexed_png(width, height, shades, colours):
    """A PNG of bytes, each an index into the palette `colours`."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + shades[y * width:(y + 1) * width] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
            chunk(b"PLTE", colours) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def number(value):
    """Short, for people: 1234567 as 1.23 M."""
    if value == int(value) and abs(value) < 10000:
        return str(int(value))
    for size, letter in ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e4, "k")):
        if abs(value) >= size:
            return f"{value / (1000 if letter == 'k' else size):.3g} {letter}"
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def shape(width, height, rem):
    """CSS of a picture of the array, at most `rem` high. The cells of a single row or column are stretched."""
    ratio = min(max(width / height, 0.2), 8)
    return f"aspect-ratio:{ratio:.3f};width:min(100%,{rem * ratio:.2f}rem)"


def one_map(values, title, linear, width, height, name, most=None):
    """`name`: of the values among the page's data. `most`: the scale's end, if it is not their maximum."""
    most = most or max(values)
    power = 1.0 if linear else 0.5
    shades = bytes(int((v / most) ** power * (SHADES - 1) + 0.5) for v in values)
    hottest = max(range(len(values)), key=values.__getitem__)
    ticks = "".join(f"<span>{number((i / 4) ** (1 / power) * most)}</span>" for i in range(5))
    picture = data_uri(indexed_png(width, height, shades, palette()))
    facts = f"most at ({hottest % width}, {hottest // width}), mean {number(sum(values) / len(values))}"
    return (f'<figure class="map"><figcaption>{html.escape(title)}</figcaption>'
            f'<img data-map="{name}" src="{picture}" style="{shape(width, height, 18)}" alt="map of {html.escape(title)}, 0 to '
            f'{number(most)}"><div class="bar"></div><div class="ticks">{ticks}</div>'
            f'<p>{facts}</p></figure>')


def sections(cells, width, height):
    """HTML of all groups of maps that the run has columns for."""
    text = []
    for name, meaning, maps in GROUPS:
        there = [(c, t, linear) for c, t, linear in maps if c in cells]
        if not there:
            continue
        shown = [one_map(cells[c], t, linear, width, height, c) for c, t, linear in there if max(cells[c]) > 0]
        empty = [t for c, t, _ in there if max(cells[c]) <= 0]
        text.append(f"<section><h2>{name}</h2><p>{meaning}</p>")
        if shown:
            text.append(f'<div class="maps">{"".join(shown)}</div>')
        if empty:
            text.append(f"<p>0 in every cell: {html.escape('; '.join(empty))}.</p>")
        text.append("</section>")
    return "\n".join(text)


def bar_style():
    """The scale under a map, as CSS."""
    return "linear-gradient(to right," + ",".join("#" + c for c in VIRIDIS) + ")"
