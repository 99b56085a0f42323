"""Line charts of a run's activity and the picture of a deadlock, as SVG that follows the page's colours."""
import html
import itertools
import math
import re

from studies.report.maps import number

WIDTH, HEIGHT = 300, 150
LEFT, RIGHT, TOP, BOTTOM = 40, 8, 8, 30

CHARTS = [  # key, title; True: per cycle, "kilo": per 1000 cycles, None: running sum, % of the pixels
    ("rays_in_flight", "rays on their way", False),
    ("slots_used", "ray store slots in use", False),
    ("answers_in_flight", "answers on their way", False),
    ("hops", "hops per cycle", True),
    ("pixels_done", "pixels done, % of all", None),
    ("postponed", "rays postponed per 1000 cycles", "kilo"),
]


def nice(limit, steps=(1, 2, 5, 10)):
    """The smallest of these steps times a power of ten that is at least `limit`."""
    if limit <= 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(limit))
    return next(power * m for m in steps if limit <= power * m * (1 + 1e-9))


def ticks(low, high, count):
    step = nice((high - low) / count)
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, int(high / step + 1e-9) + 1)]


def chart(title, start, end, lines, marks):
    """A chart of lines in steps. `lines`: of each its first cycle, the widths of its buckets, their values.
    `marks`: (cycle, text) of vertical lines."""
    top = nice(max(max(values) for _, _, values in lines), (1, 1.5, 2, 3, 4, 5, 6, 8, 10))
    def x(cycle):
        return LEFT + (cycle - start) / max(end - start, 1) * (WIDTH - LEFT - RIGHT)
    def y(value):
        return HEIGHT - BOTTOM - value / top * (HEIGHT - TOP - BOTTOM)
    parts = []
    for tick in ticks(0, top, 4):
        parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(tick):.1f}" y2="{y(tick):.1f}"/>'
                     f'<text x="{LEFT - 5}" y="{y(tick) + 4:.1f}" text-anchor="end">{number(tick)}</text>')
    for tick in ticks(start, end, 4):
        if x(tick) < WIDTH - 20:
            parts.append(f'<text x="{x(tick):.1f}" y="{HEIGHT - BOTTOM + 14}" text-anchor="middle">'
                         f'{number(tick)}</text>')
    parts.append(f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 3}" text-anchor="end">cycle</text>')
    for index, (first, widths, values) in enumerate(lines):
        path, at = [], first
        for width, value in zip(widths, values):
            path.append(f"{x(at):.1f},{y(value):.1f} {x(at + width):.1f},{y(value):.1f}")
            at += width
        line = " ".join(path)
        base = f"{y(0):.1f}"
        if index == 0:
            parts.append(f'<polygon class="area" points="{x(first):.1f},{base} {line} {x(at):.1f},{base}"/>')
        parts.append(f'<polyline class="line{" second" if index else ""}" points="{line}"/>')
    for cycle, text in marks:
        if start < cycle < end:
            side = "end" if x(cycle) > WIDTH * 0.6 else "start"
            shift = -4 if side == "end" else 4
            parts.append(f'<line class="mark" x1="{x(cycle):.1f}" x2="{x(cycle):.1f}" y1="{TOP}" y2="{y(0):.1f}"/>'
                         f'<text class="mark" x="{x(cycle) + shift:.1f}" y="{TOP + 9}" text-anchor="{side}">'
                         f'{html.escape(text)}</text>')
    return (f'<figure class="chart"><figcaption>{html.escape(title)}</figcaption>'
            f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(title)} over time" '
            f'data-start="{start}" data-end="{end}" data-left="{LEFT}" data-right="{WIDTH - RIGHT}">{"".join(parts)}'
            f'<line class="cursor" y1="{TOP}" y2="{y(0):.1f}" style="display:none"/></svg></figure>')


def bucket_widths(series, count):
    width, cycles = series["bucket_cycles"], series["cycles"]
    return [max(min(width, cycles - i * width), 1) for i in range(count)]


def loading_line(report):
    """The line of the hops of loading, or None where the array was loaded by another run."""
    load = (report.get("activity") or {}).get("load") or {}
    if not load.get("hops") or max(load["hops"]) <= 0:
        return None
    widths = bucket_widths(load, len(load["hops"]))
    return load["start_cycle"], widths, [h / w for h, w in zip(load["hops"], widths)]


