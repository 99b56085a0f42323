"""Makes a page of a run's results: HTML without external files."""
import argparse
import html
import json
import os
import pathlib
import sys

from studies.report import charts as report_charts
from studies.report import maps as report_maps
from studies.report import pair, recorded
from studies.report.maps import number

CAUSES = [
    ("stall_traversal", "an untested ray at the head of its buffer: the traversal unit is at work"),
    ("stall_output_full", "a tested ray: no room in the next cell's buffer"),
    ("stall_output_busy", "a tested ray: room, but the link's wires carry another message"),
    ("stall_no_slot", "a hit: no slot that it may take (--recovery none)"),
    ("stall_shading", "a hit or a slot: the shading unit is at work"),
    ("stall_store_port", "a hit or an answer at home: the ray store's write port is taken"),
    ("stall_answer_full", "an answer: no room in the next cell's buffer"),
    ("stall_answer_busy", "an answer: room, but the link's wires carry another message"),
]
VERDICTS = {
    "completed": "every pixel is done",
    "deadlock": "nothing moves any more",
    "livelock": "rays are postponed and sent again, and no answer comes home",
    "cycle_limit": "stopped at --max-cycles",
    "capacity": "voxels did not fit --voxel-capacity",
}
REPORT_LINES_SHOWN = 12
FOLDER = pathlib.Path(__file__).parent

STYLE = (FOLDER / "page.css").read_text().replace("BAR", report_maps.bar_style())


SCRIPTLESS = ("<noscript><p class=note>Values under the pointer, the film and the rays of a pixel need "
              "JavaScript.</p></noscript>")


class Failure(Exception):
    """Something that ends the program with one line."""


def read_run(path):
    """A run's JSON and the size of its array."""
    try:
        report = json.loads(pathlib.Path(path).read_text())
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not JSON"
        raise Failure(f"{path}: can't be read ({reason}); expected the JSON that raycell render wrote") from error
    keys = ("verdict", "cycles", "hops", "rays", "config", "deadlock")
    cells = report.get("config", {}).get("cells", "") if isinstance(report, dict) else ""
    if not isinstance(report, dict) or any(k not in report for k in keys) or not isinstance(cells, str):
        raise Failure(f"{path}: not a run's JSON; expected what raycell render wrote, with the keys {', '.join(keys)}")
    width, _, height = cells.partition("x")
    if not (width.isdigit() and height.isdigit() and int(width) > 0 and int(height) > 0):
        raise Failure(f"{path}: not a run's JSON; expected config.cells to be WxH")
    return report, int(width), int(height)


def picture_size(report, width, height):
    """Pixels of the picture of a run in so many cells, across and down."""
    wide, _, high = str(report["config"].get("pixels", "")).partition("x")
    return (int(wide), int(high)) if wide.isdigit() and high.isdigit() else (width, height)


def text(value):
    return html.escape(str(value))


def percent(share):
    return f"{100 * share:.1f} %"


def plain(value):
    return f"{value:,}".replace(",", "\u202f")


def tile(name, value, more=""):
    small = f"<small>{text(more)}</small>" if more else ""
    return f"<div><dt>{text(name)}</dt><dd>{text(value)}{small}</dd></div>"


