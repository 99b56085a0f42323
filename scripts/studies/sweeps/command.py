"""What the sweeps' scripts share: options, places of results, how a sweep is run, fails and is stopped."""
import argparse
import os
import pathlib
import signal
import sys

from studies import programs
from studies.sweeps.runs import Stopped


def positive(word):
    if not word.isdigit() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1, not '{word}'")
    return int(word)


class Places:
    """Where results lie: in the project, or all in one folder."""

    def __init__(self, root, out, name):
        self.cache = (out or programs.measured(root)) / "cache"
        self.cache.mkdir(parents=True, exist_ok=True)
        self.name = name
        self.write_to(out or programs.measured(root), out or programs.measured(root))

    def write_to(self, tables, charts):
        """Makes these the folders of tables and charts."""
        self.tables, self.charts = tables, charts
        for folder in (tables, charts):
            folder.mkdir(parents=True, exist_ok=True)
        self.csv = tables / f"{self.name}.csv"
        self.document = tables / f"{self.name}.md"


class Command:
    """A sweep as its users call it. A subclass for each sweep defines its runs and what is made of them."""

    name = ""  # what its results are called
    description = ""
    quick = ""  # what --quick makes
    charts = []  # their files
    rows = None  # the module that writes and reads the CSV
    document = None  # the function that makes the tables of (rows, the user's words, seconds or None)

    def __init__(self, words, called=None):
        """`words`: the project's folder, then the user's words. `called`: the command that they called, if it is not
        the sweep's own."""
        self.called = called or f"scripts/study {self.name}"
        self.short = self.called.removeprefix("scripts/")
        parser = self.parser()
        self.root, self.options = pathlib.Path(words[0]), parser.parse_args(words[1:])
        quick = self.options.quick
        self.places = Places(self.root, self.options.out or (self.root / "out" / f"{self.name}-quick" if quick else
                                                             None), self.name)
        self.words = self.called + (" --quick" if quick else "")

    def parser(self):
        parser = argparse.ArgumentParser(prog=self.called, description=self.description)
        add = parser.add_argument
        add("--list", action="store_true", help="print the runs and whether they are finished")
        add("--only", metavar="TEXT", help="only the runs whose name contains it; without --out they are only kept "
            "for the whole sweep")
        add("--jobs", type=positive, default=os.cpu_count(), help="runs at a time; default: one a core")
        add("--quick", action="store_true", help=f"{self.quick}; without --out they go to out/{self.name}-quick")
        add("--out", metavar="FOLDER", type=pathlib.Path, help="all results there, the cache too")
        add("--from-csv", action="store_true", help="make tables and charts again, without any run")
        self.add_options(add)
        return parser

    # Defined by each sweep.

    def add_options(self, add):
        """The sweep's own options."""

    def every(self):
        """All runs of the design, each once."""
        raise NotImplementedError

    def runner(self):
        """What makes these runs."""
        raise NotImplementedError

    def print_list(self, runs, done):
        for run in runs:
            print(f"{'done ' if run in done else '     '}{run.label()}")
        print(f"# {len(runs)} distinct runs, {len(done)} finished")

    def wrong(self, _records):
        """A text for each run that ended, but not as it should."""
        return []

    def draw(self, results):
        """Draws the charts."""
        raise NotImplementedError

    # Shared by all sweeps.

    def say(self, text):
        print(f"{self.short}: {text}", file=sys.stderr)

    def fail(self, text):
        sys.exit(f"{self.short}: {text}")

    def chosen(self, runs):
        """The runs that --only names."""
        only = self.options.only
        found = [run for run in runs if not only or only in run.label()]
        if not found:
            self.fail(f"no run's name contains '{only}'; --list prints them all")
        return found

    def check_program(self, path, expected):
        if not os.access(path, os.X_OK):
            self.fail(f"{path} is not a program; expected {expected}")

    def make(self, runner, runs):
        """Makes the runs that are not in the cache. Returns the records of all, or None if a run failed."""
        records, failures = runner.make_all(runs, self.options.jobs)
        for run, reason in failures.items():
            self.say(f"{run.label()} failed: {reason}")
        if failures:
            self.say(f"{len(failures)} of {len(runs)} runs failed, no tables")
            return None
        return records

    def keeps_only(self, chosen):
        """Whether the chosen runs are only a part of the sweep, kept in its cache without tables."""
        if not self.options.only or self.options.out:
            return False
        print(f"{len(chosen)} runs are finished and kept for the whole sweep; tables are made of that", file=sys.stderr)
        return True

    def say_wrong(self, records):
        """Reports the runs that did not end as they should; returns the exit code."""
        wrong = self.wrong(records)
        for text in wrong:
            self.say(text)
        return 1 if wrong else 0

    def write_rows(self, records):
        self.rows.write(self.places.csv, self.every(), records)

    def write_tables(self, seconds=None):
        """Writes the tables from the CSV. `seconds`: what its runs took, if known."""
        results = self.rows.Results(self.places.csv)
        self.places.document.write_text(type(self).document(results, self.words, seconds))

    def draw_charts(self):
        """Draws the charts from the CSV."""
        self.draw(self.rows.Results(self.places.csv))

    def write_results(self, seconds=None):
        self.write_tables(seconds)
        self.draw_charts()
        charts = ", ".join(str(self.places.charts / name) for name in self.charts)
        print(f"{self.places.document}, {self.places.csv}, {charts}", file=sys.stderr)

    def sweep(self):
        """Makes the runs and writes their results; returns the exit code."""
        every = self.every()
        runs, runner = self.chosen(every), self.runner()
        if self.options.list:
            self.print_list(runs, runner.finished(runs))
            return 0
        records = self.make(runner, runs)
        if records is None:
            return 1
        if not self.keeps_only(runs):
            self.write_rows({**runner.finished(every), **records})
            self.write_results(sum(record["seconds"] for record in records.values()))
        return self.say_wrong(records)

    def main(self):
        """Does what the options ask for; returns the exit code."""
        if self.options.from_csv:
            if not self.places.csv.is_file():
                self.fail(f"{self.places.csv} is missing; a sweep writes it")
            self.write_results()
            return 0
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            return self.sweep()
        except (KeyboardInterrupt, Stopped):
            print(f"\n{self.short}: stopped; what was finished is kept, the same command goes on", file=sys.stderr)
            return 130
