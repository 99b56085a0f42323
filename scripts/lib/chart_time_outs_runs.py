"""Makes the runs in which the time-outs are measured."""
import dataclasses
import json
import shutil
import time

from chart_time_outs_design import TIME_OUTS, cost
from sweep_runs import Cache, Failure, Runner, hash_of, is_number


def brief(report):
    """What of a run's JSON is kept."""
    time_outs = report["deadlock"]["time_outs"]
    if [each["cycles"] for each in time_outs] != TIME_OUTS:
        raise Failure("the time-outs are not those that were expected")
    record = {"verdict": report["verdict"], "trace_cycles": report["cycles"]["trace"],
              "false_alarms": [each["false_alarms"] for each in time_outs],
              "early_alarms": [each["early_alarms"] for each in time_outs]}
    if report["verdict"] != "deadlock":
        return record
    # A locked run stands still, so what waits at its end waits for ever: no T is too long for it.
    lasting = {tuple(each[name] for name in ["knot_cells", "knot_alarms", "missed_knots"])
               + (each["first_alarm_delay"] - each["cycles"] if "first_alarm_delay" in each else "",)
               for each in time_outs}
    if len(lasting) != 1:
        raise Failure("misses depend on the time-out: the run did not stand still")
    knot = report["deadlock"]["knot"]
    names = ["knot_cells", "alarming_cells", "missed_knots", "first_wait"]
    return {**record, **dict(zip(names, lasting.pop())), "knots": knot["knots"],
            "stood_still": report["cycles"]["total"] - knot["formed"]}


class Sweep(Runner):
    def __init__(self, program, folder):
        super().__init__(Cache(folder / f"time_outs-{hash_of(program)}", "chart_time_outs"))
        self.program = program

    def load(self, configuration):
        """The finished run, or None; whatever is not the whole result of just this run counts as none."""
        record = self.cache.read(configuration.label())
        try:
            whole = (record["configuration"] == dataclasses.asdict(configuration)
                     and is_number(record["seconds"]) and len(record["report"]["false_alarms"]) == len(TIME_OUTS)
                     and len(record["report"]["early_alarms"]) == len(TIME_OUTS))
        except (KeyError, TypeError):
            return None
        return record if whole else None

    def make_all(self, runs, jobs):
        return self.make(runs, jobs, cost)

    def make_one(self, configuration):
        start = time.monotonic()
        folder = self.cache.work / configuration.label()
        folder.mkdir()
        # Codes 3 and 4 are verdicts of a run, and the report says which.
        self.execute([str(self.program), "-o", str(folder / "run"), "--quiet", *configuration.options()],
                     codes=(0, 3, 4))
        report = brief(json.loads((folder / "run.json").read_text()))
        shutil.rmtree(folder)
        record = {"configuration": dataclasses.asdict(configuration), "seconds": time.monotonic() - start,
                  "report": report}
        self.cache.write(configuration.label(), record)
        return record