def key_figures(report):
    cycles, rays, hops = report["cycles"], report["rays"], report["hops"]
    timed = cycles["total"] > 0
    tiles = []
    if timed:
        parts = [f"load {plain(cycles['load'])}"]
        if cycles["precast"]:
            parts.append(f"precast {plain(cycles['precast'])}")
        tiles.append(tile("cycles", plain(cycles["total"]), ", ".join(parts + [f"trace {plain(cycles['trace'])}"])))
        tiles.append(tile("time at the clock", f"{1000 * report.get('simulated_seconds', 0):.4g} ms",
                          f"{report['config'].get('clock-mhz', '?')} MHz"))
    kinds = [k for k in ("primary", "reflected", "refracted", "shadow", "precast") if rays.get(k)]
    tiles.append(tile("rays", plain(sum(rays[k] for k in kinds)), ", ".join(f"{k} {plain(rays[k])}" for k in kinds)))
    tiles.append(tile("hops", plain(hops["ray"] + hops["return"]),
                      f"rays {plain(hops['ray'])}, answers {plain(hops['return'])}, load {plain(hops['load'])}"))
    if timed:
        sent = report.get("messages", {})
        if "rays" in sent:
            tiles.append(tile("messages sent", plain(sent["rays"]["sent"] + sent["answers"]["sent"]),
                              f"rays {plain(sent['rays']['sent'])}, answers {plain(sent['answers']['sent'])}"))
        for name, unit in report.get("units", {}).items():
            tiles.append(tile(f"{name} unit", percent(unit["utilisation"]), "of the cells' cycles"))
        for name, stage in report.get("stages", {}).items():
            tiles.append(tile(name, percent(stage["utilisation"]), f"of its cycles busy; {plain(stage['items'])} items"))
        store = report.get("ray_store", {})
        if store:
            tiles.append(tile("ray store", f"peak {store['peak']} of {store['capacity']}", f"mean {store['mean']:.3g}"))
        buffers = report.get("buffers", {})
        if buffers.get("peak"):
            means = {k: v for k, v in buffers.get("mean", {}).items() if k != "load"}
            fullest = f"{max(means.values(), default=0):.2g}"
            tiles.append(tile("messages in a buffer, mean", f"up to {fullest} of {buffers['depth']}",
                              ", ".join(f"{k} {v:.2g}" for k, v in means.items())))
        tiles.append(tile("rays postponed", plain(report["deadlock"].get("postponed", 0))))
    voxels = report.get("voxels", {})
    if voxels:
        tiles.append(tile("voxels", plain(voxels["stored"]),
                          f"most in a cell {voxels['max_per_cell']}, {voxels['bits_each']:.0f} bits each"))
    if "accuracy" in report:
        a = report["accuracy"]
        tiles.append(tile("accuracy", f"{a['scene']['psnr_db']:.1f} dB", f"other first hit {a['wrong_hit_percent']:.2g} %"))
    return f"<dl>{''.join(tiles)}</dl>"


def stalls(cells):
    """A table of the waiting of all cells, by cause."""
    sums = {c: sum(cells[c]) for c, _ in CAUSES if c in cells}
    total = sum(sums.values())
    if not sums:
        return ""
    rows = []
    for cause, meaning in CAUSES:
        if cause in sums:
            share = sums[cause] / total if total else 0
            rows.append(f"<tr><td class=word>{cause[6:]}</td><td class=number>{number(sums[cause])}</td>"
                        f"<td class=number>{percent(share)}</td><td style='min-width:6rem'>"
                        f"<span class=share style='width:{100 * share:.2f}%'></span></td><td>{text(meaning)}</td></tr>")
    return ("<section><h2>Waiting by cause</h2><p>Cycles of all cells, summed over all that waited.</p>"
            "<div class=scroll><table><tr><th>cause<th class=number>cycles<th class=number>share<th><th>what waits for "
            f"what</tr>{''.join(rows)}</table></div></section>")


def why(deadlock):
    """Why such a machine may not end, and the options with which it is certain to."""
    bound = deadlock.get("bound") or {}
    if bound.get("met", True) or not bound.get("reason"):
        return ""
    cure = f" With <code>{text(bound['options'])}</code> it is certain to end." if bound.get("options") else ""
    reason = str(bound["reason"])
    return f"<p>{text(reason[0].upper() + reason[1:])}.{cure}</p>"


def deadlock_part(report, width, height):
    deadlock = report["deadlock"]
    lines = [str(line) for line in deadlock.get("report") or []]
    if not lines and not deadlock.get("knot"):
        return ""
    parts = [f"<section><h2>What is stuck</h2>{why(deadlock)}{report_charts.array_picture(deadlock, width, height)}"]
    if lines:
        parts.append(f"<p>Oldest first:</p><pre>{text(chr(10).join(lines[:REPORT_LINES_SHOWN]))}</pre>")
    if len(lines) > REPORT_LINES_SHOWN:
        rest = text("\n".join(lines[REPORT_LINES_SHOWN:]))
        parts.append(f"<details><summary>{len(lines) - REPORT_LINES_SHOWN} more</summary><pre>{rest}</pre></details>")
    return "".join(parts) + "</section>"


def configuration(config):
    rows = "".join(f"<div><b>{text(k)}</b><span>{text(pair.option_text(v)) or '–'}</span></div>"
                   for k, v in config.items() if k != "cost")
    cost = f"<p>cost: {text(pair.option_text(config['cost']))}</p>" if "cost" in config else ""
    return f'<section><h2>Configuration</h2><div class="config">{rows}</div>{cost}</section>'


def beside(path, suffix):
    """The run's file with this suffix, or None."""
    stem = path[:-5] if path.endswith(".json") else path
    file = pathlib.Path(stem + suffix)
    return file if file.is_file() else None


