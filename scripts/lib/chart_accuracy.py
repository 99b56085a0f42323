"""The sweep behind scripts/chart_accuracy: which runs, making them, and what is written from them."""
import argparse
import os
import pathlib
import signal
import sys

import chart_accuracy_design as design
import chart_accuracy_rows as rows
from chart_accuracy_runs import Sweep
from chart_accuracy_tables import document
from sweep_runs import Stopped


def positive(word):
    if not word.isdigit() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1, not '{word}'")
    return int(word)


def arguments(words):
    parser = argparse.ArgumentParser(prog="scripts/chart_accuracy", description="Sweeps the machine's factors and "
                                     "writes tables and charts of accuracy against bits and cycles.")
    parser.add_argument("folder", nargs="?", metavar="SCENE_FOLDER", type=pathlib.Path,
                        help="of the SPD scenes; default: ../shared/scenes/spd beside the project")
    parser.add_argument("--list", action="store_true", help="print the runs and whether they are finished")
    parser.add_argument("--only", metavar="TEXT", help="only the runs whose name contains it; without --out they are "
                        "only kept for the whole sweep")
    parser.add_argument("--jobs", type=positive, default=os.cpu_count(), help="runs at a time; default: one a core")
    parser.add_argument("--quick", action="store_true", help="a dozen small runs of the project's own scenes; without "
                        "--out they go to out/accuracy-quick")
    parser.add_argument("--out", metavar="FOLDER", type=pathlib.Path, help="all results there, the cache too")
    parser.add_argument("--program", type=pathlib.Path, help="the raycell to run; default: build/raycell, built first")
    parser.add_argument("--from-csv", action="store_true", help="make tables and charts again, without any run")
    return parser.parse_args(words)


class Places:
    """Where things lie: in the project, or all in one folder."""

    def __init__(self, root, out):
        self.tables = out or root / "results"
        self.charts = out or root / "docs"
        self.cache = (out or root / "results") / "cache"
        for folder in (self.tables, self.charts, self.cache):
            folder.mkdir(parents=True, exist_ok=True)
        self.csv = self.tables / "accuracy.csv"


def scene_files(root, folder, names):
    files = {name: root / "scenes" / f"{name}.nff" if name in design.OWN_SCENES else folder / f"{name}.nff"
             for name in names}
    missing = [str(path) for path in files.values() if not path.is_file()]
    if missing:
        sys.exit(f"chart_accuracy: {', '.join(missing)} missing; expected the folder of the SPD scenes as argument")
    return files


def write_results(places, command, seconds=None):
    results = rows.Results(places.csv)
    if not results.scenes:
        print(f"{places.csv}; no timed run in it, so no tables and charts", file=sys.stderr)
        return
    from chart_accuracy_pictures import draw_bits, draw_front, draw_split  # matplotlib: only where it is needed
    (places.tables / "accuracy.md").write_text(document(results, command, seconds))
    draw_front(results, places.charts / "accuracy")
    draw_bits(results, places.charts / "accuracy_bits.png")
    draw_split(results, places.charts / "accuracy_split.png")
    print(f"{places.tables / 'accuracy.md'}, {places.csv}, {places.charts / 'accuracy'}*.png", file=sys.stderr)


def print_list(blocks, runs, done):
    for title, (timed, configurations) in blocks.items():
        print(f"# {title}: {len(set(configurations))} runs, {'timed' if timed else 'untimed'} at least")
    for configuration, timed in runs.items():
        mark = "done " if configuration in done else "     "
        print(f"{mark}{'timed   ' if timed else 'untimed '}{configuration.label()}")
    print(f"# {len(runs)} distinct runs, {sum(runs.values())} timed, {len(done)} finished")


def sweep(options, root, places, command):
    blocks = design.quick_blocks() if options.quick else design.blocks()
    every = design.runs_of(blocks)
    runs = {c: timed for c, timed in every.items() if not options.only or options.only in c.label()}
    if not runs:
        sys.exit(f"chart_accuracy: no run's name contains '{options.only}'; --list prints them all")
    program = (options.program or root / "build" / "raycell").resolve()
    if not os.access(program, os.X_OK):
        sys.exit(f"chart_accuracy: {program} is not a program; expected raycell")
    folder = options.folder or root.parent / "shared" / "scenes" / "spd"
    scenes = scene_files(root, folder, dict.fromkeys(c.scene for c in every))
    runner = Sweep(program, scenes, places.cache)
    if options.list:
        print_list(blocks, runs, runner.finished(runs))
        return 0
    records, failures = runner.make_all(runs, options.jobs)
    for configuration, reason in failures.items():
        print(f"chart_accuracy: {configuration.label()} failed: {reason}", file=sys.stderr)
    stuck = {c: r["report"]["verdict"] for c, r in records.items() if r["report"]["verdict"] != "completed"}
    for configuration, verdict in stuck.items():
        print(f"chart_accuracy: {configuration.label()} ended with verdict {verdict}", file=sys.stderr)
    if failures:
        print(f"chart_accuracy: {len(failures)} of {len(runs)} runs failed, no tables", file=sys.stderr)
        return 1
    if options.only and not options.out:
        print(f"{len(runs)} runs are finished and kept for the whole sweep; tables are made of that", file=sys.stderr)
    else:
        rows.write(places.csv, every, {**runner.finished(every), **records})
        write_results(places, command, sum(r["seconds"] for r in records.values()))
    return 1 if stuck else 0


def main():
    root, options = pathlib.Path(sys.argv[1]), arguments(sys.argv[2:])
    out = options.out or (root / "out" / "accuracy-quick" if options.quick else None)
    places = Places(root, out)
    command = "scripts/chart_accuracy" + (" --quick" if options.quick else "")
    if options.from_csv:
        if not places.csv.is_file():
            sys.exit(f"chart_accuracy: {places.csv} is missing; a sweep writes it")
        write_results(places, command)
        return 0
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return sweep(options, root, places, command)
    except (KeyboardInterrupt, Stopped):
        print("\nchart_accuracy: stopped; what was finished is kept, the same command goes on", file=sys.stderr)
        return 130


sys.exit(main())
