"""Makes the runs of the deadlock sweep: deadlock_tb for synthetic traffic, raycell render for a scene."""
import dataclasses
import json
import shutil
import time

from sweep_deadlock_design import cost
from sweep_runs import Cache, Runner, hash_of, is_number

KEPT = ["verdict", "cycles", "pixels", "rays", "messages", "ray_store", "buffers", "storage_bits", "message_bits",
        "hash", "equals_untimed"]


def brief(report):
    """What of a run's JSON the sweep keeps: not the lines of what was stuck where, which may be thousands."""
    kept = {key: report[key] for key in KEPT if key in report}
    deadlock = report["deadlock"]
    kept["deadlock"] = {"postponed": deadlock["postponed"]}
    if "knot" in deadlock:
        knot = deadlock["knot"]
        kept["deadlock"]["knot"] = {"cells": len(knot["cells"]), "formed": knot["formed"]}
    return kept


class Sweep(Runner):
    def __init__(self, programs, scenes, folder):
        """`programs`: the folder of raycell and deadlock_tb; `scenes`: {name: path}."""
        self.raycell, self.deadlock_tb = programs / "raycell", programs / "deadlock_tb"
        hashes = f"{hash_of(self.raycell)}-{hash_of(self.deadlock_tb)}"
        super().__init__(Cache(folder / f"deadlock-{hashes}", "sweep_deadlock"))
        self.scenes = scenes
        self.scene_hashes = {name: hash_of(path) for name, path in scenes.items()}

    def load(self, configuration):
        """The finished run, or None; whatever is not the whole result of just this run counts as none."""
        record = self.cache.read(configuration.label())
        try:
            whole = (record["configuration"] == dataclasses.asdict(configuration)
                     and record["scene_hash"] == self.scene_hashes.get(configuration.load)
                     and is_number(record["seconds"]) and is_number(record["report"]["cycles"]["trace"])
                     and is_number(record["report"]["storage_bits"]["ray_store"]))
        except (KeyError, TypeError):
            return None
        return record if whole else None

    def make_all(self, runs, jobs):
        return self.make(runs, jobs, cost)

    def make_one(self, configuration):
        start = time.monotonic()
        folder = self.cache.work / configuration.label()
        folder.mkdir()
        if configuration.synthetic:
            command = [str(self.deadlock_tb)]
        else:
            command = [str(self.raycell), "render", str(self.scenes[configuration.load])]
        # Codes 3 and 4 are verdicts of a run, and the report says which.
        self.execute([*command, "-o", str(folder / "run"), "--quiet", *configuration.options()], codes=(0, 3, 4))
        report = brief(json.loads((folder / "run.json").read_text()))
        shutil.rmtree(folder)
        record = {"configuration": dataclasses.asdict(configuration), "seconds": time.monotonic() - start,
                  "scene_hash": self.scene_hashes.get(configuration.load), "report": report}
        self.cache.write(configuration.label(), record)
        return record
