"""Times the ways of running the model against each other and writes what each costs and can say."""
import argparse
import json
import os
import pathlib
import statistics
import sys
import tempfile

from studies import programs

SCENES = ["teapot-s4", "balls-s2"]
WAYS = {  # name: (rounds, options); the truth is a program of its own
    "truth": (5, None),
    "untimed, exact": (5, ["--engine", "untimed", "--arithmetic", "exact"]),
    "untimed, fixed 20": (5, ["--engine", "untimed", "--arithmetic", "fixed", "--word-bits", "20"]),
    "untimed, fixed 32": (5, ["--engine", "untimed", "--arithmetic", "fixed", "--word-bits", "32"]),
    "timed, exact": (3, ["--engine", "timed", "--arithmetic", "exact"]),
    "timed, fixed 20": (3, ["--engine", "timed", "--arithmetic", "fixed", "--word-bits", "20"]),
}
LIMIT = 3  # most that a render in words may take, as a multiple of one in exact arithmetic
PAIRS = [("untimed, fixed 20", "untimed, exact"), ("untimed, fixed 32", "untimed, exact"),
         ("timed, fixed 20", "timed, exact")]
TWIN = {"untimed, exact": "timed, exact", "untimed, fixed 20": "timed, fixed 20"}


def execute(command):
    """Wall and processor seconds of one process."""
    try:
        done = programs.run(*command)
    except programs.Failed as error:
        sys.exit(f"study speed: {error}")
    return done.wall, done.processor


class Measurement:
    """One way on one scene: its times in the order of the rounds, its report and its picture."""

    def __init__(self, program, scene, cells, prefix, options):
        self.prefix = prefix
        self.command = [program, "truth" if options is None else "render", scene, "-o", prefix, "--cells", cells,
                        "--quiet", *(options or [])]
        self.wall, self.processor = [], []

    def round(self):
        wall, processor = execute(self.command)
        self.wall.append(wall)
        self.processor.append(processor)

    def report(self):
        return json.loads(pathlib.Path(f"{self.prefix}.json").read_text())


def measure(program, scene, cells, folder):
    """Runs all ways in turn, round by round, so that a machine that slows down affects all of them."""
    ways = {name: Measurement(program, scene, cells, folder / name.replace(", ", "-").replace(" ", "-"), options)
            for name, (_, options) in WAYS.items()}
    for way in list(ways.values())[:4]:  # warms the caches for the fast ways
        execute(way.command)
    for number in range(max(rounds for rounds, _ in WAYS.values())):
        for name, way in ways.items():
            if number < WAYS[name][0]:
                print(f"{scene.stem}: round {number + 1}, {name}", file=sys.stderr)
                way.round()
    return ways


def ratio(a, b, kind="wall"):
    """Median of the ratios of rounds that both ran."""
    return statistics.median(x / y for x, y in zip(getattr(a, kind), getattr(b, kind)))


def psnr(program, way, truth):
    return json.loads(programs.run(program, "compare", f"{way.prefix}.exr", f"{truth.prefix}.exr", "--json").output)["psnr_db"]


def sayings(name, report, reports):
    """Whether the run's report has cycles, buffers and a verdict on deadlock, and which picture it is."""
    timed = report.get("cycles", {}).get("total", 0) > 0
    buffers = bool(report.get("buffers", {}).get("peak"))
    if name in TWIN:
        same = report["hash"]["image"] == reports[TWIN[name]]["hash"]["image"]
        picture = "the timed one, bit for bit" if same else "**not the timed one**"
    else:
        picture = {"truth": "the reference"}.get(name, "itself" if timed else "its own (no timed run beside it)")
    yes = {True: "yes", False: "no"}
    return [yes[timed], yes[buffers], yes[timed and buffers], picture]


