"""Makes the runs of the deadlock sweep: deadlock_tb for synthetic traffic, raycell render for a scene."""
import json

from studies.deadlock import check_knots
from studies.deadlock.design import cost
from studies.sweeps.runs import Cache, Failure, ReportRunner, hash_of, is_number

KEPT = ["verdict", "cycles", "pixels", "rays", "messages", "ray_store", "buffers", "storage_bits", "message_bits",
        "hash", "equals_untimed"]


def brief(report):
    """The part of a run's JSON that the sweep keeps: not the lines on what was stuck, which may be thousands."""
    kept = {key: report[key] for key in KEPT if key in report}
    deadlock = report["deadlock"]
    kept["deadlock"] = {"postponed": deadlock["postponed"]}
    if "knot" in deadlock:
        knot = deadlock["knot"]
        kept["deadlock"]["knot"] = {"cells": len(knot["cells"]), "formed": knot["formed"]}
    return kept


class Sweep(ReportRunner):
    def __init__(self, programs, scenes, folder):
        """`programs`: the folder of raycell and deadlock_tb; `scenes`: {name: path}."""
        self.raycell, self.deadlock_tb = programs / "raycell", programs / "deadlock_tb"
        hashes = f"{hash_of(self.raycell)}-{hash_of(self.deadlock_tb)}"
        super().__init__(Cache(folder / f"deadlock-{hashes}", "study deadlock"))
        self.scenes = scenes
        self.scene_hashes = {name: hash_of(path) for name, path in scenes.items()}

    def command(self, configuration):
        if configuration.synthetic:
            return [str(self.deadlock_tb)]
        return [str(self.raycell), "render", str(self.scenes[configuration.load])]

    def brief(self, report):
        return brief(report)

    def examine(self, report, folder):
        """Checks that a search over the dumped graph finds the knots of a deadlock. Raises Failure if not."""
        if "knot" not in report["deadlock"]:
            if report["verdict"] == "deadlock":
                raise Failure("a deadlock without a knot")
            return {}
        wrong = check_knots.objection(json.loads((folder / "run.waits.json").read_text()))
        if wrong:
            raise Failure(f"the knot is none: {wrong}")
        return {"knots_accepted": True}

    def more(self, configuration):
        return {"scene_hash": self.scene_hashes.get(configuration.load)}

    def is_whole(self, configuration, record):
        return (("knot" not in record["report"]["deadlock"] or record["report"]["knots_accepted"])
                and record["scene_hash"] == self.scene_hashes.get(configuration.load)
                and is_number(record["report"]["cycles"]["trace"])
                and is_number(record["report"]["storage_bits"]["total"]))

    def cost(self, configuration):
        return cost(configuration)
