"""The rows of accuracy.csv: written from the runs' results, read back for tables and charts."""
import dataclasses

from studies.accuracy.design import FRONT_CELLS, FULL_CELLS, Configuration
from studies.sweeps.rows import SweepRow, read_csv, write_csv


def row_of(configuration, record, exact_record):
    """One line of the CSV. Cycles are empty where the run was untimed, the arithmetic's dB where it was exact."""
    report, accuracy, voxels = record["report"], record["report"]["accuracy"], record["report"]["voxels"]
    cycles = report["cycles"] if record["timed"] else dict.fromkeys(["load", "precast", "trace", "total"], "")
    arithmetic = record["arithmetic"]["psnr_db"] if record["arithmetic"] else ""
    return {
        **dataclasses.asdict(configuration),
        "engine": "timed" if record["timed"] else "untimed", "verdict": report["verdict"],
        **{f"{phase}_cycles": cycles[phase] for phase in ["load", "precast", "trace", "total"]},
        "bits_per_voxel": round(voxels["bits_each"], 1), "fullest_cell_bits": voxels["max_bits_per_cell"],
        "voxels": voxels["stored"], "fullest_cell_voxels": voxels["max_per_cell"],
        "ray_bits": report["message_bits"]["ray"], "psnr_total_db": round(accuracy["scene"]["psnr_db"], 3),
        "psnr_discretisation_db": round(exact_record["report"]["accuracy"]["psnr_db"], 3),
        "psnr_arithmetic_db": arithmetic if arithmetic == "" else round(arithmetic, 3),
        "wrong_hit_percent": round(accuracy["wrong_hit_percent"], 4), "max_error": round(accuracy["scene"]["max_error"], 6),
        "image_hash": report["hash"]["image"], "schedule_hash": report["hash"]["schedule"] if record["timed"] else "",
    }


def write(path, runs, records):
    """Writes rows in the order of the design, without runs whose machine in exact arithmetic failed."""
    lines = [row_of(c, records[c], records[c.exact()]) for c in runs if c in records and c.exact() in records]
    write_csv(path, lines)


class Row(SweepRow):
    Configuration = Configuration
    TEXTS = ["engine", "verdict", "image_hash", "schedule_hash"]

    @property
    def timed(self):
        return self.engine == "timed"

    @property
    def picture_cycles(self):
        """Cycles from the loaded array to the finished picture."""
        return self.precast_cycles + self.trace_cycles


class Results:
    """All rows, found by their configuration; the sizes and scenes are those that the sweep ran."""

    def __init__(self, path):
        rows = read_csv(path, Row)
        self.rows = {row.configuration: row for row in rows}
        timed = [row.configuration for row in rows if row.timed]
        words = [row.configuration for row in rows if row.configuration.arithmetic == "fixed"]
        self.scenes = list(dict.fromkeys(c.scene for c in timed))
        self.word_scenes = list(dict.fromkeys(c.scene for c in words))
        self.front_cells = self.commonest([c.cells for c in timed], FRONT_CELLS)
        # Only the sweep over all word lengths has a word of 32 bits at `mask`.
        self.full_cells = self.commonest([c.cells for c in words if c.hit == "mask" and c.word_bits == 32], FULL_CELLS)
        self.sizes = sorted({c.cells for c in words})

    @staticmethod
    def commonest(values, otherwise):
        return max(set(values), key=values.count) if values else otherwise

    def at(self, *words, **factors):
        return self.rows.get(Configuration(*words, **factors))

    def word_lengths(self, scene, cells, hit):
        """Rows of this scene, size and rung over the word length, all else default; shortest first."""
        rows = [self.at(scene, cells, hit, word_bits=bits) for bits in range(8, 33)]
        return [row for row in rows if row]

    def front_points(self, scene):
        """The rows of the main chart: hit test x word bits x shadows x normals, timed, of one size."""
        points = []
        for row in self.rows.values():
            c = row.configuration
            plain = Configuration(scene, self.front_cells, c.hit, c.normals, c.shadows, "fixed", c.word_bits)
            if c == plain and row.timed and row.verdict == "completed":
                points.append(row)
        return points


def pareto(points):
    """Points that no other point beats in both cycles and error; fewest cycles first."""
    front = []
    for row in sorted(points, key=lambda r: (r.picture_cycles, -r.psnr_total_db)):
        if not front or row.psnr_total_db > front[-1].psnr_total_db:
            front.append(row)
    return front


def name_of(configuration):
    """hit / bits / shadows, and the normals where they are not the default."""
    voxel = "/voxel normal" if configuration.normals == "voxel" else ""
    return f"{configuration.hit}/{configuration.word_bits}/{configuration.shadows}{voxel}"


def fewest_bits(rows, least_db):
    """The shortest word length that reaches `least_db`, as does every longer one; None if there is none."""
    fewest = None
    for row in reversed(rows):
        if row.psnr_total_db < least_db:
            break
        fewest = row.configuration.word_bits
    return fewest
