"""How the cost of whole jobs grows with the array, the depth, the scene and the rays."""
import pathlib
import re
import sys
import typing

from studies import programs
from studies.bench.rows import made_by

PHASES = ["load", "precast", "trace"]
KEYS = ["scene", "side", "depth", "max_depth", "shadows", "round"]
FIELDS = ["primitives", "polygons", "rays", *(f"hops_{phase}" for phase in PHASES),
          *(f"processor_{phase}" for phase in PHASES), *(f"wall_{phase}" for phase in PHASES), "wall_build",
          "processor_job", "wall_job", "peak_memory_bytes"]
GROWING = ["teapot-s4", "balls-s2"]  # scenes of the series over array, depth and rays
FAMILIES = ["balls", "mount", "tetra"]  # of the SPD, each in several sizes
PRIMITIVES = {"s", "c", "p", "pp"}  # of an NFF file
RAYS = 4  # generations, the program's default
LEVELS = 1024  # the same


class Job(typing.NamedTuple):
    scene: pathlib.Path
    side: int
    depth: int = LEVELS
    max_depth: int = RAYS
    shadows: str = "per-hit"

    def key(self, turn):
        return (self.scene.stem, self.side, self.depth, self.max_depth, self.shadows, turn)


class Design(typing.NamedTuple):
    """The jobs with which growth is measured."""
    sides: list
    side: int  # cells a side, in the other series
    depths: list
    max_depths: list
    precast_side: int  # cells a side; on larger arrays precast alone takes longer than all the rest

    def jobs(self, scenes, families):
        """Each job once, even if several series have it; small arrays first."""
        wanted = [Job(scene, side) for side in self.sides for scene in scenes]
        wanted += [Job(scene, self.side, depth=depth) for scene in scenes for depth in self.depths]
        wanted += [Job(scene, self.side) for scene in families]
        wanted += [Job(scene, self.side, max_depth=rays) for scene in scenes for rays in self.max_depths]
        with_precast = [job._replace(shadows="precast") for job in wanted if job.side <= self.precast_side]
        return sorted(dict.fromkeys(wanted + with_precast), key=lambda job: job.side)


def scenes_of(folder, root):
    """The scenes of the series and the families of the SPD; without the SPD, the project's own scene."""
    found = [folder / f"{name}.nff" for name in GROWING]
    scenes = [path for path in found if path.is_file()] or [root / "scenes" / "still_life.nff"]
    families = [path for name in FAMILIES for path in sorted(folder.glob(f"{name}-s*.nff"))]
    return scenes, families


def count_primitives(scene):
    return sum(line.split(None, 1)[0] in PRIMITIVES for line in scene.read_text().splitlines()
               if re.match(r"[a-z]", line))


def run_job(program, job):
    """Runs a job. Returns figures of its report, and the process's cost as the system counts it."""
    try:
        report, done = programs.render(program, job.scene, "--cells", f"{job.side}x{job.side}", "--depth", job.depth,
                                       "--max-depth", job.max_depth, "--shadows", job.shadows)
    except programs.Failed as error:
        sys.exit(f"study bench: {error}")
    model, rays = report["model"], report["rays"]
    hops = {"load": report["hops"]["load"], "precast": report["precast"]["hops"]}
    hops["trace"] = report["hops"]["ray"] + report["hops"]["return"] - hops["precast"]
    kinds = ("primary", "reflected", "refracted", "shadow", "precast")
    return {"polygons": report["cube"]["polygons"], "rays": sum(rays[kind] for kind in kinds),
            **{f"hops_{phase}": hops[phase] for phase in PHASES},
            **{f"processor_{phase}": model["processor_seconds"][phase] for phase in PHASES},
            **{f"wall_{phase}": model["wall_seconds"][phase] for phase in PHASES},
            "wall_build": model["wall_seconds"]["build"], "wall_job": done.wall,
            "processor_job": done.processor,
            "peak_memory_bytes": model["peak_memory_bytes"]}


def measure_growth(program, jobs, rounds, rows):
    """Measures in rounds, so that a disturbance hits a round of all jobs. Makes only the runs that `rows` lacks."""
    makers = {scene: made_by(program, scene) for scene in {job.scene for job in jobs}}
    runs = [(job, turn) for turn in range(rounds) for job in jobs]
    missing = [(job, turn) for job, turn in runs if not rows.have(job.key(turn), makers[job.scene])]
    print(f"growth: {len(runs)} runs, {len(missing)} to make", flush=True)
    for number, (job, turn) in enumerate(missing, 1):
        row = run_job(program, job)
        rows.add({**dict(zip(KEYS, job.key(turn))), "primitives": count_primitives(job.scene), **row,
                  "made_by": makers[job.scene]})
        print(f"{number} of {len(missing)}: {job.scene.stem} {job.side}x{job.side}, depth {job.depth}, max-depth "
              f"{job.max_depth}, {job.shadows}: {row['processor_job']:.1f} s", flush=True)
    rows.finish([job.key(turn) for job, turn in runs])
