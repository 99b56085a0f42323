"""What the sweeps' scripts share: their options, where results lie, and how one is run, fails and is stopped."""
import argparse
import os
import pathlib
import signal
import sys

from sweep_runs import Stopped


def positive(word):
    if not word.isdigit() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1, not '{word}'")
    return int(word)


class Places:
    """Where things lie: in the project, or all in one folder."""

    def __init__(self, root, out, name):
        self.tables = out or root / "results"
        self.charts = out or root / "docs"
        self.cache = (out or root / "results") / "cache"
        for folder in (self.tables, self.charts, self.cache):
            folder.mkdir(parents=True, exist_ok=True)
        self.csv = self.tables / f"{name}.csv"
        self.document = self.tables / f"{name}.md"


class Command:
    """A script of the name `script` whose results are called `name`; add options of its own to `parser`."""

    def __init__(self, script, name, description, quick):
        self.script = script
        self.name = name
        self.parser = argparse.ArgumentParser(prog=f"scripts/{script}", description=description)
        add = self.parser.add_argument
        add("--list", action="store_true", help="print the runs and whether they are finished")
        add("--only", metavar="TEXT", help="only the runs whose name contains it; without --out they are only kept "
            "for the whole sweep")
        add("--jobs", type=positive, default=os.cpu_count(), help="runs at a time; default: one a core")
        add("--quick", action="store_true", help=f"{quick}; without --out they go to out/{name}-quick")
        add("--out", metavar="FOLDER", type=pathlib.Path, help="all results there, the cache too")
        add("--from-csv", action="store_true", help="make tables and charts again, without any run")

    def read(self, words):
        """The first word is the project's folder, the others are the user's."""
        self.root, self.options = pathlib.Path(words[0]), self.parser.parse_args(words[1:])
        quick = self.options.quick
        self.places = Places(self.root, self.options.out or (self.root / "out" / f"{self.name}-quick" if quick else
                                                             None), self.name)
        self.words = f"scripts/{self.script}" + (" --quick" if quick else "")

    def say(self, text):
        print(f"{self.script}: {text}", file=sys.stderr)

    def fail(self, text):
        sys.exit(f"{self.script}: {text}")

    def chosen(self, runs):
        """Those that --only names."""
        only = self.options.only
        found = [run for run in runs if not only or only in run.label()]
        if not found:
            self.fail(f"no run's name contains '{only}'; --list prints them all")
        return found

    def check_program(self, path, expected):
        if not os.access(path, os.X_OK):
            self.fail(f"{path} is not a program; expected {expected}")

    def make(self, runner, runs):
        """The records of the runs, made where they are not in the cache; None where one failed."""
        records, failures = runner.make_all(runs, self.options.jobs)
        for run, reason in failures.items():
            self.say(f"{run.label()} failed: {reason}")
        if failures:
            self.say(f"{len(failures)} of {len(runs)} runs failed, no tables")
            return None
        return records

    def keeps_only(self, chosen):
        """Whether these are a part of the sweep, for its cache alone."""
        if not self.options.only or self.options.out:
            return False
        print(f"{len(chosen)} runs are finished and kept for the whole sweep; tables are made of that", file=sys.stderr)
        return True

    def main(self, sweep, write_results):
        """The exit code."""
        if self.options.from_csv:
            if not self.places.csv.is_file():
                self.fail(f"{self.places.csv} is missing; a sweep writes it")
            write_results()
            return 0
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            return sweep()
        except (KeyboardInterrupt, Stopped):
            print(f"\n{self.script}: stopped; what was finished is kept, the same command goes on", file=sys.stderr)
            return 130