def line_of(report, key, how, pixels):
    """The line of one of CHARTS, or None where nothing happened."""
    series = report["activity"]
    values = series.get(key)
    if not values or max(values) <= 0:
        return None
    widths = bucket_widths(series, len(values))
    if how is True:
        values = [v / w for v, w in zip(values, widths)]
    elif how == "kilo":
        values = [1000 * v / w for v, w in zip(values, widths)]
    elif how is None:
        done = itertools.accumulate(values)
        values = [100 * total / pixels for total in done]
    return series["start_cycle"], widths, values


def drawn(title, lines, marks):
    """A chart of these lines, from the first cycle of any to the last."""
    ends = [first + sum(widths) for first, widths, _ in lines]
    return chart(title, min(first for first, _, _ in lines), max(ends), lines, marks)


def activity(reports, pixels):
    """HTML of the charts of one run or of several beside each other, or None for runs without time."""
    reports = [r for r in reports if isinstance(r.get("activity"), dict)]
    if not reports:
        return None
    figures = []
    loading = [line for line in map(loading_line, reports) if line]
    if loading:
        figures.append(drawn("loading: hops per cycle", loading, []))
    marks = []
    series = reports[0]["activity"]
    if len(reports) == 1 and (series.get("trace_start") or 0) > series.get("start_cycle", 0):
        marks.append((series["trace_start"], "trace"))
    formed = (reports[0].get("deadlock", {}).get("knot") or {}).get("formed")
    if len(reports) == 1 and isinstance(formed, (int, float)):
        marks.append((formed, "knot"))
    for key, title, how in CHARTS:
        lines = [line for line in (line_of(r, key, how, pixels) for r in reports) if line]
        if lines:
            figures.append(drawn(title, lines, marks))
    return f'<div class="charts">{"".join(figures)}</div>' if figures else None


def knot_of(deadlock):
    """The knot as far as the report has it: (cells, edges between cells, what they are)."""
    knot = deadlock.get("knot")
    if isinstance(knot, dict):
        nodes = [n for n in knot.get("nodes", []) if isinstance(n, dict) and "x" in n and "y" in n]
        cells = [tuple(c[:2]) for c in knot.get("cells", [])] or [(n["x"], n["y"]) for n in nodes]
        edges = []
        for edge in knot.get("edges", []):
            pair = (edge.get("from"), edge.get("to")) if isinstance(edge, dict) else tuple(edge[:2])
            if all(isinstance(i, int) and 0 <= i < len(nodes) for i in pair):
                ends = [(nodes[i]["x"], nodes[i]["y"]) for i in pair]
                if ends[0] != ends[1]:
                    edges.append(tuple(ends))
        if cells:
            count = knot.get("knots", 1)
            return list(dict.fromkeys(cells)), list(dict.fromkeys(edges)), "The knot" if count == 1 else f"{count} knots"
    places = []
    for line in deadlock.get("report", []):
        match = re.match(r"cell \((\d+), (\d+)\)", str(line))
        if match:
            places.append((int(match[1]), int(match[2])))
    return list(dict.fromkeys(places)), [], "Cells in which something is stuck"


def arrow(start, end):
    """The path of an edge between two cells."""
    (x0, y0), (x1, y1) = start, end
    length = math.hypot(x1 - x0, y1 - y0)
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    # From centre to centre, a little to the right, so that an edge and its reverse stay apart.
    ax, ay = x0 + 0.5 - 0.15 * dy, y0 + 0.5 + 0.15 * dx
    bx, by = x1 + 0.5 - 0.15 * dy - 0.2 * dx, y1 + 0.5 + 0.15 * dx - 0.2 * dy
    left = bx - 0.2 * dx - 0.14 * dy, by - 0.2 * dy + 0.14 * dx
    right = bx - 0.2 * dx + 0.14 * dy, by - 0.2 * dy - 0.14 * dx
    return (f"M{ax:.2f} {ay:.2f}L{bx:.2f} {by:.2f}M{left[0]:.2f} {left[1]:.2f}L{bx:.2f} {by:.2f}"
            f"L{right[0]:.2f} {right[1]:.2f}")


def axis_number(x, y, anchor, value, size):
    return (f'<text class="axis" x="{x:.2f}" y="{y:.2f}" text-anchor="{anchor}" style="font-size:{size:.2f}px">'
            f'{number(value)}</text>')


