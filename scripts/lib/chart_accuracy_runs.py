"""Makes the runs of the accuracy sweep, each compared with the picture of its machine in exact arithmetic."""
import dataclasses
import json
import pathlib
import threading
import time

from chart_accuracy_design import cost
from sweep_runs import Cache, Runner, hash_of, is_number


class Sweep(Runner):
    """Runs the program for each configuration; pictures are kept only until they are compared."""

    def __init__(self, program, scenes, folder):
        super().__init__(Cache(folder / f"accuracy-{hash_of(program)}", "chart_accuracy"))
        self.program = program
        self.scenes = scenes  # {name: path}
        self.scene_hashes = {name: hash_of(path) for name, path in scenes.items()}
        self.runs = {}  # {configuration: timed}
        self.exact_locks = {}
        self.exact_users = {}

    @staticmethod
    def name_of(configuration, timed):
        return f"{configuration.label()}.{'timed' if timed else 'untimed'}"

    def load(self, configuration, timed):
        """The finished run, or None; whatever is not the whole result of just this run counts as none."""
        record = self.cache.read(self.name_of(configuration, timed))
        try:
            whole = (record["configuration"] == dataclasses.asdict(configuration) and record["timed"] == timed
                     and record["scene_hash"] == self.scene_hashes[configuration.scene]
                     and is_number(record["seconds"]) and is_number(record["report"]["accuracy"]["psnr_db"])
                     and (configuration.arithmetic == "exact" or is_number(record["arithmetic"]["psnr_db"])))
        except (KeyError, TypeError):
            return None
        return record if whole else None

    def finished(self, runs):
        """{configuration: record} of what is in the cache."""
        found = {c: self.load(c, timed) for c, timed in runs.items()}
        return {c: record for c, record in found.items() if record}

    def make_all(self, runs, jobs):
        """Makes the runs {configuration: timed} that are not in the cache; returns all records and {configuration:
        what went wrong}."""
        self.runs = runs
        return self.make(runs, jobs, lambda configuration: cost(configuration, runs[configuration]))

    def prepare(self, pending):
        for configuration in pending:
            exact = configuration.exact()
            self.exact_locks.setdefault(exact, threading.Lock())
            self.exact_users[exact] = self.exact_users.get(exact, 0) + 1

    def make_one(self, configuration):
        """One run and its comparison with the exact machine's picture; stores and returns its record."""
        start = time.monotonic()
        timed = self.runs[configuration]
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
        self.cache.write(self.name_of(configuration, timed), record)
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
        """Codes 3 and 4 are verdicts of a run, and the report says which."""
        scene = self.scenes[configuration.scene]
        self.execute([str(self.program), "render", str(scene), "-o", str(prefix), "--engine", engine, "--truth",
                      "--quiet", *configuration.options()], codes=(0, 3, 4))
        return json.loads(pathlib.Path(f"{prefix}.json").read_text())

    def compare(self, picture, reference):
        return json.loads(self.execute([str(self.program), "compare", str(picture), str(reference), "--json"]))
