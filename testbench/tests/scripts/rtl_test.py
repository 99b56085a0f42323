#!/usr/bin/python3
"""The SystemVerilog cell against golden vectors: rtl_test.py CASE SOURCE BUILD

CASE is `scenarios`: those of cell_tb that need no voxels; `specified`: the same with the cell in Python that is written from the
specification. `runs`: cells of real runs in which no voxel lies. `contended`: such cells where buffers of one message and narrow links
make rays wait for each other. `faults`: errors that are put into the cell on purpose are found by the vectors, and named by cycle and
field. `icarus`: some of the scenarios and of the recorded cells by Icarus Verilog instead of Verilator, and errors there. `whole`, `whole_faults`: the cell with voxels, in a room of mirrors."""
import pathlib
import re
import shutil
import subprocess
import sys

WHEN = r"cycle \d+: .*(field '|expected in cycle|it did not do)"
# Number in raycell_numbers.sv: its name, the records that find it, what the first difference has to say.
FAULTS = {
    1: ("rounding", "runs", r"cycle \d+: out .* field '"),
    2: ("tie", "runs", WHEN),
    3: ("credit", "scenarios", WHEN),
    4: ("age", "scenarios", WHEN),
    5: ("order by age", "contended", WHEN),
    6: ("turn", "contended", WHEN),
    7: ("route", "scenarios", WHEN),
    8: ("leaving just at a face", "scenarios", r"back_reached.txt: cycle \d+: "),
    9: ("wires", "runs", WHEN),
    10: ("back-off", "scenarios", r"own_postponed.txt: cycle \d+: .*expected in cycle"),
}
# Of other machines, which would take a verilated cell each.
OTHER_MACHINES = ("back_outside", "front_outside", "busy_wires", "two_units")
# Short ones: Icarus runs about 600 cycles a second.
BY_ICARUS = ("back_reached", "broadcast", "held_back", "lit", "rays_in_turn", "return", "shadow", "turn")
CELLS_BY_ICARUS = ("run.golden_10_0", "run.golden_13_0")
# The cell with voxels: the cells of the room that are replayed, and what finds each error in which of them.
ROOM = ["--cells", "8x8", "--ray-store", "5", "--max-depth", "3", "--link-bits", "4", "--buffer", "1"]
ROOM_CELLS = ((0, 0), (0, 6), (1, 7), (2, 2), (4, 1), (7, 1))
WHOLE_FAULTS = {
    11: ("reserved slots", (1, 7), WHEN),
    12: ("a hit waits", (1, 7), WHEN),
    13: ("next slot", (4, 1), r"cycle \d+: out .* field 'slot'"),
    14: ("equal ages", (2, 2), WHEN),
    15: ("shading the youngest", (7, 1), WHEN),
    16: ("child's number", (7, 1), r"cycle \d+: out .* field 'child'"),
    17: ("span's offset", (1, 7), r"cycle \d+: out east 0: bits are"),
    18: ("polygon left", (0, 0), WHEN),
    19: ("retry", (0, 6), WHEN),
    20: ("last verdict", (0, 6), WHEN),
    3: ("credit", (0, 0), WHEN),
    5: ("order by age", (0, 6), WHEN),
    6: ("turn", (2, 2), WHEN),
    22: ("rounding of ties in the datapath", (7, 1), r"cycle \d+: out .* field 'z'"),
}
LEAST = {"scenarios": 25, "runs": 40, "contended": 100}
RUNS = {
    "runs": ["facing_mirrors.nff", "--golden", "0..23,0..1", "--golden", "0..23,21..23"],
    "contended": ["still_life.nff", "--golden", "0..23,4..13", "--hit", "depth", "--viewer", "infinity", "--buffer", "1", "--link-bits", "4",
                  "--traversal-units", "1", "--ray-store", "5"],
}


