"""The rows of time_outs.csv, a run each: written from the runs' results, read back for tables and the chart."""
import dataclasses
import statistics

from studies.time_outs.design import LOADS, MACHINES, TIME_OUTS, Configuration
from studies.sweeps.rows import SweepRow, read_csv, write_csv

LOCKED = ["knots", "missed_knots", "knot_cells", "alarming_cells", "first_wait", "stood_still"]


def row_of(configuration, record):
    """One line of the CSV. `first_wait`: cycles from the forming of the knot to the wait that gives the first lasting
    alarm, T later. `stood_still`: cycles from the forming to the run's end."""
    report = record["report"]
    return {
        **dataclasses.asdict(configuration), "verdict": report["verdict"], "trace_cycles": report["trace_cycles"],
        **{name: report.get(name, "") for name in LOCKED},
        **{f"{kind}_alarms_{cycles}": count for kind in ["false", "early"]
           for cycles, count in zip(TIME_OUTS, report[f"{kind}_alarms"])},
    }


def write(path, runs, records):
    write_csv(path, [row_of(c, records[c]) for c in runs if c in records])


class Row(SweepRow):
    Configuration = Configuration
    TEXTS = ["verdict"]

    @property
    def locked(self):
        return self.verdict == "deadlock"

    def alarms(self, kind, cycles):
        return getattr(self, f"{kind}_alarms_{cycles}")


class Group:
    """Runs that are counted together."""

    def __init__(self, rows):
        self.rows = rows
        self.locked = [row for row in rows if row.locked]
        self.alarming = [row for row in self.locked if row.first_wait is not None]

    def share_with(self, kind, cycles):
        """Share of the runs that have such an alarm."""
        return sum(row.alarms(kind, cycles) > 0 for row in self.rows) / len(self.rows)

    def rate(self, kind, cycles):
        """Alarms per million cell cycles of tracing."""
        cell_cycles = sum(row.trace_cycles * row.configuration.cells ** 2 for row in self.rows)
        return 1e6 * sum(row.alarms(kind, cycles) for row in self.rows) / cell_cycles

    def silent_from(self, *kinds):
        """The smallest T without such an alarm in any run; None if there is none."""
        return next((cycles for cycles in TIME_OUTS
                     if not any(row.alarms(kind, cycles) for row in self.rows for kind in kinds)), None)

    def sum(self, name):
        return sum(getattr(row, name) for row in self.locked)

    def missed_cells(self):
        """Share of the knots' cells that give no alarm."""
        return 1 - self.sum("alarming_cells") / self.sum("knot_cells")

    def missed_knots(self):
        return self.sum("missed_knots") / self.sum("knots")

    def first_waits(self):
        """The first waits: (least, median, most)."""
        waits = [row.first_wait for row in self.alarming]
        return min(waits), statistics.median(waits), max(waits)

    def stood_still(self):
        return statistics.median(row.stood_still for row in self.locked)


class Results:
    """All rows, grouped over the seeds, but for runs that were cut off: their outcome is unknown."""

    def __init__(self, path):
        rows = read_csv(path, Row)
        self.rows = [row for row in rows if row.verdict in ("completed", "deadlock")]
        self.cut_off = len(rows) - len(self.rows)
        self.cells = self.rows[0].configuration.cells
        groups = {}
        for row in self.rows:
            groups.setdefault((row.configuration.load, row.configuration.machine), []).append(row)
        self.groups = {key: Group(found) for key, found in groups.items()}
        self.loads = [load for load in LOADS if any(key[0] == load for key in groups)]
        self.machines = [machine for machine in MACHINES if any(key[1] == machine for key in groups)]
        self.all = Group(self.rows)
        self.completed = Group([row for row in self.rows if not row.locked])

    def of_load(self, load):
        return Group([row for row in self.rows if row.configuration.load == load])
