"""Makes the runs of the accuracy sweep and compares each with its machine in exact arithmetic."""
import collections
import dataclasses
import json
import pathlib
import threading
import time

from studies.accuracy.design import cost
from studies.sweeps.runs import Cache, Runner, Shared, hash_of, is_number

SUFFIXES = [".exr", ".png", ".json", ".toml", ".cells.csv", ".truth.exr", ".truth.png", ".difference.png"]


class Sweep(Runner):
    """Runs the program for each configuration; pictures are kept only until they are compared."""

    def __init__(self, program, scenes, runs, folder):
        """`scenes`: {name: path}; `runs`: {configuration: timed}."""
        super().__init__(Cache(folder / f"accuracy-{hash_of(program)}", "study accuracy"))
        self.program = program
        self.scenes = scenes
        self.scene_hashes = {name: hash_of(path) for name, path in scenes.items()}
        self.runs = runs
        self.exact_locks = collections.defaultdict(threading.Lock)
        self.exact_users = {}

    def name_of(self, configuration):
        return f"{configuration.label()}.{'timed' if self.runs[configuration] else 'untimed'}"

    def load(self, configuration):
        """The finished run's record, or None if there is no whole record of this very run."""
        record = self.cache.read(self.name_of(configuration))
        try:
            whole = (record["configuration"] == dataclasses.asdict(configuration)
                     and record["timed"] == self.runs[configuration]
                     and record["scene_hash"] == self.scene_hashes[configuration.scene]
                     and is_number(record["seconds"]) and is_number(record["report"]["accuracy"]["psnr_db"])
                     and (configuration.arithmetic == "exact" or is_number(record["arithmetic"]["psnr_db"])))
        except (KeyError, TypeError):
            return None
        return record if whole else None

    def cost(self, configuration):
        return cost(configuration, self.runs[configuration])

    def prepare(self, pending):
        for configuration in pending:
            exact = configuration.exact()
            self.exact_users[exact] = self.exact_users.get(exact, 0) + 1

    def make_one(self, configuration):
        try:
            return self.make_apart(configuration)
        finally:
            self.release(configuration.exact())

    def make_apart(self, configuration):
        """Makes a run and compares it with the exact machine's picture; stores and returns its record."""
        start = time.monotonic()
        timed = self.runs[configuration]
        exact = configuration.exact()
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
        record = {"configuration": dataclasses.asdict(configuration), "timed": timed,
                  "scene_hash": self.scene_hashes[configuration.scene], "seconds": time.monotonic() - start,
                  "report": report, "arithmetic": arithmetic}
        self.cache.write(self.name_of(configuration), record)
        return record

    def shared(self, configuration):
        exact = configuration.exact()
        return Shared(f"{exact.label()}.reference", (".exr", ".json"))

    def make_shared(self, configuration):
        exact = configuration.exact()
        self.exact_report(exact)
        self.remove(self.cache.work / f"{exact.label()}.reference", keep=self.shared(exact).suffixes)

    def picture_of(self, exact):
        return self.cache.work / f"{exact.label()}.reference.exr"

    def exact_report(self, exact):
        """Renders the machine in exact arithmetic unless its picture exists already. The caller holds its lock."""
        prefix = self.cache.work / f"{exact.label()}.reference"
        if not self.picture_of(exact).exists():
            self.render(exact, "untimed", prefix)
        return json.loads(prefix.with_name(prefix.name + ".json").read_text())

    def release(self, exact):
        """Deletes the exact picture once no other run needs it."""
        with self.guard:
            self.exact_users[exact] -= 1
            last = self.exact_users[exact] == 0
        if last:
            self.remove(self.cache.work / f"{exact.label()}.reference")

    @staticmethod
    def remove(prefix, keep=()):
        for suffix in SUFFIXES:
            if suffix not in keep:
                pathlib.Path(f"{prefix}{suffix}").unlink(missing_ok=True)

    def render(self, configuration, engine, prefix):
        """Renders and returns the report. Exit codes 3 and 4 are verdicts, which the report tells."""
        scene = self.scenes[configuration.scene]
        self.execute([str(self.program), "render", str(scene), "-o", str(prefix), "--engine", engine, "--truth",
                      "--quiet", *configuration.options()], codes=(0, 3, 4))
        return json.loads(pathlib.Path(f"{prefix}.json").read_text())

    def compare(self, picture, reference):
        return json.loads(self.execute([str(self.program), "compare", str(picture), str(reference), "--json"]))
