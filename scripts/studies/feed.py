"""Loads scenes over feeds of other widths, numbers of lanes and queues of spans in the cells, and writes the cycles of loading."""
import json
import sys

from studies import programs, tables

SCENES = ["still_life", "teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]
CELLS = "128x128"
FEEDS = [(lanes, bits, 0) for lanes, bits in
         [(1, 20), (1, 128), (4, 128), (16, 20), (16, 64), (16, 128), (16, 512), (64, 128), (128, 512)]]
FEEDS += [(16, 128, queue) for queue in (1, 2, 4, 8, 16, 32)]
DEFAULT = (16, 128, 0)


def words_of(feed):
    lanes, bits, queue = feed
    return ["--cells", CELLS, "--feed-lanes", lanes, "--feed-bits", bits, "--load-queue", queue, "--quiet"]


def run(root, scenes, cache, scene, feed):
    """The JSON of a run that only loads. A finished run of the same program is not repeated."""
    prefix = cache / "{}.{}.{}.{}".format(scene, *feed)
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        programs.run(root / "build" / "raycell", "render", scenes[scene], "-o", prefix, "--stage", "load", *words_of(feed))
    return json.loads(result.read_text())


def bound(root, scenes, cache, scene):
    """What loading with the default feed can't be faster than, as loading_tb has it."""
    prefix = cache / f"{scene}.bound"
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        programs.run(root / "build" / "loading_tb", scenes[scene], "-o", prefix, *words_of(DEFAULT))
    return json.loads(result.read_text())["bound"]


def load_table(results):
    lines = []
    for feed in FEEDS:
        lanes, bits, queue = feed
        one = results[SCENES[0], feed]["feed_bits"]
        mark = "**" if feed == DEFAULT else ""
        lines.append([f"{mark}{lanes}{mark}", bits, queue or "no limit", f"{one['total']:,}", f"{one['wires']:,}"] +
                     [f"{results[scene, feed]['cycles']['load']:,}" for scene in SCENES])
    return tables.table(["lanes", "bits", "queue", "feed, bits", "wires"] + SCENES, lines)


def bound_table(results, bounds):
    lines = []
    for scene in SCENES:
        report = results[scene, DEFAULT]
        voxels, load = report["voxels"], report["cycles"]["load"]
        lines.append([scene, f"{load:,}", f"{bounds[scene]['cycles']:,}", bounds[scene]["of"],
                      f"{100 * bounds[scene]['cycles'] / load:.0f} %", report["load_queue"]["peak"], f"{voxels['max_bits_per_cell']:,}",
                      f"{report['load_queue']['max_bits_per_cell'] / voxels['max_bits_per_cell']:.2f}"])
    return tables.table(["scene", "cycles", "bound", "of", "reached", "most spans kept", "fullest cell's voxels, bits",
                         "most while loading, times that"], lines)


def main(root, words):
    scenes, out, cache = programs.scene_study("feed", root, words, __doc__, SCENES)
    jobs = [(s, f) for s in SCENES for f in FEEDS]
    results = programs.on_all_cores(lambda *job: run(root, scenes, cache, *job), jobs)
    bounds = programs.on_all_cores(lambda scene: bound(root, scenes, cache, scene), [(s,) for s in SCENES])
    for scene in SCENES:  # the feed changes no voxel
        if len({json.dumps([results[scene, f]["voxels"][key] for key in ("stored", "bits_total", "max_per_cell")]) +
                results[scene, f]["hash"]["image"] for f in FEEDS}) != 1:
            sys.exit(f"feed: the voxels of {scene} differ between feeds")
    text = ["# The feed\n\nMade by `scripts/study feed`: cycles of loading, "
            f"{CELLS} cells, otherwise the default machine; the default feed is in bold. Voxels and pictures are equal.\n\n"
            "`lanes`: geometry and precomputation units, each for its rows (`--feed-lanes`); `bits`: of their links and of those down "
            "the rows (`--feed-bits`); `queue`: spans that a cell keeps until their voxels are made (`--load-queue`); then what the feed stores.\n",
            load_table(results), "\n## What binds\n\nThe bound is what the busiest unit or link has to do, or the way of one span that never waits "
            "([loading_tb](../reference/loading_tb.md)). Spans that wait stand in the memory of voxels.\n",
            bound_table(results, {s: bounds[(s,)] for s in SCENES})]
    (out / "feed.md").write_text("\n".join(text) + "\n")
    print((out / "feed.md").read_text())
