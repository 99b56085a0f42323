"""The command behind scripts/sweep: plans a sweep, has Snakemake make it, and says what became of it."""
import hashlib
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys

from sweep_kinds import SWEEPS

GROUP_SECONDS = 300  # of processor time in a job of a cluster
SNAKEMAKE = "/usr/bin/snakemake"


class SnakemakeSweep:
    def __init__(self, command, words, options):
        """`words`: the user's words for the sweep, after the project's folder; `options`: those for Snakemake."""
        self.command, self.options = command, options
        self.every = command.every()
        self.runner = command.runner()
        self.chosen = command.chosen(self.every)
        self.cache = self.runner.cache.folder.resolve()
        self.names = {run: self.runner.name_of(run) for run in self.every}
        # Another design of the same programs has tables of its own.
        design = hashlib.sha256("\n".join([command.words, *self.names.values()]).encode()).hexdigest()[:12]
        self.state = self.cache / f"sweep-{design}"
        self.products, self.failures = self.state / "products", self.state / "failures"
        self.plan_file = self.state / "plan.json"
        self.words = words

    def plan(self):
        """What the Snakefile and the steps must know."""
        shared = {run: self.runner.shared(run) for run in self.every}
        suffixes = {each.suffixes for each in shared.values() if each}
        runs = {self.names[run]: {"seconds": self.runner.cost(run), "shared": shared[run] and shared[run].prefix}
                for run in self.every}
        code = sorted((self.command.root / "scripts" / "lib").resolve().glob(f"*{self.command.name}*.py"))
        return {"sweep": self.command.name, "words": self.words, "called": self.command.called,
                "folder": os.getcwd(), "root": str(self.command.root.resolve()), "plan": str(self.plan_file),
                "cache": str(self.cache), "products": str(self.products), "failures": str(self.failures),
                "runs": runs, "chosen": [self.names[run] for run in self.chosen],
                "suffixes": list(suffixes.pop()) if suffixes else [], "csv": self.command.places.csv.name,
                "document": self.command.places.document.name, "charts": self.command.charts,
                "code": [str(path) for path in code]}

    def prepare(self):
        """Writes the plan. A file that is not the whole result of its run would pass for one by its name, so it goes."""
        for folder in (self.failures, self.products):
            folder.mkdir(parents=True, exist_ok=True)
        for note in self.failures.iterdir():
            note.unlink()
        for run in self.every:
            if self.runner.load(run) is None:
                (self.cache / f"{self.names[run]}.json").unlink(missing_ok=True)
        self.plan_file.write_text(json.dumps(self.plan(), indent=1))

    def group_components(self):
        """So many runs, or groups of runs that share something, are a job of a cluster."""
        apart = {self.runner.shared(run) or run for run in self.chosen}
        seconds = sum(self.runner.cost(run) for run in self.chosen) / len(apart)
        return max(1, math.floor(GROUP_SECONDS / seconds))

    def words_for_snakemake(self):
        """Our own lock is held, so Snakemake needs none. Finished runs may come from the other script, which leaves no
        notes for Snakemake, so only the age of files says what is to be made."""
        target = "records" if self.command.options.only else "results"
        words = [SNAKEMAKE, target, "--snakefile", str(self.command.root / "scripts" / "sweeps" / "Snakefile"),
                 "--configfile", str(self.plan_file), "--directory", str(self.state), "--nolock", "--keep-going",
                 "--rerun-incomplete", "--rerun-triggers", "mtime", "--scheduler", "greedy", "--quiet", "rules",
                 "--group-components", f"runs={self.group_components()}"]
        if not any(word.startswith("--profile") for word in self.options):  # it says how many
            words += ["--cores", str(self.command.options.jobs)]
        return words + self.options

    def run_snakemake(self):
        """Its exit code. A signal to stop reaches Snakemake as the one that ends its runs at once, and so does our own
        end, whatever the reason."""
        words = self.words_for_snakemake()
        if shutil.which("setpriv"):
            words = ["setpriv", "--pdeathsig", "INT", *words]
        child = subprocess.Popen(words, start_new_session=True)

        def stop(*_):
            child.send_signal(signal.SIGINT)
            self.stopped = True

        self.stopped = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, stop)
        return child.wait()

    def publish(self):
        """Tables and charts go where the sweep's own script writes them."""
        places = self.command.places
        for path in self.products.iterdir():
            shutil.copy(path, (places.charts if path.name in self.command.charts else places.tables) / path.name)
        print(f"{places.document}, {places.csv}, {len(self.command.charts)} charts in {places.charts}", file=sys.stderr)

    def report_missing(self, missing):
        for run in missing:
            note = self.failures / f"{self.names[run]}.txt"
            if note.is_file():
                self.command.say(f"{self.names[run]} failed: {note.read_text().strip()}")
        noted = {self.names[run] for run in missing}
        for note in sorted(self.failures.iterdir()):
            if note.stem not in noted:
                self.command.say(f"{note.stem} failed: {note.read_text().strip()}")
        self.command.say(f"{len(missing)} of {len(self.chosen)} runs are missing, no tables; the same command makes them")

    def sweep(self):
        """The exit code."""
        if self.command.options.list:
            return self.command.sweep()
        self.runner.cache.occupy()
        self.prepare()
        code = self.run_snakemake()
        if "-n" in self.options or "--dry-run" in self.options:
            return code
        records = self.runner.finished(self.chosen)
        missing = [run for run in self.chosen if run not in records]
        if missing:
            self.report_missing(missing)
            return 130 if self.stopped else 1
        if code:
            return code
        shutil.rmtree(self.runner.cache.work, ignore_errors=True)
        if self.command.options.only:
            print(f"{len(records)} runs are finished and kept for the whole sweep", file=sys.stderr)
        else:
            self.publish()
        return self.command.say_wrong(records)


def main(root, sweep="", *words):
    if sweep not in SWEEPS:
        sys.exit(f"sweep: expected one of {', '.join(SWEEPS)}, not '{sweep}'")
    words = list(words)
    own, options = words, []
    if "--" in words:
        own, options = words[:words.index("--")], words[words.index("--") + 1:]
    own = [root, *own]
    command = SWEEPS[sweep](own, f"scripts/sweep {sweep}")
    if command.options.from_csv:
        return command.main()
    return SnakemakeSweep(command, own, options).sweep()


sys.exit(main(*sys.argv[1:]))
