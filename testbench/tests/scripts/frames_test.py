#!/usr/bin/python3
"""usage: frames_test.py pictures|schedule|refusals|sets RAYCELL SCENES

`raycell render --frames` from outside. `pictures`: each frame is the run of that view alone. `schedule`: cycles in a
row against a calculation of its own. `refusals`: wrong lists and options. `sets`: files all or none, verdicts, an older row.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

VIEWS = [((0, 1, 4), 36.86), ((0.3, 1.1, 3.7), 38), ((-0.2, 0.9, 3.9), 40)]


class Row:
    """A folder in which rows of frames are run."""

    def __init__(self, program, scenes, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.scene = pathlib.Path(scenes) / "cornell.nff"
        (self.folder / "out").mkdir()

    def run(self, *words, exit_code=0):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode == exit_code, (words, done.returncode, done.stdout, done.stderr)
        return done

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def row(self, text, *words, name="row", exit_code=0):
        """Runs a list of frames; returns the report."""
        self.write("list.frames", text)
        self.run("render", str(self.scene), "--frames", "list.frames", "--quiet", "-o", f"out/{name}", "--cells", "12x12",
                 *words, exit_code=exit_code)
        return self.json(f"{name}.json")

    def json(self, name):
        return json.loads((self.folder / "out" / name).read_text())

    def files(self):
        return sorted(path.name for path in (self.folder / "out").iterdir())


def line_of(place, angle):
    return f"from {place[0]} {place[1]} {place[2]} angle {angle}"


def scene_of(row, place, angle):
    """The text of the scene with another view, which no reader of lists has seen."""
    text = re.sub(r"^from .*$", f"from {place[0]} {place[1]} {place[2]}", row.scene.read_text(), flags=re.M)
    return re.sub(r"^angle .*$", f"angle {angle}", text, flags=re.M)


def pictures(row):
    other = scene_of(row, (0, 1, 5), 30).replace("0.76 0.75 0.70", "0.1 0.9 0.3", 1)
    row.write("other.nff", other)
    lines = [line_of(*view) for view in VIEWS] + ["scene other.nff", "angle 33 scene other.nff  # both"]
    alone = [scene_of(row, *view) for view in VIEWS] + [other, re.sub("angle 30", "angle 33", other)]
    report = row.row("# a comment\n\n" + "\n".join(lines) + "\n", "--jobs", "2")
    again = row.row("\r\n".join(lines), "--engine", "untimed", name="untimed")
    assert again["frames"]["schedule"] is None and again["verdict"] == "completed"
    assert report["frames"]["count"] == len(lines) == len(report["frames"]["each"])
    hashes = set()
    for i, text in enumerate(alone):
        row.write("alone.nff", text)
        row.run("render", "alone.nff", "--quiet", "--cells", "12x12", "-o", "out/alone")
        single, frame = row.json("alone.json"), row.json(f"row.{i + 1:04}.json")
        for key in ("hash", "cycles", "voxels", "second_store_bits"):
            assert single[key] == frame[key], (i, key)
        for suffix in ("exr", "png"):
            name = f"{i + 1:04}.{suffix}"
            there = (row.folder / f"out/row.{name}").read_bytes()
            assert there == (row.folder / f"out/alone.{suffix}").read_bytes(), name
            assert suffix == "exr" or there == (row.folder / f"out/untimed.{name}").read_bytes(), name
        assert report["frames"]["each"][i]["hash"] == single["hash"]
        assert again["frames"]["each"][i]["hash"]["image"] == single["hash"]["image"]
        hashes.add(single["hash"]["image"])
    assert len(hashes) == len(lines), "frames that differ"
    # A frame alone, by its number; and again from the configuration that the row wrote of it.
    one = ("--frames", "list.frames", "--cells", "12x12", "--quiet")
    row.run("render", str(row.scene), *one, "--frame", "2", "-o", "out/second")
    assert row.json("second.json")["hash"] == row.json("row.0002.json")["hash"]
    config = row.json("row.0002.json")["config"]
    assert config["output"] == "out/row.0002" and config["frame"] == 2, config
    row.run("render", "--config", "out/row.0002.toml", "-o", "out/repeated", "--quiet")
    assert row.json("repeated.json")["hash"] == row.json("row.0002.json")["hash"]
    row.run("render", "--config", "out/row.toml", "-o", "out/whole", "--quiet")
    whole = row.json("whole.json")
    assert whole["frames"] == report["frames"]
    row.run("truth", str(row.scene), *one, "--frame", "4", "-o", "out/truth")
    row.run("sweep", str(row.scene), *one, "--frame", "1..3", "-o", "out/s")


def simulated(frames):
    """Cycles in which frames (load, trace) are done: a loader and a tracer that hand two stores to each other."""
    free, waiting, done = [0, 0], [], []  # when stores are free; when loaded frames are ready
    loader = tracer = 0
    for load, trace in frames:
        store = min(free)
        free.remove(store)
        loader = max(loader, store) + load
        waiting.append(loader)
        tracer = max(tracer, waiting.pop(0)) + trace
        done.append(tracer)
        free.append(tracer)
    return done


def check_schedule(report, clock_mhz=20):
    each, schedule = report["frames"]["each"], report["frames"]["schedule"]
    cycles = [(f["cycles"]["load"], f["cycles"]["precast"] + f["cycles"]["trace"]) for f in each]
    done = simulated(cycles)
    assert [f["in_a_row"]["done"] for f in each] == done
    for frame, (load, trace) in zip(each, cycles):
        times = frame["in_a_row"]
        assert times["load_ends"] - times["load_begins"] == load and times["done"] - times["trace_begins"] == trace
    assert schedule["first_frame_cycles"] == done[0] == sum(cycles[0]) and schedule["total_cycles"] == done[-1]
    many = simulated(cycles * 50)
    n = len(cycles)
    steady = (many[-1] - many[-1 - 10 * n]) / (10 * n)
    assert abs(schedule["cycles_per_frame"] - steady) < 1e-6, (schedule, steady)
    assert abs(schedule["frames_per_second"] * steady / (clock_mhz * 1e6) - 1) < 1e-9
    assert abs(schedule["one_store"]["cycles_per_frame"] - sum(map(sum, cycles)) / n) < 1e-6
    loads, traces = sum(c[0] for c in cycles), sum(c[1] for c in cycles)
    assert schedule["binds"] == ("load" if loads > traces else "trace")
    assert abs(schedule["utilisation"]["load"] - loads / n / steady) < 1e-9
    assert abs(schedule["utilisation"]["trace"] - traces / n / steady) < 1e-9
    bits = report["frames"]["second_store_bits"]
    assert bits["store"] >= max(f["voxels"]["max_bits_per_cell"] for f in each)
    assert bits["total"] == sum(bits[part] for part in ("store", "buffer", "output", "control", "latches"))
    return schedule


def schedule(row):
    views = "\n".join(line_of(*view) for view in VIEWS)
    loaded = check_schedule(row.row(views, "--cost", "load_edge=30000"))
    assert loaded["binds"] == "load" and loaded["frames_bound_by_load"] == 3, loaded
    traced = check_schedule(row.row(views, "--cost", "load_edge=10", "--exterior-latency", "20000", "--clock-mhz", "50"), 50)
    assert traced["binds"] == "trace" and traced["frames_bound_by_load"] == 0, traced
    one = check_schedule(row.row(line_of(*VIEWS[0]), "--shadows", "precast"))
    assert one["total_cycles"] == one["first_frame_cycles"] == one["one_store"]["cycles_per_frame"]
    load_alone = check_schedule(row.row(views, "--stage", "load"))
    assert load_alone["utilisation"]["trace"] == 0


def refusals(row):
    def refused(text, part, *words):
        row.write("list.frames", text)
        done = row.run("render", str(row.scene), "--frames", "list.frames", "--quiet", "--cells", "6x6", "-o", "out/row",
                       *words, exit_code=1)
        assert part in done.stderr and done.stderr.count("\n") == 1, done.stderr
        assert row.files() == [], row.files()

    refused("", "list.frames: no frames; expected a frame a line")
    refused("# nothing\n\n", "no frames")
    refused("from 0 1 4\nform 1 2 3\n", "list.frames:2: unknown word 'form'; expected from x y z")
    refused("from 0 1\n", "list.frames:1: 'from' is followed by ''; expected three numbers")
    refused("from 0 1 x\n", "'from' is followed by 'x'")
    refused("from 0 1 nan\n", "'from' is followed by 'nan'")
    refused("angle 40 angle 50\n", "'angle' comes twice")
    refused("scene\n", "'scene' has no file")
    refused("from 0 1 4\nangle 190\n", "list.frames:2: 'angle' of the view is out of range")
    refused("from 0 1 0\n", "list.frames:1: 'from' and 'at' of the view coincide")
    refused("up 0 0 1\n", "list.frames:1: 'up' of the view is parallel")
    refused("from 0 1 4\nscene nothing.nff\n", "nothing.nff")
    refused("from 0 1 4\n", "--frame 2: list.frames has no such frame; expected --frame from 1 to 1", "--frame", "2")
    for words in (("--probe", "1,1"), ("--golden", "1,1"), ("--vcd-on-deadlock",), ("--save-array", "out/a"),
                  ("--watch-pixel", "1,1")):
        refused("from 0 1 4\n", f"{words[0]}: it is for one frame of --frames; expected --frame K", *words)
    done = row.run("render", str(row.scene), "--frame", "1", "-o", "out/row", exit_code=1)
    assert "expected --frames FILE" in done.stderr, done.stderr
    done = row.run("truth", str(row.scene), "--frames", "list.frames", "-o", "out/row", exit_code=1)
    assert "expected --frame from 1 to 1" in done.stderr, done.stderr
    done = row.run("sweep", str(row.scene), "--frames", "list.frames", "-o", "out/row", exit_code=1)
    assert "expected --frame K" in done.stderr, done.stderr
    done = row.run("render", str(row.scene), "--frames", "nothing.frames", "-o", "out/row", exit_code=1)
    assert "nothing.frames" in done.stderr, done.stderr
    # A frame's scene is not overwritten.
    (row.folder / "own.0001.json").write_text(row.scene.read_text())
    (row.folder / "own.nff").symlink_to("own.0001.json")
    row.write("list.frames", "scene own.nff\n")
    done = row.run("render", "--frames", "list.frames", "--cells", "6x6", "-o", "own", exit_code=1)
    assert "own.0001.json: it would be overwritten, but is the run's scene" in done.stderr, done.stderr


def sets(row):
    views = [line_of(*view) for view in VIEWS]
    row.row("\n".join(views))
    three = [f"row.{i:04}.{s}" for i in (1, 2, 3) for s in ("cells.csv", "exr", "json", "png", "toml")]
    usual = [name for name in row.files() if not name.endswith("ledger.csv")]
    assert usual == sorted(three + ["row.json", "row.toml"]), usual
    before = {name: (row.folder / "out" / name).read_bytes() for name in row.files()}
    row.row("\n".join(views), "--jobs", "1")
    for name in three:
        if name.endswith((".exr", ".png", ".toml", ".csv")):
            assert (row.folder / "out" / name).read_bytes() == before[name], name
    # A shorter row takes the files of the longer one away.
    row.row(views[0])
    left = [name for name in row.files() if not name.endswith("ledger.csv")]
    assert left == sorted(three[:5] + ["row.json", "row.toml"]), left
    # The worst frame's verdict; no schedule for a row that never ends. A frame that fails leaves no file.
    report = row.row("\n".join(views), "--max-cycles", "3000", name="short", exit_code=4)
    assert report["verdict"] == "cycle_limit" and report["frames"]["schedule"] is None
    full = row.row("\n".join(views), "--voxel-capacity", "2", name="full", exit_code=4)
    assert full["verdict"] == "capacity" and check_schedule(full)
    kept = {name: (row.folder / "out" / name).read_bytes() for name in row.files()}
    row.write("bad.nff", row.scene.read_text().replace("p 4", "p 5", 1))
    row.write("list.frames", views[0] + "\nscene bad.nff\n")
    row.run("render", str(row.scene), "--frames", "list.frames", "--cells", "6x6", "-o", "out/row", exit_code=1)
    assert {name: (row.folder / "out" / name).read_bytes() for name in row.files()} == kept
    row.write("list.frames", views[0] + "\n" + views[1] + "\n")
    told = row.run("render", str(row.scene), "--frames", "list.frames", "--cells", "6x6", "--preset", "paper",
                   "--shadows", "per-hit", "--cells", "16x16", "-o", "out/locked", exit_code=3)
    assert "verdict deadlock; 2 frames" in told.stdout and "frame 1" in told.stderr, (told.stdout, told.stderr)
    assert not [name for name in row.files() if "part" in name], row.files()
    # A signal ends the row and its frames; nothing of them is left.
    kept = row.files()
    child = subprocess.Popen([row.program, "render", str(row.scene), "--frames", "list.frames", "--cells", "96x96", "-o",
                              "out/ended"], cwd=row.folder, stderr=subprocess.PIPE, text=True)
    while not list((row.folder / "out").glob("ended.frames.part*/0001*")) and child.poll() is None:
        time.sleep(0.01)
    child.terminate()
    said = child.communicate()[1]
    assert child.returncode == 5 and "interrupted; no files were written" in said, (child.returncode, said)
    assert row.files() == kept, row.files()


def main(case, program, scenes):
    with tempfile.TemporaryDirectory(prefix="raycell_frames_") as folder:
        {"pictures": pictures, "schedule": schedule, "refusals": refusals, "sets": sets}[case](Row(program, scenes, folder))


main(*sys.argv[1:])
