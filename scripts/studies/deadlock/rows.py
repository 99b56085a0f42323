"""The rows of deadlock.csv: written from the runs' results, read back for tables and charts."""
import dataclasses
import statistics

from studies.deadlock.design import NETWORKS, Configuration
from studies.sweeps.rows import SweepRow, read_csv, write_csv

CLASSES = ["all", "ray", "ray_east", "ray_west", "ray_east_south", "ray_west_south", "ray_east_north", "ray_west_north",
           "answer"]


def row_of(configuration, record):
    """One line of the CSV. Classes that the networks don't have are empty, as is the knot if none is known."""
    report = record["report"]
    storage, messages, knot = report["storage_bits"], report["messages"], report["deadlock"].get("knot", {})
    buffers = report["buffers"]
    return {
        **dataclasses.asdict(configuration), "verdict": report["verdict"],
        "completed_share": round(report["pixels"]["completed"] / report["pixels"]["all"], 6),
        "cycles": report["cycles"]["precast"] + report["cycles"]["trace"],
        "rays_sent": messages["rays"]["sent"], "destroyed": messages["rays"]["destroyed"],
        "ray_store_peak": report["ray_store"]["peak"], "ray_store_mean": round(report["ray_store"]["mean"], 6),
        **{f"buffer_peak_{name}": buffers["peak"].get(name, "") for name in CLASSES},
        **{f"buffer_mean_{name}": round(buffers["mean"][name], 6) if name in buffers["mean"] else ""
           for name in CLASSES},
        "buffer_bits": storage["ray_buffers"] + storage["answer_buffers"], "slot_bits": storage["slot"],
        "ray_store_bits": storage["ray_store"], "register_bits": storage["registers"]["total"], "ray_bits": report["message_bits"]["ray"],
        "knot_cells": knot.get("cells", ""), "knot_formed": knot.get("formed", ""),
        "image_hash": report["hash"]["image"], "schedule_hash": report["hash"]["schedule"],
    }


def write(path, runs, records):
    """Writes rows in the order of the design."""
    lines = [row_of(c, records[c]) for c in runs if c in records]
    write_csv(path, lines)


class Row(SweepRow):
    Configuration = Configuration
    TEXTS = ["verdict", "image_hash", "schedule_hash"]

    @property
    def completed(self):
        return self.verdict == "completed"

    @property
    def locked(self):
        """Whether a deadlock is certain: by the verdict, or by a knot in a run that was cut off."""
        return self.verdict == "deadlock" or self.knot_cells is not None

    @property
    def cell_bits(self):
        return self.buffer_bits + self.ray_store_bits + self.register_bits

    def buffer_use(self, kind):
        """(peak, mean) over the classes of rays, or of answers; `shared` has one for both."""
        names = ["all", *([kind] if kind == "answer" else [name for name in CLASSES if name.startswith("ray")])]
        peaks = [p for p in (getattr(self, f"buffer_peak_{name}") for name in names) if p is not None]
        means = [m for m in (getattr(self, f"buffer_mean_{name}") for name in names) if m is not None]
        return max(peaks, default=0.0), statistics.mean(means) if means else 0.0


class Group:
    """Runs that differ only in their seed."""

    def __init__(self, rows):
        self.rows = rows

    def share(self, quality):
        return sum(quality(row) for row in self.rows) / len(self.rows)

    @property
    def safe(self):
        return all(row.completed for row in self.rows)

    def median(self, value):
        return statistics.median(value(row) for row in self.rows)

    def verdicts(self):
        """The text of a table's cell: how many runs completed, and what became of the others."""
        kinds = [(sum(row.completed for row in self.rows), "ends"),
                 (sum(row.locked for row in self.rows), "locks"),
                 (sum(row.verdict == "livelock" and not row.locked for row in self.rows), "livelock"),
                 (sum(row.verdict == "cycle_limit" and not row.locked for row in self.rows), "limit")]
        present = [(number, word) for number, word in kinds if number]
        if len(present) == 1:
            return present[0][1]
        return ", ".join(f"{number} {word}" for number, word in present)


class Results:
    """All rows, grouped over their seeds; the loads and sizes are those that the sweep ran."""

    def __init__(self, path):
        self.rows = read_csv(path, Row)
        groups = {}
        for row in self.rows:
            groups.setdefault(dataclasses.replace(row.configuration, seed=0), []).append(row)
        self.groups = {key: Group(rows) for key, rows in groups.items()}
        self.loads = list(dict.fromkeys(row.configuration.load for row in self.rows))
        self.main = {load: self.main_size(load) for load in self.loads}  # {load: (cells, limit)}

    def main_size(self, load):
        sizes = [(c.cells, c.max_cycles) for c in self.groups if c.load == load and c.max_cycles]
        return max(set(sizes), key=sizes.count)

    def at(self, load, networks, depth, ray_store, mode, size=None):
        """The group, or None. `size`: (cells, limit), the load's main one if it is not given."""
        cells, limit = size or self.main[load]
        return self.groups.get(Configuration(load, cells, networks, depth, ray_store, *mode, 0, limit))

    def line(self, load, networks, depth, mode, size=None):
        """[(M, group)] of one network, depth and mode, smallest M first."""
        stores = sorted({c.ray_store for c in self.groups if c.load == load})
        found = [(m, self.at(load, networks, depth, m, mode, size)) for m in stores]
        return [(m, group) for m, group in found if group]

    def networks(self, load):
        present = {c.networks for c in self.groups if c.load == load}
        return [networks for networks in NETWORKS if networks in present]

    def depths(self, load):
        return sorted({c.buffer for c in self.groups if c.load == load})


def smallest_safe(line):
    """The smallest (M, group) whose runs all complete, as do those of every larger M; None if there is none."""
    safe = None
    for m, group in reversed(line):
        if not group.safe:
            break
        safe = (m, group)
    return safe
