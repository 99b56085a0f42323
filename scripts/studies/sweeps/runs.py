"""What sweeps share: runs on all cores. Finished runs are kept, so that a stopped sweep can go on."""
import concurrent.futures
import dataclasses
import fcntl
import hashlib
import json
import os
import shutil
import subprocess
import sys
import threading
import time

RUN_SECONDS = 1800  # a run that takes longer is stuck


class Failure(Exception):
    """A run that gave no result."""


class Stopped(Exception):
    """The sweep was told to stop."""


@dataclasses.dataclass(frozen=True)
class Shared:
    """Files that several runs need, in the cache's work folder: a prefix and these suffixes."""

    prefix: str
    suffixes: tuple


def hash_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Cache:
    """Finished runs, a file each, written under another name and renamed. `owner`: the sweep's name, for messages."""

    def __init__(self, folder, owner):
        self.folder = folder
        self.owner = owner
        self.work = self.folder / "work"
        self.lock = None

    def occupy(self):
        """Locks the cache for one sweep and removes what killed runs left. Exits if another sweep holds it."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lock = open(self.folder / "lock", "w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            sys.exit(f"{self.owner}: another sweep is at work in {self.folder}; wait for it or stop it")
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()

    def read(self, name):
        """The record of this name, or None if it can't be read."""
        try:
            return json.loads((self.folder / f"{name}.json").read_text())
        except (OSError, ValueError):
            return None

    def write(self, name, record):
        partial = self.work / f"{name}.json"
        partial.write_text(json.dumps(record, indent=1))
        os.replace(partial, self.folder / f"{name}.json")


class Runner:
    """Makes runs in parallel. A sweep defines how one run is made (`make_one`) and whether it is finished (`load`)."""

    def __init__(self, cache):
        self.cache = cache
        self.stopping = threading.Event()
        self.guard = threading.Lock()
        self.children = set()

    def name_of(self, run):
        """The name of the run's record."""
        return run.label()

    def cost(self, run):
        """Rough processor seconds of a run."""
        raise NotImplementedError

    def load(self, run):
        """The finished run's record, or None."""
        raise NotImplementedError

    def finished(self, runs):
        """{run: record} of what is in the cache."""
        found = {run: self.load(run) for run in runs}
        return {run: record for run, record in found.items() if record}

    def make_one(self, run):
        """Makes a run; stores and returns its record."""
        raise NotImplementedError

    def make_apart(self, run):
        """The same in a process of its own. Files shared with other runs exist already and are kept."""
        return self.make_one(run)

    def shared(self, _run):
        """What must be made before `make_apart`, or None."""
        return None

    def make_shared(self, run):
        """Makes what this run shares."""
        raise NotImplementedError

    def prepare(self, pending):
        """Called with the runs to be made before the first of them."""

    def make_all(self, runs, jobs):
        """Makes the runs that are not in the cache, the most costly first. Returns all records and
        {run: what went wrong}."""
        self.cache.occupy()
        records, failures = self.finished(runs), {}
        pending = sorted((run for run in runs if run not in records), key=self.cost, reverse=True)
        self.prepare(pending)
        progress = Progress(len(runs), len(records), sum(self.cost(run) for run in pending))
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            futures = {pool.submit(self.make_one, run): run for run in pending}
            try:
                for future in concurrent.futures.as_completed(futures):
                    run = futures[future]
                    error = future.exception()
                    if error is None:
                        records[run] = future.result()
                    elif isinstance(error, (Failure, OSError)):
                        failures[run] = str(error)
                    else:
                        raise error
                    progress.step(self.cost(run), len(failures))
            except BaseException:
                self.stop(pool)
                raise
            finally:
                progress.end()
        shutil.rmtree(self.cache.work, ignore_errors=True)
        return records, failures

    def stop(self, pool):
        self.stopping.set()
        pool.shutdown(wait=False, cancel_futures=True)
        with self.guard:
            for child in self.children:
                child.kill()

    def execute(self, command, codes=(0,)):
        """Runs a program to its end and returns its output. Raises Failure for an exit code that is not in `codes`."""
        if shutil.which("setpriv"):  # ends the program if the sweep is killed
            command = ["setpriv", "--pdeathsig", "KILL", *command]
        with self.guard:
            if self.stopping.is_set():
                raise Stopped()
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.children.add(child)
        try:
            output, errors = child.communicate(timeout=RUN_SECONDS)
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            raise Failure(f"not finished after {RUN_SECONDS} s") from None
        finally:
            with self.guard:
                self.children.discard(child)
        if self.stopping.is_set():
            raise Stopped()
        if child.returncode not in codes:
            last = errors.strip().splitlines()[-1:] or ["no message"]
            raise Failure(f"exit code {child.returncode}: {last[0]}")
        return output


class ReportRunner(Runner):
    """A runner whose runs are one program each, which writes a JSON; a brief report of it is kept."""

    def command(self, run):
        """Program and arguments. The prefix of its files, --quiet and the run's own options are appended."""
        raise NotImplementedError

    def brief(self, report):
        """The part of the JSON that is kept."""
        raise NotImplementedError

    def is_whole(self, run, record):
        """Whether the record is the whole result of the run; what is missing in it may raise KeyError or TypeError."""
        raise NotImplementedError

    def examine(self, _report, _folder):
        """Additions to the brief report, from the run's files FOLDER/run.*, which exist only now."""
        return {}

    def more(self, _run):
        """Additions to the record."""
        return {}

    def load(self, run):
        """The finished run's record, or None if there is no whole record of this very run."""
        record = self.cache.read(self.name_of(run))
        try:
            whole = (record["configuration"] == dataclasses.asdict(run) and is_number(record["seconds"])
                     and self.is_whole(run, record))
        except (KeyError, TypeError):
            return None
        return record if whole else None

    def make_one(self, run):
        start = time.monotonic()
        folder = self.cache.work / self.name_of(run)
        shutil.rmtree(folder, ignore_errors=True)  # left by an attempt that was killed
        folder.mkdir()
        # Exit codes 3 and 4 are verdicts, which the report tells.
        self.execute([*self.command(run), "-o", str(folder / "run"), "--quiet", *run.options()], codes=(0, 3, 4))
        whole = json.loads((folder / "run.json").read_text())
        report = {**self.brief(whole), **self.examine(whole, folder)}
        shutil.rmtree(folder)
        record = {"configuration": dataclasses.asdict(run), "seconds": time.monotonic() - start, **self.more(run),
                  "report": report}
        self.cache.write(self.name_of(run), record)
        return record


class Progress:
    """Prints runs done, all runs and time left on standard error: in place on a terminal, now and then elsewhere."""

    def __init__(self, runs, done, pending_cost):
        self.all, self.done, self.left = runs, done, pending_cost
        self.all_cost = pending_cost
        self.start = self.shown = time.monotonic()
        if done:
            print(f"{done} of {runs} runs were finished before", file=sys.stderr)

    def step(self, run_cost, failures):
        self.done += 1
        self.left -= run_cost
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if not terminal and now - self.shown < 10 and self.done < self.all:
            return
        self.shown = now
        left = round((now - self.start) * max(self.left, 0) / max(self.all_cost - self.left, 1e-9))
        failed = f", {failures} failed" if failures else ""
        print(f"{chr(13) if terminal else ''}{self.done} of {self.all} runs, "
              f"{left // 60}:{left % 60:02d} min left{failed}   ",
              end="" if terminal else "\n", file=sys.stderr, flush=True)

    def end(self):
        if sys.stderr.isatty():
            print(file=sys.stderr)