def scene_lines(program, ways):
    reports = {name: way.report() for name, way in ways.items()}
    base = ways["untimed, exact"]
    lines = []
    for name, way in ways.items():
        wall = statistics.median(way.wall)
        spread = f"{wall:.2f} ({min(way.wall):.2f} to {max(way.wall):.2f})"
        hops = reports[name]["model"].get("hops_per_second")
        accuracy = "0 by definition" if name == "truth" else f"{psnr(program, way, ways['truth']):.1f} dB"
        lines.append([name, spread, f"{statistics.median(way.processor):.2f}", f"{ratio(way, base):.2f}",
                      f"{hops / 1e6:.2f}" if hops else "–", accuracy, *sayings(name, reports[name], reports)])
    return lines


def table(head, lines):
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *lines])


HEAD = ["way", "wall seconds, median (range)", "processor seconds", "time, untimed exact = 1", "million hops/s", "error",
        "cycles", "buffers", "deadlock", "picture"]


def fixed_part(results):
    """The time ratios of words to exact arithmetic, and whether they are within the limit."""
    lines, largest = [], 0
    for scene, ways in results.items():
        both = [(ratio(ways[a], ways[b]), ratio(ways[a], ways[b], "processor")) for a, b in PAIRS]
        largest = max(largest, *(wall for wall, _ in both))
        lines.append([scene] + [f"{wall:.2f} ({processor:.2f})" for wall, processor in both])
    verdict = f"within {LIMIT}" if largest <= LIMIT else f"**not within {LIMIT}**"
    head = ["words / exact arithmetic, wall (processor)", *(a for a, _ in PAIRS)]
    return (f"A render in words takes at most {largest:.2f} times as long as one in exact arithmetic, {verdict}:\n\n"
            + table(head, lines))


def document(program, results, cells):
    scene_parts = "\n\n".join(f"## {scene}\n\n{table(HEAD, scene_lines(program, ways))}"
                              for scene, ways in results.items())
    return f"""# The model's own speed, and what it buys

{cells} cells, whole processes on one core, from reading the scene to writing the picture; all else default. The ways ran
in turn, round by round, after a warm-up: 5 rounds, 3 of the timed ones. Times are of whatever machine this was; the
ratios are medians over rounds of this one run of the script. Command: `scripts/study speed`.

{fixed_part(results)}

*Hops* are messages that crossed from cell to cell, over load, precast and trace; untimed, the steps of rays alone. *Error*
is PSNR of the picture files (32-bit floats) against the truth. *Cycles*, *buffers*, *deadlock*: whether the run says anything about them. The
untimed machine has neither time nor buffers, so it can't: every ray of it comes home. Its picture is the timed one's in
the same arithmetic, so for accuracy, voxels and bits it is all one needs.

{scene_parts}
"""


def main(root, words):
    parser = argparse.ArgumentParser(prog="scripts/study speed", description=__doc__)
    parser.add_argument("folder", nargs="?", metavar="SCENE_FOLDER", type=pathlib.Path,
                        default=root.parent / "shared" / "scenes" / "spd", help="of the SPD scenes")
    parser.add_argument("--cells", default="128x128", metavar="WxH", help="size of the array; default: 128x128")
    parser.add_argument("--program", type=pathlib.Path, default=root / "build" / "raycell", help="the raycell to run")
    parser.add_argument("--out", type=pathlib.Path, default=programs.measured(root) / "speed.md", metavar="FILE",
                        help="default: out/measured/speed.md")
    options = parser.parse_args(words)
    scenes = [options.folder / f"{name}.nff" for name in SCENES]
    for scene in scenes:
        if not scene.is_file():
            sys.exit(f"study speed: {scene} is missing; expected the folder of the SPD scenes as argument")
    program = options.program.resolve()
    if not os.access(program, os.X_OK):
        sys.exit(f"study speed: {program} is not a program; expected raycell")
    with tempfile.TemporaryDirectory() as folder:
        results = {scene.stem: measure(program, scene, options.cells, pathlib.Path(tempfile.mkdtemp(dir=folder)))
                   for scene in scenes}
        text = document(program, results, options.cells)
    options.out.write_text(text)
    print(text)
