"""Makes a page of a run's results: HTML without external files."""
import argparse
import html
import json
import os
import pathlib
import sys

from studies.report import charts as report_charts
from studies.report import maps as report_maps
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

STYLE = """
:root { color-scheme: light dark; --paper: #fcfcfb; --card: #f1f1ee; --ink: #1b1b19; --soft: #63635d; --line: #d9d9d3;
  --accent: #2a6fbb; --area: #2a6fbb26; --good: #1d7a3e; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --paper: #161614; --card: #22221f; --ink: #ecece6; --soft: #a5a59c;
  --line: #3a3a35; --accent: #7fb2ec; --area: #7fb2ec2e; --good: #6fcf8f; --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 75rem; padding: 1.2rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; line-height: 1.2; margin: 0; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .3rem; }
p { margin: .3rem 0 .7rem; max-width: 46rem; } section > p, .note, figcaption, .map p { color: var(--soft); }
figure { margin: 0; } figcaption { font-size: .87rem; margin: .2rem 0; }
.head { display: grid; grid-template-columns: minmax(0, 22rem) minmax(0, 1fr); gap: 1.4rem; margin-top: 1.1rem; }
.head img { width: 100%; image-rendering: pixelated; display: block; }
.verdict { font-size: 1.25rem; font-weight: 650; color: var(--bad); } .verdict.completed { color: var(--good); }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(9.5rem, 1fr)); gap: .5rem; margin: .8rem 0 0; }
dl div { background: var(--card); border-radius: .4rem; padding: .45rem .65rem; }
dt { color: var(--soft); font-size: .8rem; } dd { margin: 0; font-size: 1.05rem; font-variant-numeric: tabular-nums; }
dd small { color: var(--soft); font-size: .8rem; display: block; line-height: 1.35; }
.maps { display: grid; grid-template-columns: repeat(auto-fill, minmax(13.5rem, 1fr)); gap: 1.1rem; }
.map figcaption { color: var(--ink); } .map p { font-size: .8rem; margin: 0; }
.map img { width: 100%; display: block; image-rendering: pixelated; }
.bar { height: .5rem; margin-top: .3rem; background: BAR; }
.ticks { display: flex; justify-content: space-between; font-size: .75rem; font-variant-numeric: tabular-nums; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(16rem, 100%), 1fr)); gap: .6rem 1rem; }
svg { display: block; width: 100%; } .chart figcaption { color: var(--ink); }
svg text { font: 11px system-ui, sans-serif; fill: var(--soft); } svg text.mark { fill: var(--bad); }
.grid { stroke: var(--line); stroke-width: 1; } .area { fill: var(--area); }
.line { fill: none; stroke: var(--accent); stroke-width: 1.6; }
.mark { stroke: var(--bad); stroke-width: 1; stroke-dasharray: 3 3; } text.mark { stroke: none; }
.knot { max-width: 46rem; margin: .5rem 0; } .knot > div { display: flex; flex-wrap: wrap; gap: 1rem; }
.field { fill: var(--card); stroke: var(--soft); stroke-width: .05; }
.cells { stroke: var(--line); stroke-width: .04; fill: none; } .stuck { fill: var(--bad); fill-opacity: .38; }
.edge { stroke: var(--bad); stroke-width: .09; fill: none; }
table { border-collapse: collapse; font-size: .87rem; } th { text-align: left; color: var(--soft); font-weight: 500; }
td, th { padding: .2rem .8rem .2rem 0; vertical-align: top; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.word { white-space: nowrap; } 
.share { display: block; height: .55rem; margin-top: .4rem; background: var(--accent); }
.scroll { overflow-x: auto; } .config { columns: 19rem; column-gap: 2rem; }
.config div { display: flex; justify-content: space-between; gap: 1rem; border-bottom: 1px solid var(--line);
  font-size: .87rem; break-inside: avoid; } .config b { font-weight: 400; color: var(--soft); }
.config span { text-align: right; } pre { font-size: .8rem; white-space: pre-wrap; margin: .4rem 0; }
@media (max-width: 44rem) { body { padding: .8rem; } .head { grid-template-columns: minmax(0, 1fr); }
  .maps { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .8rem; } }
@media print { :root { --paper: #fff; --card: #f4f4f2; --ink: #000; --soft: #444; --line: #ccc; --accent: #1f5f9f;
  --area: #1f5f9f26; --good: #175f31; --bad: #9c1f18; } body { font-size: 10.5pt; max-width: none; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } figure, tr, dl div { break-inside: avoid; }
  h2 { break-after: avoid; } .maps { grid-template-columns: repeat(4, 1fr); } .ticks { font-size: .65rem; }
  .charts { grid-template-columns: repeat(2, 1fr); } }
""".replace("BAR", report_maps.bar_style())


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
            tiles.append(tile(name, percent(stage["utilisation"]), f"{plain(stage['items'])} items"))
        store = report.get("ray_store", {})
        if store:
            tiles.append(tile("ray store", f"peak {store['peak']} of {store['capacity']}", f"mean {store['mean']:.3g}"))
        buffers = report.get("buffers", {})
        if buffers.get("peak"):
            means = {k: v for k, v in buffers.get("mean", {}).items() if k != "load"}
            fullest = f"{max(means.values(), default=0):.2g}"
            tiles.append(tile(f"mean in buffers of {buffers['depth']}", "up to " + fullest,
                              ", ".join(f"{k} {v:.2g}" for k, v in means.items())))
        tiles.append(tile("rays postponed", plain(report["deadlock"].get("postponed", 0))))
    voxels = report.get("voxels", {})
    if voxels:
        tiles.append(tile("voxels", plain(voxels["stored"]),
                          f"most in a cell {voxels['max_per_cell']}, {voxels['bits_each']:.0f} bits each"))
    if "accuracy" in report:
        a = report["accuracy"]
        tiles.append(tile("accuracy", f"{a['psnr_db']:.1f} dB", f"other first hit {a['wrong_hit_percent']:.2g} %"))
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
    def shown(value):
        if isinstance(value, list):
            return ", ".join(map(str, value)) or "none"
        return str(value).lower() if isinstance(value, bool) else str(value)
    rows = "".join(f"<div><b>{text(k)}</b><span>{text(shown(v)) or '–'}</span></div>"
                   for k, v in config.items() if k != "cost")
    cost = f"<p>cost: {text(shown(config['cost']))}</p>" if "cost" in config else ""
    return f'<section><h2>Configuration</h2><div class="config">{rows}</div>{cost}</section>'


