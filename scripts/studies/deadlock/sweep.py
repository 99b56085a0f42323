"""The sweep of scripts/study deadlock: its runs, how they are made, and what is written from them."""
import pathlib

from studies.deadlock import design
from studies.deadlock import rows
from studies.sweeps.command import Command, positive
from studies.deadlock.runs import Sweep
from studies.deadlock.tables import document


class DeadlockSweep(Command):
    name = "deadlock"
    description = ("Sweeps networks, buffer depth, M, recovery, array size and seeds, for synthetic traffic and a scene; "
                   "writes tables and charts of what locks, what ends, and what it costs.")
    quick = "a dozen tiny runs"
    charts = ["deadlock.png", "deadlock.svg", "deadlock_occupancy.png", "deadlock_bits.png"]
    rows = rows
    document = document

    def add_options(self, add):
        add("--scene", metavar="FILE", type=pathlib.Path, help="the scene beside the synthetic traffic; default: "
            "scenes/cornell.nff")
        add("--limit", metavar="CYCLES", type=positive, default=design.SCENE_LIMIT, help="a scene's run is cut off "
            "after so many, loading included; default: %(default)s")
        add("--program-folder", metavar="FOLDER", type=pathlib.Path, help="the folder of raycell and deadlock_tb; "
            "default: build, where they are built first")

    @property
    def scene(self):
        return self.options.scene or self.root / "scenes" / "cornell.nff"

    def blocks(self):
        if not self.scene.is_file():
            self.fail(f"{self.scene} is missing; expected a scene's file")
        name = self.scene.stem
        if name == design.SYNTHETIC:
            self.fail(f"a scene can't be named '{design.SYNTHETIC}'; that is the other load")
        return design.quick_blocks(name) if self.options.quick else design.blocks(name, self.options.limit)

    def every(self):
        return design.runs_of(self.blocks())

    def runner(self):
        programs = (self.options.program_folder or self.root / "build").resolve()
        for name in ("raycell", "deadlock_tb"):
            self.check_program(programs / name, "the folder of raycell and deadlock_tb")
        return Sweep(programs, {self.scene.stem: self.scene.resolve()}, self.places.cache)

    def print_list(self, runs, done):
        for title, configurations in self.blocks().items():
            seconds = sum(design.cost(c) for c in configurations)
            print(f"# {title}: {len(configurations)} runs, about {seconds / 60:.1f} minutes on one core")
        for configuration in runs:
            print(f"{'done ' if configuration in done else '     '}{configuration.label()}")
        seconds = sum(design.cost(c) for c in runs if c not in done)
        print(f"# {len(runs)} distinct runs, {len(done)} finished; the rest: about {seconds / 60:.0f} minutes on one "
              "core")

    def wrong(self, records):
        return [f"{c.label()} gave another picture than the untimed machine" for c, record in records.items()
                if record["report"].get("equals_untimed") is False]

    def draw(self, results):
        from studies.deadlock.pictures import draw_bits, draw_locks, draw_occupancy  # matplotlib is needed only here
        charts = self.places.charts
        draw_locks(results, charts / "deadlock")
        draw_occupancy(results, charts / "deadlock_occupancy.png")
        draw_bits(results, charts / "deadlock_bits.png")


def main(root, words):
    return DeadlockSweep([root, *words]).main()
