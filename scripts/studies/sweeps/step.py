"""One step of a sweep, called by a rule of the Snakefile: PLAN run|shared|rows|tables|charts
[NAME]. PLAN is the file that scripts/study sweep writes; NAME is its name for the run, or for what runs share.

If a run fails, the step still ends well and leaves a record of the failure, which no reader takes for a result. To
Snakemake a failed step would mean the failure of all runs in the same cluster job."""
import json
import os
import pathlib
import sys
import tempfile

from studies.sweeps.kinds import SWEEPS
from studies.sweeps.runs import Failure


def named(runs, name, name_of):
    """The run of this name."""
    for run in runs:
        if name_of(run) == name:
            return run
    raise Failure("the sweep has no such run")


def reason_of(error):
    return str(error) if isinstance(error, (Failure, OSError)) else f"{type(error).__name__}: {error}"


class Step:
    def __init__(self, plan):
        os.chdir(plan["folder"])  # the user's words may name files from there
        self.command = SWEEPS[plan["sweep"]](plan["words"], plan["called"])
        self.every = self.command.every()
        self.runner = self.command.runner()
        self.cache = self.runner.cache
        if self.cache.folder.resolve() != pathlib.Path(plan["cache"]):
            sys.exit("the program is another one than when the sweep began; start the sweep again")
        self.products = pathlib.Path(plan["products"])

    def run(self, name):
        run = named(self.every, name, self.runner.name_of)
        shared = self.runner.shared(run)
        try:
            if shared and self.failure_of(shared).exists():
                raise Failure(f"{shared.prefix} failed: {self.failure_of(shared).read_text()}")
            self.runner.make_apart(run)
        except Exception as error:
            print(f"{name} failed: {reason_of(error)}", file=sys.stderr)
            self.cache.write(name, {"failure": reason_of(error)})

    def failure_of(self, shared):
        return self.cache.work / f"{shared.prefix}.failure"

    def shared(self, name):
        run = named(self.every, name, lambda run: self.runner.shared(run).prefix)
        shared = self.runner.shared(run)
        try:
            self.runner.make_shared(run)
        except Exception as error:
            self.failure_of(shared).write_text(reason_of(error))
            for suffix in shared.suffixes:
                (self.cache.work / f"{name}{suffix}").touch()

    def records(self):
        """The records of the whole design. Ends the step if some are missing."""
        records = self.runner.finished(self.every)
        if len(records) < len(self.every):
            sys.exit(f"no tables: {len(self.every) - len(records)} of {len(self.every)} runs are missing")
        return records

    def produce(self, write):
        """Calls `write` so that the files that it makes appear whole or not at all."""
        places = self.command.places
        with tempfile.TemporaryDirectory(dir=self.products.parent) as folder:
            places.write_to(pathlib.Path(folder), pathlib.Path(folder))
            write(places)
            for path in pathlib.Path(folder).iterdir():
                os.replace(path, self.products / path.name)

    def rows(self):
        records = self.records()
        self.produce(lambda _places: self.command.write_rows(records))

    def tables(self):
        def write(places):
            places.csv = self.products / places.csv.name
            self.command.write_tables(sum(record["seconds"] for record in self.records().values()))
        self.produce(write)

    def charts(self):
        def write(places):
            places.csv = self.products / places.csv.name
            self.command.draw_charts()
        self.produce(write)


def main(plan_file, what, *name):
    try:
        getattr(Step(json.loads(pathlib.Path(plan_file).read_text())), what)(*name)
    except KeyboardInterrupt:
        sys.exit(130)


main(*sys.argv[1:])
