"""Makes the runs in which the time-outs are measured."""
from studies.time_outs.design import TIME_OUTS, cost
from studies.sweeps.runs import Cache, Failure, ReportRunner, hash_of


def brief(report):
    """The part of a run's JSON that is kept."""
    time_outs = report["deadlock"]["time_outs"]
    if [each["cycles"] for each in time_outs] != TIME_OUTS:
        raise Failure("the time-outs are not those that were expected")
    record = {"verdict": report["verdict"], "trace_cycles": report["cycles"]["trace"],
              "false_alarms": [each["false_alarms"] for each in time_outs],
              "early_alarms": [each["early_alarms"] for each in time_outs]}
    if report["verdict"] != "deadlock":
        return record
    # A locked run stands still: what waits at its end waits for ever, so every T finds the same lasting alarms.
    lasting = {tuple(each[name] for name in ["knot_cells", "knot_alarms", "missed_knots"])
               + (each["first_alarm_delay"] - each["cycles"] if "first_alarm_delay" in each else "",)
               for each in time_outs}
    if len(lasting) != 1:
        raise Failure("misses depend on the time-out: the run did not stand still")
    knot = report["deadlock"]["knot"]
    names = ["knot_cells", "alarming_cells", "missed_knots", "first_wait"]
    return {**record, **dict(zip(names, lasting.pop())), "knots": knot["knots"],
            "stood_still": report["cycles"]["total"] - knot["formed"]}


class Sweep(ReportRunner):
    def __init__(self, program, folder):
        super().__init__(Cache(folder / f"time_outs-{hash_of(program)}", "study time_outs"))
        self.program = program

    def command(self, _):
        return [str(self.program)]

    def brief(self, report):
        return brief(report)

    def is_whole(self, _, record):
        return all(len(record["report"][name]) == len(TIME_OUTS) for name in ["false_alarms", "early_alarms"])

    def cost(self, configuration):
        return cost(configuration)
