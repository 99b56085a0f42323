"""The sweep behind scripts/sweep_deadlock: which runs, making them, and what is written from them."""
import argparse
import os
import pathlib
import signal
import sys

import sweep_deadlock_design as design
import sweep_deadlock_rows as rows
from sweep_deadlock_runs import Sweep
from sweep_deadlock_tables import document
from sweep_runs import Stopped


def positive(word):
    if not word.isdigit() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1, not '{word}'")
    return int(word)


def arguments(words):
    parser = argparse.ArgumentParser(prog="scripts/sweep_deadlock", description="Sweeps networks, buffer depth, M, "
                                     "recovery, array size and seeds, for synthetic traffic and a scene; writes tables "
                                     "and charts of what locks, what ends, and what it costs.")
    parser.add_argument("--scene", metavar="FILE", type=pathlib.Path, help="the scene beside the synthetic traffic; "
                        "default: scenes/cornell.nff")
    parser.add_argument("--limit", metavar="CYCLES", type=positive, default=design.SCENE_LIMIT, help="a scene's run is "
                        "cut off after so many, loading included; default: %(default)s")
    parser.add_argument("--list", action="store_true", help="print the runs and whether they are finished")
    parser.add_argument("--only", metavar="TEXT", help="only the runs whose name contains it; without --out they are "
                        "only kept for the whole sweep")
    parser.add_argument("--jobs", type=positive, default=os.cpu_count(), help="runs at a time; default: one a core")
    parser.add_argument("--quick", action="store_true", help="a dozen tiny runs; without --out they go to "
                        "out/deadlock-quick")
    parser.add_argument("--out", metavar="FOLDER", type=pathlib.Path, help="all results there, the cache too")
    parser.add_argument("--program-folder", metavar="FOLDER", type=pathlib.Path, help="the folder of raycell and "
                        "deadlock_tb; default: build, where they are built first")
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
        self.csv = self.tables / "deadlock.csv"


def write_results(places, command, seconds=None):
    results = rows.Results(places.csv)
    from sweep_deadlock_pictures import draw_bits, draw_locks, draw_occupancy  # matplotlib: only where it is needed
    (places.tables / "deadlock.md").write_text(document(results, command, seconds))
    draw_locks(results, places.charts / "deadlock")
    draw_occupancy(results, places.charts / "deadlock_occupancy.png")
    draw_bits(results, places.charts / "deadlock_bits.png")
    print(f"{places.tables / 'deadlock.md'}, {places.csv}, {places.charts / 'deadlock'}*.png", file=sys.stderr)


def print_list(blocks, runs, done):
    for title, configurations in blocks.items():
        seconds = sum(design.cost(c) for c in configurations)
        print(f"# {title}: {len(configurations)} runs, about {seconds / 60:.1f} minutes on one core")
    for configuration in runs:
        print(f"{'done ' if configuration in done else '     '}{configuration.label()}")
    seconds = sum(design.cost(c) for c in runs if c not in done)
    print(f"# {len(runs)} distinct runs, {len(done)} finished; the rest: about {seconds / 60:.0f} minutes on one core")


def check_programs(folder):
    for name in ("raycell", "deadlock_tb"):
        if not os.access(folder / name, os.X_OK):
            sys.exit(f"sweep_deadlock: {folder / name} is not a program; expected the folder of raycell and "
                     "deadlock_tb")


def sweep(options, root, places, command):
    scene = options.scene or root / "scenes" / "cornell.nff"
    if not scene.is_file():
        sys.exit(f"sweep_deadlock: {scene} is missing; expected a scene's file")
    if scene.stem == design.SYNTHETIC:
        sys.exit(f"sweep_deadlock: a scene can't be named '{design.SYNTHETIC}'; that is the other load")
    blocks = design.quick_blocks(scene.stem) if options.quick else design.blocks(scene.stem, options.limit)
    every = design.runs_of(blocks)
    runs = [c for c in every if not options.only or options.only in c.label()]
    if not runs:
        sys.exit(f"sweep_deadlock: no run's name contains '{options.only}'; --list prints them all")
    programs = (options.program_folder or root / "build").resolve()
    check_programs(programs)
    runner = Sweep(programs, {scene.stem: scene.resolve()}, places.cache)
    if options.list:
        print_list(blocks, runs, runner.finished(runs))
        return 0
    records, failures = runner.make_all(runs, options.jobs)
    for configuration, reason in failures.items():
        print(f"sweep_deadlock: {configuration.label()} failed: {reason}", file=sys.stderr)
    if failures:
        print(f"sweep_deadlock: {len(failures)} of {len(runs)} runs failed, no tables", file=sys.stderr)
        return 1
    if options.only and not options.out:
        print(f"{len(runs)} runs are finished and kept for the whole sweep; tables are made of that", file=sys.stderr)
        return 0
    rows.write(places.csv, every, {**runner.finished(every), **records})
    write_results(places, command, sum(record["seconds"] for record in records.values()))
    wrong = [c for c, record in records.items() if record["report"].get("equals_untimed") is False]
    return 1 if wrong else 0


def main():
    root, options = pathlib.Path(sys.argv[1]), arguments(sys.argv[2:])
    out = options.out or (root / "out" / "deadlock-quick" if options.quick else None)
    places = Places(root, out)
    command = "scripts/sweep_deadlock" + (" --quick" if options.quick else "")
    if options.from_csv:
        if not places.csv.is_file():
            sys.exit(f"sweep_deadlock: {places.csv} is missing; a sweep writes it")
        write_results(places, command)
        return 0
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return sweep(options, root, places, command)
    except (KeyboardInterrupt, Stopped):
        print("\nsweep_deadlock: stopped; what was finished is kept, the same command goes on", file=sys.stderr)
        return 130


sys.exit(main())
