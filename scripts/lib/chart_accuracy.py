"""The sweep behind scripts/chart_accuracy: which runs, making them, and what is written from them."""
import pathlib
import sys

import chart_accuracy_design as design
import chart_accuracy_rows as rows
from chart_accuracy_runs import Sweep
from chart_accuracy_tables import document
from sweep_command import Command


def command_of(words):
    command = Command("chart_accuracy", "accuracy", "Sweeps the machine's factors and writes tables and charts of "
                      "accuracy against bits and cycles.", "a dozen small runs of the project's own scenes")
    add = command.parser.add_argument
    add("folder", nargs="?", metavar="SCENE_FOLDER", type=pathlib.Path, help="of the SPD scenes; default: "
        "../shared/scenes/spd beside the project")
    add("--program", type=pathlib.Path, help="the raycell to run; default: build/raycell, built first")
    command.read(words)
    return command


def scene_files(command, names):
    folder = command.options.folder or command.root.parent / "shared" / "scenes" / "spd"
    files = {name: (command.root / "scenes" if name in design.OWN_SCENES else folder) / f"{name}.nff"
             for name in names}
    missing = [str(path) for path in files.values() if not path.is_file()]
    if missing:
        command.fail(f"{', '.join(missing)} missing; expected the folder of the SPD scenes as argument")
    return files


def write_results(command, seconds=None):
    places = command.places
    results = rows.Results(places.csv)
    if not results.scenes:
        print(f"{places.csv}; no timed run in it, so no tables and charts", file=sys.stderr)
        return
    from chart_accuracy_pictures import draw_bits, draw_front, draw_split  # matplotlib: only where it is needed
    places.document.write_text(document(results, command.words, seconds))
    draw_front(results, places.charts / "accuracy")
    draw_bits(results, places.charts / "accuracy_bits.png")
    draw_split(results, places.charts / "accuracy_split.png")
    print(f"{places.document}, {places.csv}, {places.charts / 'accuracy'}*.png", file=sys.stderr)


def print_list(blocks, runs, done):
    for title, (timed, configurations) in blocks.items():
        print(f"# {title}: {len(set(configurations))} runs, {'timed' if timed else 'untimed'} at least")
    for configuration, timed in runs.items():
        mark = "done " if configuration in done else "     "
        print(f"{mark}{'timed   ' if timed else 'untimed '}{configuration.label()}")
    print(f"# {len(runs)} distinct runs, {sum(runs.values())} timed, {len(done)} finished")


def sweep(command):
    options, places = command.options, command.places
    blocks = design.quick_blocks() if options.quick else design.blocks()
    every = design.runs_of(blocks)
    runs = {c: every[c] for c in command.chosen(every)}
    program = (options.program or command.root / "build" / "raycell").resolve()
    command.check_program(program, "raycell")
    runner = Sweep(program, scene_files(command, dict.fromkeys(c.scene for c in every)), places.cache)
    if options.list:
        print_list(blocks, runs, runner.finished(runs))
        return 0
    records = command.make(runner, runs)
    stuck = {c: r["report"]["verdict"] for c, r in (records or {}).items() if r["report"]["verdict"] != "completed"}
    for configuration, verdict in stuck.items():
        command.say(f"{configuration.label()} ended with verdict {verdict}")
    if records is None:
        return 1
    if not command.keeps_only(runs):
        rows.write(places.csv, every, {**runner.finished(every), **records})
        write_results(command, sum(r["seconds"] for r in records.values()))
    return 1 if stuck else 0


the_command = command_of(sys.argv[1:])
sys.exit(the_command.main(lambda: sweep(the_command), lambda: write_results(the_command)))