def beside(path, suffix):
    """The run's file with this suffix, or None."""
    stem = path[:-5] if path.endswith(".json") else path
    file = pathlib.Path(stem + suffix)
    return file if file.is_file() else None


def picture_part(path, width, height):
    file = beside(path, ".png")
    if not file:
        return "<p class=note>The picture is missing beside the JSON.</p>"
    return (f'<figure><img src="{report_maps.data_uri(file.read_bytes())}" style="'
            f'{report_maps.shape(width, height, 24)}" alt="the picture">'
            f"<figcaption>{width} × {height} cells</figcaption></figure>")


def page(path):
    report, width, height = read_run(path)
    config, verdict = report["config"], report["verdict"]
    scene = pathlib.PurePath(str(config.get("scene", ""))).name
    file = beside(path, ".cells.csv")
    try:
        cells = report_maps.read_cells(file, width, height) if file else {}
    except (OSError, ValueError) as error:
        raise Failure(f"{file}: not this run's cells ({error})") from error
    hashes = report.get("hash", {})
    engine = "" if report["cycles"]["total"] else " The untimed engine has no cycles, buffers or waiting."
    parts = [
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{text(scene)}, {width}x{height}: {text(verdict)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{text(scene)} in {width} × {height} cells</h1>",
        f'<div class="head">{picture_part(path, width, height)}<div>',
        f'<div class="verdict {text(verdict)}">{text(verdict)}</div><p>{text(VERDICTS.get(verdict, ""))}.{engine}</p>',
        key_figures(report), "</div></div>", deadlock_part(report, width, height)]
    charts = report_charts.activity(report, width * height)
    if charts:
        each = plain(report["activity"]["bucket_cycles"])
        parts.append("<section><h2>Activity over time</h2><p>Over precast and trace, and for the loading apart: means "
                     f"of {each} cycles each.</p>{charts}</section>")
    parts.append(stalls(cells))
    parts.append(report_maps.sections(cells, width, height) if cells else
                 "<p class=note>The maps are missing: there is no .cells.csv beside the JSON.</p>")
    parts.append(configuration(config))
    parts.append(f"<p class=note>hash.image {text(hashes.get('image', ''))}, hash.schedule "
                 f"{text(hashes.get('schedule', ''))}</p></body></html>\n")
    return "\n".join(parts)


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


def main(_root, words):
    parser = argparse.ArgumentParser(prog="scripts/study report", description="Makes a page of a run: one HTML file.")
    parser.add_argument("run", metavar="RUN.json",
                        help="what raycell render wrote; RUN.png and RUN.cells.csv lie beside it")
    parser.add_argument("-o", "--output", metavar="FILE.html", help="default: RUN.html")
    try:
        options = parser.parse_args(words)
    except SystemExit as end:
        return 1 if end.code else 0
    target = options.output or (options.run[:-5] if options.run.endswith(".json") else options.run) + ".html"
    try:
        write(target, page(options.run))
    except (KeyError, TypeError, IndexError) as error:
        print(f"study report: {options.run}: not a run's JSON; missing or of another kind: {error}", file=sys.stderr)
        return 1
    except Failure as failure:
        print(f"study report: {failure}", file=sys.stderr)
        return 1
    print(f"study report: {target}")
    return 0
