"""The sweep behind scripts/chart_time_outs: which runs, making them, and what is written from them."""
import pathlib
import sys

import chart_time_outs_design as design
import chart_time_outs_rows as rows
from chart_time_outs_runs import Sweep
from chart_time_outs_tables import document
from sweep_command import Command, positive


def command_of(words):
    command = Command("chart_time_outs", "time_outs", "Measures what a time-out in each cell would tell of deadlocks, "
                      "against the proof; writes tables and a chart of false alarms, misses and delay over the "
                      "time-out.", "a dozen tiny runs")
    add = command.parser.add_argument
    add("--seeds", metavar="N", type=positive, default=design.SEEDS, help="traffics for each load and machine; "
        "default: %(default)s")
    add("--program", type=pathlib.Path, help="the deadlock_tb to run; default: build/deadlock_tb, built first")
    command.read(words)
    return command


def write_results(command, seconds=None):
    places = command.places
    results = rows.Results(places.csv)
    from chart_time_outs_pictures import draw  # matplotlib: only where it is needed
    places.document.write_text(document(results, command.words, seconds))
    chart = places.charts / "time_outs.png"
    draw(results, chart)
    print(f"{places.document}, {places.csv}, {chart}", file=sys.stderr)


def sweep(command):
    options, places = command.options, command.places
    every = design.quick_runs() if options.quick else design.runs(options.seeds)
    runs = command.chosen(every)
    program = (options.program or command.root / "build" / "deadlock_tb").resolve()
    command.check_program(program, "deadlock_tb")
    runner = Sweep(program, places.cache)
    if options.list:
        done = runner.finished(runs)
        for run in runs:
            print(f"{'done ' if run in done else '     '}{run.label()}")
        print(f"# {len(runs)} distinct runs, {len(done)} finished")
        return 0
    records = command.make(runner, runs)
    if records is None:
        return 1
    if not command.keeps_only(runs):
        rows.write(places.csv, every, {**runner.finished(every), **records})
        write_results(command, sum(record["seconds"] for record in records.values()))
    return 0


the_command = command_of(sys.argv[1:])
sys.exit(the_command.main(lambda: sweep(the_command), lambda: write_results(the_command)))