def picture_part(path, width, height, name="picture"):
    file = beside(path, ".png")
    lines = (f'<svg id="ray-lines" viewBox="0 0 {width} {height}" preserveAspectRatio="none" aria-hidden="true"></svg>'
             if name == "picture" else "")
    shape = report_maps.shape(width, height, 24)
    if not file:
        return (f'<figure><div class="picture blank" id="{name}" style="{shape}">{lines}</div><figcaption>{width} × {height} '
                f"cells, without a picture</figcaption></figure>")
    return (f'<figure><div class="picture" style="{shape}"><img id="{name}" src="{report_maps.data_uri(file.read_bytes())}" '
            f'style="{shape}" alt="the picture">{lines}</div><figcaption>{width} × {height} cells</figcaption></figure>')


def truth_part(path, report):
    """Picture, truth and their difference, if the run has a truth."""
    files = [(name, beside(path, suffix)) for name, suffix in (
        ("the machine's picture", ".png"), ("the truth", ".truth.png"), ("their difference, 8 times as large", ".difference.png"))]
    if "accuracy" not in report or not all(file for _, file in files):
        return ""
    a = report["accuracy"]
    whole = a["scene"]
    rows = [("PSNR", f"{whole['psnr_db']:.2f} dB"), ("SSIM", f"{whole['ssim']:.5f}"), ("FLIP", f"{whole['flip']:.5f}"),
            ("relative MSE", f"{whole['relative_mse']:.3g}"), ("largest error", f"{whole['max_error']:.4f}"),
            ("PSNR of the polygons", f"{a['tessellation']['psnr_db']:.2f} dB"),
            ("PSNR against the polygons", f"{a['psnr_db']:.2f} dB"),
            ("other first hit", f"{a['wrong_hit_percent']:.3g} % of the pixels")]
    figures = "".join(f'<figure><img src="{report_maps.data_uri(file.read_bytes())}" alt="{text(name)}">'
                      f"<figcaption>{text(name)}</figcaption></figure>" for name, file in files)
    return (f'<section><h2>Against the truth</h2><div class="three">{figures}</div>'
            f"<dl>{''.join(tile(n, v) for n, v in rows)}</dl></section>")


def blocks_of(film):
    return film["columns"], film["rows"]


def recordings(path, width, height):
    """The run's film, its rays, and the number of pixels whose rays are in the page (None: all)."""
    film, rays, limit = None, None, None
    for suffix in (".film.json", ".rays.csv"):
        file = beside(path, suffix)
        try:
            if file and suffix == ".film.json":
                film = recorded.read_film(file, width, height)
            elif file:
                rays, limit = recorded.read_rays(file, width)
        except (OSError, ValueError) as error:
            raise Failure(f"{file}: not this run's recording ({error})") from error
    return film, rays, limit


def shown_maps(cells):
    """The columns of the cells' table that have a map, as the page's script reads them."""
    return {c: [int(v) if v == int(v) else v for v in cells[c]]
            for _, _, maps in report_maps.GROUPS for c, _, _ in maps if c in cells}


def page(path):
    report, width, height = read_run(path)
    config, verdict = report["config"], report["verdict"]
    scene = pathlib.PurePath(str(config.get("scene", ""))).name or "synthetic traffic"
    cells = cells_of(path, width, height)
    hashes = report.get("hash", {})
    film, rays, limit = recordings(path, width, height)
    wide, high = picture_size(report, width, height)
    engine = "" if report["cycles"]["total"] else " The untimed engine has no cycles, buffers or waiting."
    parts = [
        opening(f"{scene}, {width}x{height}: {verdict}"),
        f"<h1>{text(scene)} in {width} × {height} cells</h1>",
        f'<div class="head">{picture_part(path, width, height)}<div>',
        f'<div class="verdict {text(verdict)}">{text(verdict)}</div><p>{text(VERDICTS.get(verdict, ""))}.{engine}</p>',
        key_figures(report), "</div></div>", truth_part(path, report),
        recorded.rays_part(rays, limit, wide, high), deadlock_part(report, width, height),
        recorded.film_part(film, report_maps.shape(*blocks_of(film), 18) if film else "")]
    charts = report_charts.activity([report], wide * high)
    if charts:
        each = plain(report["activity"]["bucket_cycles"])
        parts.append("<section><h2>Activity over time</h2><p>Over precast and trace, and for the loading apart: means "
                     f"of {each} cycles each.</p>{charts}</section>")
    parts.append(stalls(cells))
    parts.append(report_maps.sections(cells, width, height) if cells else
                 "<p class=note>The maps are missing: there is no .cells.csv beside the JSON.</p>")
    parts.append(configuration(config))
    parts.append(f"<p class=note>hash.image {text(hashes.get('image', ''))}, hash.schedule "
                 f"{text(hashes.get('schedule', ''))}</p>")
    parts.append(closing({"width": width, "height": height, "wide": wide, "high": high, "maps": shown_maps(cells),
                          "film": film, "rays": rays}))
    return "\n".join(parts)


