"""Makes the runs of a sweep on all cores and keeps each finished one, so that a stopped sweep goes on where it was."""
import concurrent.futures
import dataclasses
import fcntl
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time

from chart_accuracy_design import cost

RUN_SECONDS = 1800  # a run that takes longer is stuck


class Failure(Exception):
    """A run that gave no result."""


class Stopped(Exception):
    """The sweep was told to stop."""


def hash_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Cache:
    """Finished runs of one program, a file each, written beside and renamed."""

    def __init__(self, folder, program):
        self.folder = folder / f"accuracy-{hash_of(program)}"
        self.work = self.folder / "work"
        self.lock = None

    def occupy(self):
        """Lets one sweep at a time work here, and clears away what killed runs left."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lock = open(self.folder / "lock", "w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            sys.exit(f"chart_accuracy: another sweep is at work in {self.folder}; wait for it or stop it")
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()

    def path(self, configuration, timed):
        return self.folder / f"{configuration.label()}.{'timed' if timed else 'untimed'}.json"

    def load(self, configuration, timed, scene_hash):
        """The finished run, or None; whatever is not the whole result of just this run counts as none."""
        try:
            record = json.loads(self.path(configuration, timed).read_text())
            whole = (record["configuration"] == dataclasses.asdict(configuration) and record["timed"] == timed
                     and record["scene_hash"] == scene_hash and is_number(record["seconds"])
                     and is_number(record["report"]["accuracy"]["psnr_db"])
                     and (configuration.arithmetic == "exact" or is_number(record["arithmetic"]["psnr_db"])))
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return record if whole else None

    def store(self, configuration, timed, record):
        path = self.path(configuration, timed)
        partial = self.work / path.name
        partial.write_text(json.dumps(record, indent=1))
        os.replace(partial, path)


class Sweep:
    """Runs the program for each configuration; pictures are kept only until they are compared."""

    def __init__(self, program, scenes, cache):
        self.program = program
        self.cache = cache
        self.scenes = scenes  # {name: path}
        self.scene_hashes = {name: hash_of(path) for name, path in scenes.items()}
        self.stopping = threading.Event()
        self.guard = threading.Lock()
        self.children = set()
        self.exact_locks = {}
        self.exact_users = {}

    def finished(self, runs):
        """{configuration: record} of what is in the cache."""
        found = {c: self.cache.load(c, timed, self.scene_hashes[c.scene]) for c, timed in runs.items()}
        return {c: record for c, record in found.items() if record}

    def make(self, runs, jobs):
        """Makes the runs that are not in the cache; returns all records and {configuration: what went wrong}."""
        self.cache.occupy()
        records, failures = self.finished(runs), {}
        pending = sorted((c for c in runs if c not in records), key=lambda c: -cost(c, runs[c]))
        for configuration in pending:
            exact = configuration.exact()
            self.exact_locks.setdefault(exact, threading.Lock())
            self.exact_users[exact] = self.exact_users.get(exact, 0) + 1
        progress = Progress(len(runs), len(records), sum(cost(c, runs[c]) for c in pending))
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            futures = {pool.submit(self.make_one, c, runs[c]): c for c in pending}
            try:
                for future in concurrent.futures.as_completed(futures):
                    configuration = futures[future]
                    error = future.exception()
                    if error is None:
                        records[configuration] = future.result()
                    elif isinstance(error, (Failure, OSError)):
                        failures[configuration] = str(error)
                    else:
                        raise error
                    progress.step(cost(configuration, runs[configuration]), len(failures))
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

    def make_one(self, configuration, timed):
        """One run and its comparison with the exact machine's picture; stores and returns its record."""
        start = time.monotonic()
        exact = configuration.exact()
        try:
            if configuration == exact and not timed:
                with self.exact_locks[exact]:
                    report, arithmetic = self.exact_report(exact), None
            else:
                prefix = self.cache.work / f"{configuration.label()}.{timed}"
                report = self.render(configuration, "timed" if timed else "untimed", prefix)
                with self.exact_locks[exact]:
                    self.exact_report(exact)
                arithmetic = self.compare(prefix.with_name(prefix.name + ".exr"), self.picture_of(exact))
                self.remove(prefix)
        finally:
            self.release(exact)
        record = {"configuration": dataclasses.asdict(configuration), "timed": timed,
                  "scene_hash": self.scene_hashes[configuration.scene], "seconds": time.monotonic() - start,
                  "report": report, "arithmetic": arithmetic}
        self.cache.store(configuration, timed, record)
        return record

    def picture_of(self, exact):
        return self.cache.work / f"{exact.label()}.reference.exr"

    def exact_report(self, exact):
        """Renders the machine in exact arithmetic unless its picture lies there already; its lock is held."""
        prefix = self.cache.work / f"{exact.label()}.reference"
        if not self.picture_of(exact).exists():
            self.render(exact, "untimed", prefix)
        return json.loads(prefix.with_name(prefix.name + ".json").read_text())

    def release(self, exact):
        """The last one that needed the exact picture deletes it."""
        with self.guard:
            self.exact_users[exact] -= 1
            last = self.exact_users[exact] == 0
        if last:
            self.remove(self.cache.work / f"{exact.label()}.reference")

    @staticmethod
    def remove(prefix):
        for suffix in [".exr", ".png", ".json", ".toml", ".cells.csv", ".truth.exr", ".truth.png", ".difference.png"]:
            pathlib.Path(f"{prefix}{suffix}").unlink(missing_ok=True)

    def render(self, configuration, engine, prefix):
        scene = self.scenes[configuration.scene]
        self.run(["render", str(scene), "-o", str(prefix), "--engine", engine, "--truth", "--quiet",
                  *configuration.options()], may_end_early=True)
        return json.loads(pathlib.Path(f"{prefix}.json").read_text())

    def compare(self, picture, reference):
        return json.loads(self.run(["compare", str(picture), str(reference), "--json"]))

    def run(self, words, may_end_early=False):
        """Runs the program; codes 3 and 4 are verdicts of a run, and the report says which."""
        command = [str(self.program), *words]
        if shutil.which("setpriv"):  # a killed sweep takes its runs along
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
        if child.returncode != 0 and not (may_end_early and child.returncode in (3, 4)):
            last = errors.strip().splitlines()[-1:] or ["no message"]
            raise Failure(f"exit code {child.returncode}: {last[0]}")
        return output


class Progress:
    """Done, all and time left on standard error: rewritten in place on a terminal, now and then elsewhere."""

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
