"""The sweep behind scripts/sweep_deadlock: which runs, making them, and what is written from them."""
import pathlib
import sys

import sweep_deadlock_design as design
import sweep_deadlock_rows as rows
from sweep_command import Command, positive
from sweep_deadlock_runs import Sweep
from sweep_deadlock_tables import document


def command_of(words):
    command = Command("sweep_deadlock", "deadlock", "Sweeps networks, buffer depth, M, recovery, array size and seeds, "
                      "for synthetic traffic and a scene; writes tables and charts of what locks, what ends, and what "
                      "it costs.", "a dozen tiny runs")
    add = command.parser.add_argument
    add("--scene", metavar="FILE", type=pathlib.Path, help="the scene beside the synthetic traffic; default: "
        "scenes/cornell.nff")
    add("--limit", metavar="CYCLES", type=positive, default=design.SCENE_LIMIT, help="a scene's run is cut off after "
        "so many, loading included; default: %(default)s")
    add("--program-folder", metavar="FOLDER", type=pathlib.Path, help="the folder of raycell and deadlock_tb; default: "
        "build, where they are built first")
    command.read(words)
    return command


def write_results(command, seconds=None):
    places = command.places
    results = rows.Results(places.csv)
    from sweep_deadlock_pictures import draw_bits, draw_locks, draw_occupancy  # matplotlib: only where it is needed
    places.document.write_text(document(results, command.words, seconds))
    draw_locks(results, places.charts / "deadlock")
    draw_occupancy(results, places.charts / "deadlock_occupancy.png")
    draw_bits(results, places.charts / "deadlock_bits.png")
    print(f"{places.document}, {places.csv}, {places.charts / 'deadlock'}*.png", file=sys.stderr)


def print_list(blocks, runs, done):
    for title, configurations in blocks.items():
        seconds = sum(design.cost(c) for c in configurations)
        print(f"# {title}: {len(configurations)} runs, about {seconds / 60:.1f} minutes on one core")
    for configuration in runs:
        print(f"{'done ' if configuration in done else '     '}{configuration.label()}")
    seconds = sum(design.cost(c) for c in runs if c not in done)
    print(f"# {len(runs)} distinct runs, {len(done)} finished; the rest: about {seconds / 60:.0f} minutes on one core")


def sweep(command):
    options, places = command.options, command.places
    scene = options.scene or command.root / "scenes" / "cornell.nff"
    if not scene.is_file():
        command.fail(f"{scene} is missing; expected a scene's file")
    if scene.stem == design.SYNTHETIC:
        command.fail(f"a scene can't be named '{design.SYNTHETIC}'; that is the other load")
    blocks = design.quick_blocks(scene.stem) if options.quick else design.blocks(scene.stem, options.limit)
    every = design.runs_of(blocks)
    runs = command.chosen(every)
    programs = (options.program_folder or command.root / "build").resolve()
    for name in ("raycell", "deadlock_tb"):
        command.check_program(programs / name, "the folder of raycell and deadlock_tb")
    runner = Sweep(programs, {scene.stem: scene.resolve()}, places.cache)
    if options.list:
        print_list(blocks, runs, runner.finished(runs))
        return 0
    records = command.make(runner, runs)
    if records is None:
        return 1
    if command.keeps_only(runs):
        return 0
    rows.write(places.csv, every, {**runner.finished(every), **records})
    write_results(command, sum(record["seconds"] for record in records.values()))
    wrong = [c for c, record in records.items() if record["report"].get("equals_untimed") is False]
    return 1 if wrong else 0


the_command = command_of(sys.argv[1:])
sys.exit(the_command.main(lambda: sweep(the_command), lambda: write_results(the_command)))
