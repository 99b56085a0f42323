"""Makes a page of two runs beside each other, and of what differs."""
import html

from studies.report import charts as report_charts
from studies.report import maps as report_maps
from studies.report.maps import number

# Colours from "less than the first run" over "equal" to "more".
DIVERGING = ["2166ac", "67a9cf", "d1e5f0", "f7f7f7", "fddbc7", "ef8a62", "b2182b"]
SHADES = 256

FIGURES = [  # name, path of keys in the JSON
    ("verdict", "verdict"),
    ("cycles", "cycles.total"), ("of loading", "cycles.load"), ("of precast", "cycles.precast"),
    ("of trace", "cycles.trace"),
    ("hops of rays", "hops.ray"), ("hops of answers", "hops.return"), ("hops of loading", "hops.load"),
    ("rays sent", "messages.rays.sent"), ("answers sent", "messages.answers.sent"),
    ("rays postponed", "deadlock.postponed"),
    ("traversal unit's use", "units.traversal.utilisation"), ("shading unit's use", "units.shading.utilisation"),
    ("geometry's use", "stages.geometry.utilisation"), ("precomputation's use", "stages.precomputation.utilisation"),
    ("distribution's use", "stages.distribution.utilisation"), ("exterior's use", "stages.exterior.utilisation"),
    ("ray store, peak", "ray_store.peak"), ("ray store, mean", "ray_store.mean"),
    ("bits of a ray", "message_bits.ray"), ("bits of buffers, slots and registers", "storage_bits.total"),
    ("voxels", "voxels.stored"), ("bits of a voxel", "voxels.bits_each"),
    ("most bits of voxels in a cell", "voxels.max_bits_per_cell"),
    ("PSNR, dB", "accuracy.scene.psnr_db"), ("SSIM", "accuracy.scene.ssim"), ("FLIP", "accuracy.scene.flip"),
    ("picture's hash", "hash.image"), ("schedule's hash", "hash.schedule"),
]


def at(report, path):
    for key in path.split("."):
        report = report.get(key) if isinstance(report, dict) else None
    return report


def shown(value):
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.4g}"
    return f"{value:,}".replace(",", "\u202f") if isinstance(value, int) else str(value)


def figures(a, b):
    """A table of key figures, and how far the second run is from the first."""
    rows = []
    for name, path in FIGURES:
        x, y = at(a, path), at(b, path)
        if x is None and y is None or (x == 0 and y == 0):
            continue
        numbers = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (x, y))
        if x == y:
            change = "equal"
        elif numbers and x:
            change = f"{100 * (y - x) / x:+.1f} %"
        else:
            change = "" if numbers or x is None or y is None else "differs"
        rows.append(f"<tr><td>{name}</td><td class=number>{html.escape(shown(x))}</td><td class=number>"
                    f"{html.escape(shown(y))}</td><td class=number>{change}</td></tr>")
    return f"<div class=scroll><table><tr><th><th class=number>first<th class=number>second<th></tr>{''.join(rows)}</table></div>"


def option_text(value):
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return str(value).lower() if isinstance(value, bool) else str(value)


def settings(a, b):
    """The options that differ."""
    rows = []
    for key in dict.fromkeys([*a["config"], *b["config"]]):
        x, y = a["config"].get(key), b["config"].get(key)
        if x != y and key != "output":
            words = [option_text(v) for v in (x, y)]
            rows.append(f"<tr><td>--{html.escape(key)}</td>" +
                        "".join(f"<td>{html.escape(w)}</td>" for w in words) + "</tr>")
    if not rows:
        return "<p>No option differs.</p>"
    return f"<div class=scroll><table><tr><th>option<th>first<th>second</tr>{''.join(rows)}</table></div>"


def palette():
    anchors = [[int(c[i:i + 2], 16) for i in (0, 2, 4)] for c in DIVERGING]
    return report_maps.palette_between(anchors)


def difference_map(x, y, title, width, height, name):
    """The second run's values less the first one's: linear, white where equal."""
    apart = [v - u for u, v in zip(x, y)]
    most = max(map(abs, apart))
    if most == 0:
        return f'<figure class="map"><figcaption>{html.escape(title)}</figcaption><p>equal in every cell</p></figure>'
    middle = (SHADES - 1) / 2
    shades = bytes(int(middle + v / most * middle + 0.5) for v in apart)
    picture = report_maps.data_uri(report_maps.indexed_png(width, height, shades, palette()))
    bar = "linear-gradient(to right," + ",".join("#" + c for c in DIVERGING) + ")"
    ticks = "".join(f"<span>{number(v)}</span>" for v in (-most, 0, most))
    return (f'<figure class="map"><figcaption>{html.escape(title)}</figcaption><img data-map="{name}" src="{picture}" '
            f'style="{report_maps.shape(width, height, 18)}" alt="map of {html.escape(title)}"><div class="bar" '
            f'style="background:{bar}"></div><div class="ticks">{ticks}</div></figure>')


def maps(cells, width, height):
    """HTML of each column's three maps, and the values for the page's script."""
    parts, values = [], {}
    for group, meaning, columns in report_maps.GROUPS:
        rows = []
        for column, title, linear in columns:
            if any(column not in c or max(c[column]) <= 0 for c in cells):
                continue
            x, y = (c[column] for c in cells)
            most = max(max(x), max(y))
            rows.append('<div class="three">' + "".join(
                report_maps.one_map(v, f"{title}, {which}", linear, width, height, f"{column} {which}", most)
                for v, which in ((x, "first"), (y, "second"))) +
                difference_map(x, y, f"{title}, second less first", width, height, f"{column} apart") + "</div>")
            values[f"{column} first"] = plain(x)
            values[f"{column} second"] = plain(y)
            values[f"{column} apart"] = plain([v - u for u, v in zip(x, y)])
        if rows:
            parts.append(f"<section><h2>{group}</h2><p>{meaning}</p>{''.join(rows)}</section>")
    return "".join(parts), values


def plain(values):
    return [int(v) if v == int(v) else v for v in values]


def pictures(images, width, height):
    """Both pictures and, drawn by the page's script, their difference; `images` are their data, or None."""
    if not all(images):
        return "<p class=note>A picture is missing beside its JSON.</p>"
    shape = report_maps.shape(width, height, 24)
    parts = [f'<figure><img id="{name}" src="{image}" style="{shape}" alt="the {which} picture"><figcaption>{which}'
             "</figcaption></figure>"
             for name, which, image in zip(("picture", "other-picture"), ("first", "second"), images)]
    parts.append(f'<figure><canvas id="difference" width="{width}" height="{height}" style="{shape}" role="img" '
                 'aria-label="the difference"></canvas><figcaption id="difference-words"></figcaption></figure>')
    return f'<div class="three">{"".join(parts)}</div>'


def charts(a, b, pixels):
    drawn = report_charts.activity([a, b], pixels)
    if not drawn:
        return ""
    return ("<section><h2>Activity over time</h2><p>The first run filled, the second as a line of its own "
            f"colour.</p>{drawn}</section>")
