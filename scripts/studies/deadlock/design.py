"""Which runs the deadlock sweep makes: networks x buffer depth x M x recovery x seeds, and some beside these."""
import dataclasses

NETWORKS = ["shared", "split", "half", "quadrant"]
SAFE_NETWORKS = ["half", "quadrant"]  # plain forwarding can't lock them
DEPTHS = [1, 2, 4]
SLOTS = [1, 2, 3, 4, 5, 6, 8, 12, 16]
FEW_SLOTS = [1, 2, 3, 4, 5, 6, 8]
SEEDS = [1, 2, 3, 4, 5]
SYNTHETIC = "synthetic"
CELLS = 64
OTHER_CELLS = {16: SEEDS, 32: SEEDS, 128: SEEDS[:2]}
FULL_CELLS = 16  # of the runs without a limit of cycles
LIMIT = 200_000  # cycles, loading included: several times what the slowest run that ends takes
SCENE_LIMIT = 1_000_000
GENERATIONS = {SYNTHETIC: 3}  # generations that may have to wait: the bound of design section 5
SCENE_GENERATIONS = 5  # max-depth 4, and the last waits for its shadow rays
MODES = [("none", "reserved"), ("none", "free"), ("postpone", "reserved"), ("postpone", "free")]


@dataclasses.dataclass(frozen=True)
class Configuration:
    """The factors of a run. `load`: what the rays meet, synthetic traffic or a scene by its name."""

    load: str
    cells: int = CELLS
    networks: str = "half"
    buffer: int = 1
    ray_store: int = 8
    recovery: str = "postpone"
    slots: str = "reserved"
    seed: int = 1
    max_cycles: int = 0

    @property
    def synthetic(self):
        return self.load == SYNTHETIC

    @property
    def mode(self):
        return self.recovery, self.slots

    @property
    def bound(self):
        """The smallest M with which `half` and `quadrant` with recovery and reserved slots are said always to end."""
        return GENERATIONS.get(self.load, SCENE_GENERATIONS)

    def label(self):
        limit = f"limit{self.max_cycles}" if self.max_cycles else "nolimit"
        return ".".join([self.load, f"{self.cells}x{self.cells}", self.networks, f"buffer{self.buffer}",
                         f"M{self.ray_store}", self.recovery, self.slots, f"seed{self.seed}", limit])

    def options(self):
        traffic = ["--generations", "3", "--hit-probability", "0.1", "--branching", "1", "--directions", "back",
                   "--turn-back", "0.5", "--sources", "0"]
        scene = ["--max-depth", "4", "--shadows", "per-hit"]
        words = ["--cells", f"{self.cells}x{self.cells}", *(traffic if self.synthetic else scene)]
        for field in dataclasses.fields(self)[2:]:
            words += ["--" + field.name.replace("_", "-"), str(getattr(self, field.name))]
        return words


def seeds_of(load, recovery):
    """The seeds of a load. A scene's run draws nothing but the jitter of recovery's back-off."""
    return SEEDS if load == SYNTHETIC or recovery == "postpone" else SEEDS[:1]


def limited(load, cells=CELLS, limit=None, **factors):
    return Configuration(load, cells, max_cycles=limit or LIMIT, **factors)


def main_block(load, limit):
    return [limited(load, CELLS, limit, networks=networks, buffer=depth, ray_store=m, recovery=recovery, seed=seed)
            for networks in NETWORKS for depth in DEPTHS for m in SLOTS for recovery in ["none", "postpone"]
            for seed in seeds_of(load, recovery)]


def free_block(load, limit):
    return [limited(load, CELLS, limit, networks=networks, ray_store=m, recovery=recovery, slots="free", seed=seed)
            for networks in SAFE_NETWORKS for m in FEW_SLOTS for recovery in ["none", "postpone"]
            for seed in seeds_of(load, recovery)]


def size_block():
    return [limited(SYNTHETIC, cells, networks=networks, ray_store=m, recovery=recovery, seed=seed)
            for cells, seeds in OTHER_CELLS.items() for networks in ["split", "half"] for m in [2, 3, 4, 8]
            for recovery in ["none", "postpone"] for seed in seeds]


def full_block():
    return [Configuration(SYNTHETIC, FULL_CELLS, networks, ray_store=m, seed=seed)
            for networks in NETWORKS for m in [1, 2, 3, 4] for seed in SEEDS[:2]]


def blocks(scene, limit=SCENE_LIMIT):
    """The whole design as {title: configurations}; `limit`: cycles of a scene's run."""
    return {
        "synthetic: networks x buffer depth x M x recovery x seeds": main_block(SYNTHETIC, LIMIT),
        f"{scene}: networks x buffer depth x M x recovery x seeds": main_block(scene, limit),
        "synthetic: free slots": free_block(SYNTHETIC, LIMIT),
        f"{scene}: free slots": free_block(scene, limit),
        "synthetic: array size": size_block(),
        "synthetic: to the verdict, without a limit of cycles": full_block(),
    }


def quick_blocks(scene):
    """A dozen tiny runs that fill every part of the report."""
    synthetic = [limited(SYNTHETIC, 12, 30_000, networks=networks, ray_store=m, recovery=recovery)
                 for networks in ["shared", "half"] for m in [1, 8] for recovery in ["none", "postpone"]]
    scenes = [limited(scene, 12, 60_000, networks=networks, ray_store=8, recovery=recovery)
              for networks in ["shared", "half"] for recovery in ["none", "postpone"]]
    return {"synthetic": synthetic, scene: scenes}


def runs_of(design):
    """Each configuration once, in the order of the design."""
    return list(dict.fromkeys(c for configurations in design.values() for c in configurations))


def cost(configuration):
    """Rough processor seconds of a run, to start the long ones first and to say how long the rest will take."""
    c = configuration
    size = (c.cells / CELLS) ** 2
    if not c.max_cycles:
        return 4.0 if c.ray_store == 1 else 0.3
    starved = c.recovery == "postpone" and (c.ray_store == 1 or (c.networks == "shared" and not c.synthetic))
    if c.synthetic:
        return 0.05 + size * (3.5 if starved else 1.0 if c.ray_store == 2 else 0.7)
    return 0.2 + size * (2.0 if starved else 0.8)
