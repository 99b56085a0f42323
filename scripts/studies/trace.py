"""Traces scenes with other buffers, units, ray stores, networks, exterior processors and starts, and writes whole frames' cycles and bits."""
import json
import statistics
import sys

from studies import programs, tables

SCENES = ["still_life", "teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]
CELLS = "128x128"
# Exterior processors, buffers, units that make voxels and units that test rays, ray store, networks.
DEFAULT = (4096, 2, 2, 8, "half")
MACHINES = [(64, 1, 1, 8, "half"), (1024, 1, 1, 8, "half"), (4096, 1, 1, 8, "half"), (4096, 2, 1, 8, "half"), (4096, 1, 2, 8, "half"),
            (64, 2, 2, 8, "half"), (1024, 2, 2, 8, "half"), DEFAULT, (4096, 2, 2, 6, "half"), (4096, 2, 2, 7, "half"),
            (4096, 2, 2, 8, "quadrant"), (4096, 4, 2, 8, "half"), (4096, 2, 4, 8, "half"), (4096, 4, 4, 8, "quadrant")]
# Cycles over which primary rays start, and seeds.
STARTS = (0, 2500, 5000, 10000, 20000, 30000)
SEEDS = (1, 2, 3)


def run(root, scenes, cache, scene, machine, start=0, seed=1):
    """The JSON of a whole run. A finished run of the same program is not repeated."""
    prefix = cache / "{}.{}.{}.{}.{}.{}.{}.{}".format(scene, *machine, start, seed)
    result = prefix.with_name(prefix.name + ".json")
    processors, buffers, units, store, networks = machine
    if not result.exists():
        programs.run(root / "build" / "raycell", "render", scenes[scene], "-o", prefix, "--cells", CELLS, "--exterior-processors", processors,
                     "--buffer", buffers, "--loading-units", units, "--traversal-units", units, "--ray-store", store,
                     "--networks", networks, "--start-within", start, "--seed", seed, "--quiet")
    return json.loads(result.read_text())


def cycles_table(results, key):
    lines = []
    for machine in MACHINES:
        mark = "**" if machine == DEFAULT else ""
        bits = results[SCENES[0], machine]["storage_bits"]["total"]
        lines.append([f"{mark}{machine[0]}{mark}", *machine[1:], f"{bits:,}"] + [f"{results[scene, machine]['cycles'][key]:,}" for scene in SCENES])
    return tables.table(["exterior processors", "buffers", "units", "M", "networks", "bits of a cell"] + SCENES, lines)


def start_table(results):
    """Medians over the seeds."""
    lines = []
    for start in STARTS:
        cycles = [statistics.median(results[scene, start, seed]["cycles"]["trace"] for seed in SEEDS) for scene in SCENES]
        lines.append([f"{start:,}"] + [f"{c:,}" for c in cycles])
    return tables.table(["cycles"] + SCENES, lines)


def bound_table(results):
    lines = []
    for scene in SCENES:
        report = results[scene, DEFAULT]
        line = [scene]
        for phase in ("load", "trace"):
            bound, cycles = report["bound"][phase], report["cycles"][phase]
            line += [f"{cycles:,}", f"{bound['cycles']:,}", bound["of"], f"{cycles / max(bound['cycles'], 1):.2f}"]
        lines.append(line)
    return tables.table(["scene", "load", "bound", "of", "times", "trace", "bound", "of", "times"], lines)


def main(root, words):
    scenes, out, cache = programs.scene_study("trace", root, words, __doc__, SCENES)
    results = programs.on_all_cores(lambda *job: run(root, scenes, cache, *job), [(s, m) for s in SCENES for m in MACHINES])
    jobs = [(s, DEFAULT, start, seed) for s in SCENES for start in STARTS for seed in SEEDS]
    starts = {(s, start, seed): report
              for (s, _, start, seed), report in programs.on_all_cores(lambda *job: run(root, scenes, cache, *job), jobs).items()}
    for scene in SCENES:  # none of this changes a picture
        of_scene = [results[scene, m] for m in MACHINES] + [r for (s, *_), r in starts.items() if s == scene]
        if len({report["hash"]["image"] for report in of_scene}) != 1:
            sys.exit(f"trace: the pictures of {scene} differ between machines")
    text = ["# The trace, and what relieves it\n\nMade by `scripts/study trace`: whole frames, "
            f"{CELLS} cells, otherwise the default machine, which is in bold. Pictures are equal.\n\n"
            "`exterior processors`: `--exterior-processors`, 200 cycles a ray each; `buffers`: messages (`--buffer`); `units`: of each cell, that make "
            "voxels and that test rays (`--loading-units`, `--traversal-units`); `M`: slots of the ray store (`--ray-store`); bits: what a cell "
            "stores beside its voxels, of still_life with its one source.\n\n## Cycles of the trace\n",
            cycles_table(results, "trace"), "\n## Cycles of a frame: loading and trace\n", cycles_table(results, "total"),
            f"\n## Starts of primary rays\n\nThe default machine, `--start-within`: the median of the trace over {len(SEEDS)} seeds.\n",
            start_table(starts), "\n## What binds the default machine\n\n`bound`: the busiest link, unit or exterior of the run.\n", bound_table(results)]
    (out / "trace.md").write_text("\n".join(text) + "\n")
    print((out / "trace.md").read_text())
