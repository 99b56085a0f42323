"""Plans a sweep, runs it with Snakemake, and reports the outcome."""
import hashlib
import json
import math
import os
import shutil
import signal
import subprocess
import sys

from studies.sweeps.kinds import SWEEPS

GROUP_SECONDS = 300  # processor time of one cluster job
PROGRESS_SECONDS = 10
NAMED = 20  # missing runs that are named at most
SHARED_CODE = ["charts.py", "sweeps/rows.py", "tables.py"]  # code of all sweeps' tables and charts
SNAKEMAKE = "/usr/bin/snakemake"


def with_whole_profile(options):
    """Makes the path of a profile absolute, since Snakemake works in another folder."""
    whole = []
    for before, word in zip(["", *options], options):
        mark, path = "--profile=", word.removeprefix("--profile=")
        if before == "--profile" or word.startswith(mark):
            word = word[:len(word) - len(path)] + (os.path.abspath(path) if os.path.isdir(path) else path)
        whole.append(word)
    return whole


class SnakemakeSweep:
    def __init__(self, command, words, options):
        """`words`: the project's folder, then the user's words for the sweep. `options`: those for Snakemake."""
        self.command, self.options = command, with_whole_profile(options)
        self.every = command.every()
        self.runner = command.runner()
        self.chosen = command.chosen(self.every)
        self.cache = self.runner.cache.folder.resolve()
        self.names = {run: self.runner.name_of(run) for run in self.every}
        # Another design of the same programs needs tables of its own.
        design = hashlib.sha256("\n".join([command.words, *self.names.values()]).encode()).hexdigest()[:12]
        self.state = self.cache / f"sweep-{design}"
        self.products = self.state / "products"
        self.plan_file = self.state / "plan.json"
        self.words = words
        self.stopped = False

    def plan(self):
        """What the Snakefile and the steps must know."""
        shared = {run: self.runner.shared(run) for run in self.every}
        suffixes = {each.suffixes for each in shared.values() if each}
        runs = {self.names[run]: {"seconds": self.runner.cost(run), "shared": shared[run] and shared[run].prefix}
                for run in self.every}
        library = (self.command.root / "scripts" / "studies").resolve()
        code = sorted([*(library / self.command.name).glob("*.py"), *(library / name for name in SHARED_CODE)])
        return {"sweep": self.command.name, "words": self.words, "called": self.command.called,
                "folder": os.getcwd(), "root": str(self.command.root.resolve()), "plan": str(self.plan_file),
                "cache": str(self.cache), "products": str(self.products), "runs": runs,
                "chosen": [self.names[run] for run in self.chosen],
                "suffixes": list(suffixes.pop()) if suffixes else [], "csv": self.command.places.csv.name,
                "document": self.command.places.document.name, "charts": self.command.charts,
                "code": [str(path) for path in code]}

    def prepare(self):
        """Writes the plan. Deletes files that are not the whole result of their run: Snakemake goes by their names."""
        self.products.mkdir(parents=True, exist_ok=True)
        for run in self.every:
            if self.runner.load(run) is None:
                (self.cache / f"{self.names[run]}.json").unlink(missing_ok=True)
        self.plan_file.write_text(json.dumps(self.plan(), indent=1))

    def group_components(self):
        """Number of runs, or of groups of runs that share something, in one cluster job."""
        apart = {self.runner.shared(run) or run for run in self.chosen}
        seconds = sum(self.runner.cost(run) for run in self.chosen) / len(apart)
        return max(1, math.floor(GROUP_SECONDS / seconds))

    def words_for_snakemake(self, target):
        """Snakemake's command. It needs no lock, since we hold our own. Files are renamed into place when they are
        whole, so every file that exists is finished, even if the job that made it failed."""
        words = [SNAKEMAKE, target, "--snakefile", str(self.command.root / "scripts" / "studies" / "sweeps" / "Snakefile"),
                 "--configfile", str(self.plan_file), "--directory", str(self.state), "--nolock", "--keep-going",
                 "--keep-incomplete", "--ignore-incomplete", "--rerun-triggers", "mtime", "--scheduler", "greedy",
                 "--quiet", "rules", "--group-components", f"runs={self.group_components()}"]
        if not any(word.startswith("--profile") for word in self.options):  # a profile has its own number
            words += ["--cores", str(self.command.options.jobs)]
        return words + self.options

    def run_snakemake(self, target):
        """Runs Snakemake; returns its exit code. A signal to stop is passed on as the one that ends all at once."""
        words = self.words_for_snakemake(target)
        if shutil.which("setpriv"):  # ends Snakemake if we are killed
            words = ["setpriv", "--pdeathsig", "INT", *words]
        # Background jobs of a shell ignore this signal, and their children would, too.
        child = subprocess.Popen(words, start_new_session=True,
                                 preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

        def stop(*_):
            self.stopped = True
            os.killpg(child.pid, signal.SIGINT)

        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, stop)
        return self.wait(child)

    def wait(self, child):
        """Waits for Snakemake and prints the progress, which Snakemake prints only with a dozen lines for each run."""
        shown = 0
        while True:
            try:
                return child.wait(timeout=PROGRESS_SECONDS)
            except subprocess.TimeoutExpired:
                done = sum((self.cache / f"{self.names[run]}.json").exists() for run in self.chosen)
                if done != shown:
                    print(f"{done} of {len(self.chosen)} runs", file=sys.stderr, flush=True)
                    shown = done

    def publish(self):
        """Copies tables and charts to where the sweep's own script writes them."""
        places = self.command.places
        for path in self.products.iterdir():
            shutil.copy(path, (places.charts if path.name in self.command.charts else places.tables) / path.name)
        print(f"{places.document}, {places.csv}, {len(self.command.charts)} charts in {places.charts}", file=sys.stderr)

    def report_missing(self, missing):
        read = {self.names[run]: self.runner.cache.read(self.names[run]) for run in missing}
        silent = []
        for name, record in read.items():
            if record and "failure" in record:
                self.command.say(f"{name} failed: {record['failure']}")
            else:
                silent.append(name)
        if not self.stopped:
            for name in silent[:NAMED]:
                self.command.say(f"{name} was not made")
            if len(silent) > NAMED:
                self.command.say(f"{len(silent) - NAMED} more were not made; --list tells which")
        self.command.say(f"{'stopped; ' if self.stopped else ''}{len(missing)} of {len(self.chosen)} runs are missing, "
                         "no tables; the same command goes on")

    def sweep(self):
        """Makes the sweep; returns the exit code."""
        if self.command.options.list:
            return self.command.sweep()
        self.runner.cache.occupy()
        self.prepare()
        target = "records" if self.command.options.only else "results"
        if {"-n", "--dry-run", "--dryrun"} & set(self.options):
            return self.run_snakemake(target)
        # The runs come first: in one call with the tables, Snakemake would name every run where one is missing.
        code = self.run_snakemake("records")
        records = self.runner.finished(self.chosen)
        missing = [run for run in self.chosen if run not in records]
        if missing:
            self.report_missing(missing)
            return 130 if self.stopped else 1
        shutil.rmtree(self.runner.cache.work, ignore_errors=True)
        if target == "records":
            print(f"{len(records)} runs are finished and kept for the whole sweep", file=sys.stderr)
        else:
            code = self.run_snakemake(target)
            if code:
                return 130 if self.stopped else code
            self.publish()
        return self.command.say_wrong(records) or code


def main(root, words):
    sweep, words = (words[0], words[1:]) if words else ("", [])
    if sweep in ("-h", "--help"):
        print(f"usage: scripts/study sweep {'|'.join(SWEEPS)} [OPTION ...] [-- SNAKEMAKE_OPTION ...]\n"
              "scripts/study sweep SWEEP --help lists the options; docs/use/sweeps.md has examples")
        return 0
    if sweep not in SWEEPS:
        sys.exit(f"study sweep: expected one of {', '.join(SWEEPS)}, not '{sweep}'")
    own, options = words, []
    if "--" in words:
        own, options = words[:words.index("--")], words[words.index("--") + 1:]
    if not os.access(SNAKEMAKE, os.X_OK):
        sys.exit("study sweep: snakemake is missing; as root, run: apt-get install snakemake")
    own = [str(root), *own]
    command = SWEEPS[sweep](own, f"scripts/study sweep {sweep}")
    if command.options.from_csv:
        return command.main()
    return SnakemakeSweep(command, own, options).sweep()
