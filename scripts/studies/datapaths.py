"""Runs scenes with the cycles of each datapath and writes what that makes of a frame, and which units bind it."""
import csv
import json
import sys

from studies import programs

SCENES = ["still_life", "teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]
DATAPATHS = ["estimate", "word", "wide", "two"]
CELLS = "64x64"


def run(root, scenes, cache, scene, datapath):
    """One timed render; returns its JSON and the cycles of its cells' units. A finished run of the same program is
    not repeated."""
    prefix = cache / f"{scene}.{datapath}"
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        programs.run(root / "build" / "raycell", "render", scenes[scene], "-o", prefix, "--cells", CELLS, "--datapath",
                     datapath, "--quiet")
    report = json.loads(result.read_text())
    with open(prefix.with_name(prefix.name + ".cells.csv"), newline="") as file:
        cells = list(csv.DictReader(file))
    report["busiest"] = {unit: max(int(c[f"{unit}_cycles"]) for c in cells) / report["cycles"]["trace"]
                         for unit in ("traversal", "shading")}
    report["busiest"]["traversal"] /= report["config"]["traversal-units"]  # the mean of a cell's units
    report["making"] = max(int(c["loading_cycles"]) for c in cells) / report["cycles"]["load"] / report["config"]["loading-units"]
    return report


def frame_table(results):
    lines = ["| scene | load: `estimate` | `word` | trace: " + " | ".join(f"`{d}`" for d in DATAPATHS) +
             " | frame: `estimate` | `word` | ratio |", "|---|---|---|" + "---|" * (len(DATAPATHS) + 3)]
    for scene in SCENES:
        cycles = [results[scene, d]["cycles"] for d in DATAPATHS]
        old, new = cycles[0], cycles[1]
        lines.append(f"| {scene} | {old['load']:,} | {new['load']:,} | " + " | ".join(f"{c['trace']:,}" for c in cycles) +
                     f" | {old['total']:,} | {new['total']:,} | {new['total'] / old['total']:.2f} |")
    return "\n".join(lines)


def units_of(report):
    """Shares of loading, and of the trace, in which units are at work."""
    return {"loading: the busiest cell makes voxels": report["making"],
            "loading: precomputation": report["stages"]["precomputation"]["utilisation"],
            "trace: traversal units, mean": report["units"]["traversal"]["utilisation"],
            "traversal units of the busiest cell": report["busiest"]["traversal"],
            "shading unit of the busiest cell": report["busiest"]["shading"],
            "exterior": report["stages"]["exterior"]["utilisation"]}


def unit_table(results):
    names = list(units_of(results[SCENES[0], DATAPATHS[0]]))
    lines = ["| scene | datapath | " + " | ".join(names) + " |", "|---|---|" + "---|" * len(names)]
    for scene in SCENES:
        for datapath in ("estimate", "word"):
            values = units_of(results[scene, datapath]).values()
            lines.append(f"| {scene} | `{datapath}` | " + " | ".join(f"{100 * v:.1f} %" for v in values) + " |")
    return "\n".join(lines)


def draw(out, results):
    from studies import charts  # needs a library that tables do without
    from matplotlib.patches import Patch
    figure, axes = charts.panels(1, len(SCENES), 2.2 * len(SCENES), 3.2)
    colours = {"load": "#9aa5b1", "trace": "#c8553d"}
    for axis, scene in zip(axes[0], SCENES):
        for place, datapath in enumerate(DATAPATHS):
            cycles = results[scene, datapath]["cycles"]
            axis.bar(place, cycles["load"], color=colours["load"])
            axis.bar(place, cycles["trace"], bottom=cycles["load"], color=colours["trace"])
        axis.set_xticks(range(len(DATAPATHS)), DATAPATHS, rotation=45)
        axis.yaxis.set_major_formatter(charts.thousands)
        axis.set_title(scene, fontsize=9)
    axes[0][0].set_ylabel("cycles of a frame")
    handles = [Patch(color=colour, label=phase) for phase, colour in colours.items()]
    charts.finish(figure, f"Cycles of a frame by datapath, {CELLS} cells, words of 20 bits", handles, 72, out / "datapaths.png")


def main(root, words):
    scenes, out, cache = programs.scene_study("datapaths", root, words, __doc__, SCENES)
    jobs = [(s, d) for s in SCENES for d in DATAPATHS]
    results = programs.on_all_cores(lambda *job: run(root, scenes, cache, *job), jobs)
    for scene in SCENES:  # a picture hangs on no cost
        if len({results[scene, d]["hash"]["image"] for d in DATAPATHS}) != 1:
            sys.exit(f"datapaths: the picture of {scene} differs between datapaths")
    text = ["# Datapaths\n\nMade by `scripts/study datapaths`: whole frames with the costs that were estimated by hand and with those "
            f"counted on three datapaths ([microcode.md](../reference/microcode.md)), {CELLS} cells, words of 20 bits, otherwise the "
            "default machine. The pictures are equal.\n", frame_table(results),
            "\n![Cycles of a frame by datapath](datapaths.png)\n\n## What is at work\n\nShares of loading or of the trace.\n", unit_table(results)]
    (out / "datapaths.md").write_text("\n".join(text) + "\n")
    draw(out, results)
    print((out / "datapaths.md").read_text())