LEGEND = ('<div class="legend"><span><svg viewBox="0 0 5 3"><rect class="stuck" width="5" height="3"/></svg>a cell in which '
          'something is stuck</span><span><svg viewBox="0 0 5 3"><path class="edge" d="M.3 1.5H4.5M3.7 .9L4.5 1.5L3.7 2.1"/>'
          '</svg>it waits for</span><span>numbers: x to the right, y downwards, in cells</span></div>')


def view(cells, edges, frame, size, rem):
    """SVG of the part `frame` (x0, y0, x1, y1; x1 and y1 excluded) of an array of `size`."""
    width, height = size
    x0, y0, x1, y1 = frame
    parts = [f'<rect class="field" x="0" y="0" width="{width}" height="{height}"/>']
    if max(x1 - x0, y1 - y0) <= 64:
        lines = ([f"M{x} {max(y0, 0)}V{min(y1, height)}" for x in range(max(x0, 1), min(x1, width))] +
                 [f"M{max(x0, 0)} {y}H{min(x1, width)}" for y in range(max(y0, 1), min(y1, height))])
        parts.append(f'<path class="cells" d="{"".join(lines)}"/>')
    parts += [f'<rect class="stuck" x="{x}" y="{y}" width="1" height="1"/>' for x, y in cells]
    parts += [f'<path class="edge" d="{arrow(*edge)}"/>' for edge in edges]
    ratio = min(max((x1 - x0) / (y1 - y0), 0.2), 8)  # a single row or column is stretched
    # Cells are numbered along the lower and the left edge, in a margin that the frame is widened by.
    size_of_text = max(x1 - x0, y1 - y0) / 24
    for tick in ticks(max(x0, 0), min(x1, width) - 1, 6):
        if tick == int(tick):
            parts.append(axis_number(tick + 0.5, y1 + 1.3 * size_of_text, "middle", tick, size_of_text))
    for tick in ticks(max(y0, 0), min(y1, height) - 1, 6):
        if tick == int(tick):
            parts.append(axis_number(x0 - 0.3 * size_of_text, tick + 0.5 + 0.35 * size_of_text, "end", tick, size_of_text))
    x0, y1 = x0 - 2.2 * size_of_text, y1 + 1.8 * size_of_text
    return (f'<svg viewBox="{x0:.2f} {y0} {x1 - x0:.2f} {y1 - y0:.2f}" preserveAspectRatio="none" style="aspect-ratio:{ratio:.3f};'
            f'width:min(100%,{rem * ratio:.2f}rem)" role="img" aria-label="cells {x0} to {x1 - 1}, {y0} to {y1 - 1}">'
            f'{"".join(parts)}</svg>')


def around(cells, size):
    """A square around the cells with a margin, inside the array where it fits."""
    lows = [min(c[i] for c in cells) for i in (0, 1)]
    highs = [max(c[i] for c in cells) + 1 for i in (0, 1)]
    side = max(h - l for l, h in zip(lows, highs)) + 4
    starts = [max(-1, min((l + h - side) // 2, n + 1 - side)) for l, h, n in zip(lows, highs, size)]
    return (starts[0], starts[1], starts[0] + side, starts[1] + side)


def array_picture(deadlock, width, height):
    """The array with the stuck cells and the waits between them; a small knot is drawn again, enlarged."""
    cells, edges, what = knot_of(deadlock)
    if not cells:
        return ""
    size = (width, height)
    pictures = [view(cells, edges, (-1, -1, width + 1, height + 1), size, 20)]
    near = around(cells, size)
    zoomed = (near[2] - near[0]) * 2 <= max(width, height)
    if zoomed:
        pictures.append(view(cells, edges, near, size, 20))
    waits = f", {len(edges)} waits between them, an arrow from who waits to what it waits for" if edges else ""
    formed = (deadlock.get("knot") or {}).get("formed")
    several = what.endswith("knots")
    since = f"; {'the oldest' if several else 'it'} stands since cycle {formed}" if isinstance(formed, (int, float)) else ""
    tails = (deadlock.get("knot") or {}).get("tails")
    since += f"; {tails} more places wait for {'them' if several else 'it'}" if tails else ""
    x0, y0, x1, y1 = max(near[0], 0), max(near[1], 0), min(near[2], width) - 1, min(near[3], height) - 1
    part = f"; the larger picture: x from {x0} to {x1}, y from {y0} to {y1}" if zoomed else ""
    return (f'<figure class="knot"><div>{"".join(pictures)}</div><figcaption>{html.escape(what)}: {len(cells)} of '
            f'{width * height} cells{waits}{since}{part}.</figcaption>{LEGEND}</figure>')
