#!/usr/bin/python3
"""One step of a sweep, called by a rule of scripts/sweeps/Snakefile: sweep_step.py PLAN run|shared|rows|tables|charts
[NAME]. PLAN is the file that scripts/sweep writes; NAME is what it calls the run, or what runs share."""
import json
import os
import pathlib
import sys

from sweep_kinds import SWEEPS
from sweep_runs import Failure


def named(runs, name, name_of):
    """The run of this name."""
    for run in runs:
        if name_of(run) == name:
            return run
    raise Failure("the sweep has no such run")


class Step:
    def __init__(self, plan):
        self.plan = plan
        os.chdir(plan["folder"])  # the user's words may name files from there
        self.command = SWEEPS[plan["sweep"]](plan["words"], plan["called"])
        self.every = self.command.every()
        self.runner = self.command.runner()
        if self.runner.cache.folder.resolve() != pathlib.Path(plan["cache"]):
            raise Failure("the program is another one than when the sweep began; start the sweep again")
        self.command.places.write_to(pathlib.Path(plan["products"]), pathlib.Path(plan["products"]))

    def records(self):
        """Of the whole design."""
        records = self.runner.finished(self.every)
        if len(records) < len(self.every):
            raise Failure(f"{len(self.every) - len(records)} of {len(self.every)} runs are missing")
        return records

    def run(self, name):
        self.runner.make_apart(named(self.every, name, self.runner.name_of))

    def shared(self, name):
        self.runner.make_shared(named(self.every, name, lambda run: self.runner.shared(run).prefix))

    def rows(self):
        self.command.write_rows(self.records())

    def tables(self):
        self.command.write_tables(sum(record["seconds"] for record in self.records().values()))

    def charts(self):
        self.command.draw_charts()


def main(plan_file, what, *name):
    plan = json.loads(pathlib.Path(plan_file).read_text())
    try:
        getattr(Step(plan), what)(*name)
    except (Failure, OSError) as error:
        note = pathlib.Path(plan["failures"]) / f"{name[0] if name else what}.txt"
        note.parent.mkdir(exist_ok=True)
        note.write_text(f"{error}\n")
        sys.exit(f"{' '.join([what, *name])}: {error}")


main(*sys.argv[1:])
