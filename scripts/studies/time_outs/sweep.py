"""The sweep of scripts/study time_outs: its runs, how they are made, and what is written from them."""
import pathlib

from studies.time_outs import design
from studies.time_outs import rows
from studies.time_outs.runs import Sweep
from studies.time_outs.tables import document
from studies.sweeps.command import Command, positive


class TimeOutsSweep(Command):
    name = "time_outs"
    description = ("Measures what a time-out in each cell would tell of deadlocks, against the proof; writes tables and "
                   "a chart of false alarms, misses and delay over the time-out.")
    quick = "a dozen tiny runs"
    charts = ["time_outs.png"]
    rows = rows
    document = document

    def add_options(self, add):
        add("--seeds", metavar="N", type=positive, default=design.SEEDS, help="traffics for each load and machine; "
            "default: %(default)s")
        add("--program", type=pathlib.Path, help="the deadlock_tb to run; default: build/deadlock_tb, built first")

    def every(self):
        return design.quick_runs() if self.options.quick else design.runs(self.options.seeds)

    def runner(self):
        program = (self.options.program or self.root / "build" / "deadlock_tb").resolve()
        self.check_program(program, "deadlock_tb")
        return Sweep(program, self.places.cache)

    def draw(self, results):
        from studies.time_outs.pictures import draw  # matplotlib is needed only here
        draw(results, self.places.charts / "time_outs.png")


def main(root, words):
    return TimeOutsSweep([root, *words]).main()
