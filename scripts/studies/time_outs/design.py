"""Which runs the time-outs are measured in: loads x machines x seeds."""
import dataclasses

CELLS = 32
SEEDS = 20
LIMIT = 1_000_000  # cycles: many times what the slowest run takes to end or to lock
TIME_OUTS = [2 ** log for log in range(4, 21)]  # every run measures all of them

# Traffic by name: hit probability, reflected and refracted share, share of the children that turn back, sources.
LOADS = {
    "light": (0.03, "1", 0.5, 0),
    "default": (0.1, "1", 0.5, 0),
    "dense": (0.3, "1", 0.5, 0),
    "branching": (0.1, "1,0.5", 1, 0),
    "shadows": (0.1, "1", 0.5, 1),
}
LOAD_WORDS = {
    "light": "few hits, long flights", "default": "`deadlock_tb`'s own", "dense": "a hit in 3 of 10 cells",
    "branching": "two children of every other hit, all turn back", "shadows": "a shadow ray of each hit",
}
# Networks, M, recovery. The first two end, the third may end, the others lock.
MACHINES = [("half", 16, "none"), ("half", 4, "postpone"), ("half", 4, "none"), ("half", 2, "none"),
            ("split", 8, "none"), ("shared", 8, "none")]


@dataclasses.dataclass(frozen=True)
class Configuration:
    load: str
    cells: int
    networks: str
    ray_store: int
    recovery: str
    seed: int

    @property
    def machine(self):
        return self.networks, self.ray_store, self.recovery

    def label(self):
        return ".".join([self.load, f"{self.cells}x{self.cells}", self.networks, f"M{self.ray_store}", self.recovery,
                         f"seed{self.seed}"])

    def options(self):
        hit, branching, turn_back, sources = LOADS[self.load]
        return ["--cells", f"{self.cells}x{self.cells}", "--generations", "3", "--directions", "back",
                "--hit-probability", str(hit), "--branching", branching, "--turn-back", str(turn_back),
                "--sources", str(sources), "--networks", self.networks, "--ray-store", str(self.ray_store),
                "--recovery", self.recovery, "--slots", "reserved", "--buffer", "1", "--seed", str(self.seed),
                "--max-cycles", str(LIMIT)]


def name_of(machine):
    networks, ray_store, recovery = machine
    return f"{networks}, M = {ray_store}, {recovery}"


def runs(seeds):
    return [Configuration(load, CELLS, *machine, seed) for load in LOADS for machine in MACHINES
            for seed in range(1, seeds + 1)]


def quick_runs():
    return [Configuration(load, 16, *machine, seed) for load in ["default", "branching"]
            for machine in [MACHINES[1], MACHINES[3], MACHINES[5]] for seed in [1, 2]]


def cost(configuration):
    """Rough processor seconds of a run."""
    return 0.05 + 0.1 * (configuration.cells / CELLS) ** 2
