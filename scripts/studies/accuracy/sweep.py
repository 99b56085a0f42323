"""The sweep of scripts/study accuracy: its runs, how they are made, and what is written from them."""
import pathlib
import sys

from studies.accuracy import design
from studies.accuracy import rows
from studies.accuracy.runs import Sweep
from studies.accuracy.tables import document
from studies.sweeps.command import Command


class AccuracySweep(Command):
    name = "accuracy"
    description = "Sweeps the machine's factors and writes tables and charts of accuracy against bits and cycles."
    quick = "a dozen small runs of the project's own scenes"
    charts = ["accuracy.png", "accuracy.svg", "accuracy_bits.png", "accuracy_split.png"]
    rows = rows
    document = document

    def add_options(self, add):
        add("folder", nargs="?", metavar="SCENE_FOLDER", type=pathlib.Path, help="of the SPD scenes; default: "
            "../shared/scenes/spd beside the project")
        add("--program", type=pathlib.Path, help="the raycell to run; default: build/raycell, built first")

    def blocks(self):
        return design.quick_blocks() if self.options.quick else design.blocks()

    def every(self):
        """{configuration: timed}"""
        return design.runs_of(self.blocks())

    def scene_files(self, names):
        folder = self.options.folder or self.root.parent / "shared" / "scenes" / "spd"
        files = {name: (self.root / "scenes" if name in design.OWN_SCENES else folder) / f"{name}.nff"
                 for name in names}
        missing = [str(path) for path in files.values() if not path.is_file()]
        if missing:
            self.fail(f"{', '.join(missing)} missing; expected the folder of the SPD scenes as argument")
        return files

    def runner(self):
        program = (self.options.program or self.root / "build" / "raycell").resolve()
        self.check_program(program, "raycell")
        every = self.every()
        return Sweep(program, self.scene_files(dict.fromkeys(c.scene for c in every)), every, self.places.cache)

    def print_list(self, runs, done):
        for title, (timed, configurations) in self.blocks().items():
            print(f"# {title}: {len(set(configurations))} runs, {'timed' if timed else 'untimed'} at least")
        every = self.every()
        for configuration in runs:
            mark = "done " if configuration in done else "     "
            print(f"{mark}{'timed   ' if every[configuration] else 'untimed '}{configuration.label()}")
        print(f"# {len(runs)} distinct runs, {sum(every[c] for c in runs)} timed, {len(done)} finished")

    def wrong(self, records):
        return [f"{c.label()} ended with verdict {record['report']['verdict']}" for c, record in records.items()
                if record["report"]["verdict"] != "completed"]

    def write_results(self, seconds=None):
        if rows.Results(self.places.csv).scenes:
            super().write_results(seconds)
        else:
            print(f"{self.places.csv}; no timed run in it, so no tables and charts", file=sys.stderr)

    def draw(self, results):
        from studies.accuracy.pictures import draw_bits, draw_front, draw_split  # matplotlib is needed only here
        charts = self.places.charts
        draw_front(results, charts / "accuracy")
        draw_bits(results, charts / "accuracy_bits.png")
        draw_split(results, charts / "accuracy_split.png")


def main(root, words):
    return AccuracySweep([root, *words]).main()