def call(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def records_of(case, source, build, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if case == "scenarios":
        code, text = call(build / "cell_tb", "--write", f"{folder}/")
    else:
        scene, *options = RUNS[case]
        code, text = call(build / "raycell", "render", source / "scenes" / scene, "--cells", "24x24", "--quiet", "-o", folder / "run", *options)
    if code != 0:
        sys.exit(f"recording: code {code}\n{text}")
    return sorted(path for path in folder.glob("*.txt") if path.stem not in OTHER_MACHINES)


def replay(source, build, records, *options, kind="--leave-out-voxels"):
    return call(source / "testbench/rtl/replay.py", "--kit", build / "rtl_kit", "--work", build / "rtl",
                kind, *options, *records)


def compared(case, source, build):
    records = records_of(case, source, build, build / f"rtl-{case}")
    code, text = replay(source, build, records, "--faults")  # the cell that `faults` needs, too: built once
    print(text)
    replayed = sum(int(n) for n in re.findall(r"(\d+) records, 0 with differences", text))
    if code != 0 or replayed < LEAST[case]:
        sys.exit(f"code {code}, {replayed} records without a difference; expected code 0 and {LEAST[case]} at least")


def specified(source, build):
    sys.path.insert(0, str(source / "testbench/rtl"))
    sys.dont_write_bytecode = True
    from replay import has_span
    folder = build / "rtl-specified"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    code, text = call(build / "cell_tb", "--write", f"{folder}/")
    records = sorted(path for path in folder.glob("*.txt") if not has_span(path))
    if code == 0:
        code, text = call(source / "testbench/spec/replay.py", *records)
    print(text)
    if code != 0 or len(records) < LEAST["scenarios"]:
        sys.exit(f"code {code}, {len(records)} records; expected code 0 and {LEAST['scenarios']} records at least")


def found(source, build):
    failures = 0
    for case in LEAST:
        faults = {number: rest for number, rest in FAULTS.items() if rest[1] == case}
        records = records_of(case, source, build, build / f"rtl-faults-{case}")
        options = [word for number in faults for word in ("--fault", number)]
        text = replay(source, build, records, "--faults", *options)[1]
        firsts = dict(re.findall(r"^fault (\d+)\n(.*)$", text, re.M))
        for number, (name, _, expected) in faults.items():
            first = firsts.get(str(number), f"nothing: {text[-500:]}")
            fine = re.search(expected, first)
            failures += not fine
            print(f"{'found' if fine else 'MISSED'}: {name}: {first}")
    return failures


def by_icarus(source, build):
    folder = build / "rtl-icarus"
    for case, names in (("scenarios", BY_ICARUS), ("runs", CELLS_BY_ICARUS)):
        records = [path for path in records_of(case, source, build, folder) if path.stem in names]
        code, text = replay(source, build, records, "--icarus", "--faults")
        print(text)
        if code != 0 or f"{len(names)} records, 0 with differences" not in text:
            sys.exit(f"code {code}; expected code 0 and {len(names)} records without a difference")
        for number, (name, where, expected) in FAULTS.items():
            if where == case and name in ("leaving just at a face", "rounding"):
                text = replay(source, build, records, "--icarus", "--faults", "--fault", number)[1]
                print(text)
                if not re.search(expected, text):
                    sys.exit(f"{name}: expected '{expected}'")


def room(source, build, folder):
    """Records of a room whose walls are mirrors, with two sources."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    text = (source / "scenes/cornell.nff").read_text()
    text = text.replace(" 0.85 0 1 0 1\n", " 0.5 0.4 20 0 1\n").replace("l 0 1.75 0.75\n", "l 0.3 1.75 0.75\nl -0.5 1.5 0.2\n")
    (folder / "room.nff").write_text(text)
    cells = [word for x, y in ROOM_CELLS for word in ("--golden", f"{x}..{x},{y}..{y}")]
    code, text = call(build / "raycell", "render", folder / "room.nff", *ROOM, *cells, "--quiet", "-o", folder / "run")
    if code != 0:
        sys.exit(f"recording: code {code}\n{text}")
    return lambda x, y: folder / f"run.golden_{x}_{y}.txt"


def whole(source, build):
    record = room(source, build, build / "rtl-whole")
    code, text = replay(source, build, [record(*cell) for cell in ROOM_CELLS], "--faults", kind="--whole")
    print(text)
    if code != 0 or f"{len(ROOM_CELLS)} records, 0 with differences" not in text:
        sys.exit(f"code {code}; expected code 0 and no difference in {len(ROOM_CELLS)} records")


def whole_found(source, build):
    record = room(source, build, build / "rtl-whole-faults")
    failures = 0
    for number, (name, cell, expected) in WHOLE_FAULTS.items():
        text = replay(source, build, [record(*cell)], "--faults", "--fault", number, kind="--whole")[1]
        first = (re.findall(rf"^fault {number}\n(.*)$", text, re.M) or [text[-500:]])[0]
        fine = re.search(expected, first)
        failures += not fine
        print(f"{'found' if fine else 'MISSED'}: {name}: {first}")
    return failures


def main(case, source, build):
    source, build = pathlib.Path(source), pathlib.Path(build)
    if case == "faults":
        return 1 if found(source, build) else 0
    if case == "whole_faults":
        return 1 if whole_found(source, build) else 0
    others = {"specified": specified, "icarus": by_icarus, "whole": whole}
    if case in others:
        others[case](source, build)
    else:
        compared(case, source, build)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
