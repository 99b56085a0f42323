"""Which runs the accuracy sweep makes: one factor at a time about the default, and the full products that matter."""
import dataclasses

RUNGS = ["edge", "mask", "plane", "interval", "depth"]
SHADOWS = ["per-hit", "precast", "memo"]
SCENES = ["teapot-s4", "balls-s2", "mount-s4", "gears-s1"]
OPERATOR_SCENES = ["teapot-s4", "gears-s1"]  # curved with highlights; refracting
FLAT_SCENES = ["tetra-s4"]  # only polygons, few cells: untimed, for the word length
OWN_SCENES = ["still_life", "cornell"]  # the project's own, for --quick
WORD_BITS = range(8, 33)
FRONT_BITS = [10, 12, 16, 20]
SPLIT_BITS = [8, 10, 12, 14, 16, 20, 24, 32]
DEPTHS = [64, 256, 1024, 4096]
FRONT_CELLS, FULL_CELLS = 64, 128
SIZES = [32, 64, 128, 256]
TABLE_SIZES = [16, 32, 64, 128, 256]
SIZES_AT_20_BITS = {"reciprocal": 64, "root": 64, "power": 32}  # the program's own defaults


@dataclasses.dataclass(frozen=True)
class Configuration:
    """What the sweep varies of all that the picture depends on. The defaults are the program's, but for the array."""

    scene: str
    cells: int = FULL_CELLS
    hit: str = "edge"
    normals: str = "linear"
    shadows: str = "per-hit"
    arithmetic: str = "fixed"
    word_bits: int = 20
    depth: int = 1024
    rounding: str = "nearest"
    reciprocal: str = "newton"
    root: str = "newton"
    power: str = "tables"
    reciprocal_table: int = 0  # 0: what the word length needs
    root_table: int = 0
    power_table: int = 0

    def operators(self):
        """The number settings that differ from the default, as (name, value)."""
        names = ["rounding", "reciprocal", "root", "power", "reciprocal_table", "root_table", "power_table"]
        default = Configuration(self.scene)
        return [(name, getattr(self, name)) for name in names if getattr(self, name) != getattr(default, name)]

    def label(self):
        numbers = "exact" if self.arithmetic == "exact" else f"{self.word_bits}bits"
        parts = [self.scene, f"{self.cells}x{self.cells}", self.hit, self.normals, self.shadows, numbers,
                 f"depth{self.depth}", *(f"{name.replace('_', '-')}-{value}" for name, value in self.operators())]
        return ".".join(parts)

    def exact(self):
        """The same machine in exact arithmetic, which loses by discretisation alone."""
        return Configuration(self.scene, self.cells, self.hit, self.normals, self.shadows, "exact", depth=self.depth)

    def options(self):
        words = ["--cells", f"{self.cells}x{self.cells}"]
        for field in dataclasses.fields(self)[2:]:
            words += ["--" + field.name.replace("_", "-"), str(getattr(self, field.name))]
        return words


def operator_variants(scene, cells):
    """One factor at a time: methods, the sizes of the tables where the method is the table, the rounding."""
    def at(**factors):
        return Configuration(scene, cells, **factors)

    variants = [at()]
    for method in ["table", "rounded"]:
        variants += [at(reciprocal=method), at(root=method)]
    variants += [at(power=method) for method in ["schlick", "rounded"]]
    for size in TABLE_SIZES:
        sized = {"reciprocal": at(reciprocal="table", reciprocal_table=size),
                 "root": at(root="table", root_table=size), "power": at(power_table=size)}
        variants += [variant for operator, variant in sized.items() if size != SIZES_AT_20_BITS[operator]]
    return variants + [at(rounding="truncate")]


def front(scene):
    """Hit test x word bits x shadows, and hit test x normals x shadows at 20 bits: timed, a quarter of the cells."""
    runs = [Configuration(scene, FRONT_CELLS, hit, "linear", shadows, word_bits=bits)
            for hit in RUNGS for shadows in SHADOWS for bits in FRONT_BITS]
    return runs + [Configuration(scene, FRONT_CELLS, hit, "voxel", shadows) for hit in RUNGS for shadows in SHADOWS]


def full_size(scene):
    """The main points again at 128x128, timed, to show what the smaller array says about the larger one."""
    return [Configuration(scene, hit=hit) for hit in ["edge", "mask", "depth"]]


def blocks():
    """The whole design as {title: (timed, configurations)}."""
    depths = [Configuration(s, FRONT_CELLS, hit, depth=depth) for s in SCENES for hit in RUNGS for depth in DEPTHS]
    sizes = [Configuration(s, cells, hit) for s in SCENES for hit in RUNGS for cells in SIZES]
    words = [Configuration(s, hit=hit, word_bits=bits) for s in SCENES + FLAT_SCENES for hit in ["edge", "mask"]
             for bits in WORD_BITS]
    rungs = [Configuration(s, hit=hit, word_bits=bits) for s in SCENES for hit in RUNGS[2:] for bits in SPLIT_BITS]
    return {
        "hit test x word bits x shadows, hit test x normals x shadows": (True, [c for s in SCENES for c in front(s)]),
        "hit test at 128x128": (True, [c for s in SCENES for c in full_size(s)]),
        "operators, rounding": (True, [c for s in OPERATOR_SCENES for c in operator_variants(s, FRONT_CELLS)]),
        "hit test x depth levels": (False, depths),
        "every word length at edge and mask": (False, words),
        "word length at the other rungs": (False, rungs),
        "hit test x array size": (False, sizes),
    }


def quick_blocks():
    """A dozen small runs of the project's own scenes that fill every part of the report."""
    cells = 24
    timed = [Configuration(s, cells, hit, shadows=shadows) for s in OWN_SCENES for hit in ["edge", "depth"]
             for shadows in ["per-hit", "memo"]]
    untimed = [Configuration(s, cells, hit, word_bits=bits) for s in OWN_SCENES for hit in ["edge", "mask"]
               for bits in [12, 32]]
    return {"timed": (True, timed), "untimed": (False, untimed)}


def runs_of(design):
    """{configuration: timed}: each configuration once, with its machine in exact arithmetic."""
    runs = {}
    for timed, configurations in design.values():
        for configuration in configurations:
            runs.setdefault(configuration.exact(), False)
            runs[configuration] = runs.get(configuration, False) or timed
    return runs


def cost(configuration, timed):
    """Rough seconds of a run, to start the long ones first and to say how long the rest will take."""
    size = configuration.cells / FULL_CELLS
    if not timed:
        return 0.2 + 0.4 * size ** 2
    seconds = {"teapot-s4": 14, "balls-s2": 17, "mount-s4": 14, "gears-s1": 36}.get(configuration.scene, 12)
    precast = 3.5 if configuration.scene == "balls-s2" else 1.5
    return 0.3 + seconds * size ** 3 * (precast if configuration.shadows == "precast" else 1)