def opening(title):
    return ('<!doctype html><html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{text(title)}</title><style>{STYLE}</style></head><body>")


def closing(data):
    """The page's data and its script."""
    return (f"{SCRIPTLESS}{recorded.embedded(data)}<script>{(FOLDER / 'page.js').read_text()}</script></body></html>\n")


def cells_of(path, width, height):
    """The columns of the run's cells, empty without a file."""
    file = beside(path, ".cells.csv")
    try:
        return report_maps.read_cells(file, width, height) if file else {}
    except (OSError, ValueError) as error:
        raise Failure(f"{file}: not this run's cells ({error})") from error


def stuck_of(report, which, width, height):
    return deadlock_part(report, width, height).replace("What is stuck", f"What is stuck in the {which}", 1)


def page_of_two(first, second):
    """The page of two runs in arrays of one size."""
    runs = [read_run(path) for path in (first, second)]
    (a, width, height), (b, *size) = runs
    if size != [width, height]:
        raise Failure(f"{second}: {size[0]} x {size[1]} cells; expected {width} x {height} as in {first}")
    wide, high = picture_size(a, width, height)
    if picture_size(b, width, height) != (wide, high):
        raise Failure(f"{second}: a picture of another size; expected {wide} x {high} pixels as in {first}")
    cells = [cells_of(path, width, height) for path in (first, second)]
    files = [beside(path, ".png") for path in (first, second)]
    drawn, values = pair.maps(cells, width, height) if all(cells) else (
        "<p class=note>The maps are missing: there is no .cells.csv beside both JSONs.</p>", {})
    images = [report_maps.data_uri(f.read_bytes()) if f else None for f in files]
    return "\n".join([
        opening(f"{first} and {second}"), f"<h1>Two runs in {width} × {height} cells</h1>",
        f"<p>First: {text(first)}. Second: {text(second)}.</p>", pair.pictures(images, wide, high),
        f"<section><h2>What differs</h2>{pair.settings(a, b)}{pair.figures(a, b)}</section>",
        *(stuck_of(run, which, width, height) for run, which in ((a, "first"), (b, "second"))),
        pair.charts(a, b, wide * high), drawn,
        closing({"width": width, "height": height, "wide": wide, "high": high, "maps": values})])


def write(path, content):
    """Writes the file whole or not at all. Raises Failure."""
    partial = f"{path}.part{os.getpid()}"
    try:
        with open(partial, "w", encoding="utf-8", errors="replace") as stream:
            stream.write(content)
        os.replace(partial, path)
    except OSError as error:
        pathlib.Path(partial).unlink(missing_ok=True)
        raise Failure(f"{path}: can't be written ({error.strerror})") from error


def target_of(run, other):
    """Where the page goes: beside the run."""
    stem = run.removesuffix(".json")
    return f"{stem}.and.{pathlib.PurePath(other).stem}.html" if other else stem + ".html"


def main(_root, words):
    parser = argparse.ArgumentParser(prog="scripts/study report", description="Makes a page of a run: one HTML file.")
    parser.add_argument("run", metavar="RUN.json",
                        help="what raycell render or deadlock_tb wrote; RUN.png, RUN.cells.csv and so on lie beside it")
    parser.add_argument("other", metavar="OTHER.json", nargs="?", help="a second run in an array of the same size: the page "
                        "shows both and what differs")
    parser.add_argument("-o", "--output", metavar="FILE.html", help="default: RUN.html; of two runs RUN.and.OTHER.html")
    try:
        options = parser.parse_args(words)
    except SystemExit as end:
        return 1 if end.code else 0
    target = options.output or target_of(options.run, options.other)
    try:
        write(target, page_of_two(options.run, options.other) if options.other else page(options.run))
    except (KeyError, TypeError, IndexError) as error:
        print(f"study report: {options.run}: not a run's JSON; missing or of another kind: {error}", file=sys.stderr)
        return 1
    except Failure as failure:
        print(f"study report: {failure}", file=sys.stderr)
        return 1
    print(f"study report: {target}")
    return 0
