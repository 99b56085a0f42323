#!/usr/bin/python3
"""The SystemVerilog cell against golden vectors: rtl_test.py scenarios|runs|contended|faults SOURCE BUILD

`scenarios`: those of cell_tb that need no voxels. `runs`: cells of real runs in which no voxel lies. `contended`: such cells where
buffers of one message and narrow links make rays wait for each other. `faults`: errors that
are put into the cell on purpose are found by the vectors, and named by cycle and field."""
import pathlib
import re
import shutil
import subprocess
import sys

WHEN = r"cycle \d+: .*(field '|expected in cycle|it did not do)"
# Number in raycell_numbers.sv: its name, the records that find it, what the first difference has to say. Of the errors that are
# not here (leaving just at a face, back-off) these records tell nothing.
FAULTS = {
    1: ("rounding", "runs", r"cycle \d+: out .* field '"),
    2: ("tie", "runs", WHEN),
    3: ("credit", "scenarios", WHEN),
    4: ("age", "scenarios", WHEN),
    5: ("order by age", "contended", WHEN),
    6: ("turn", "contended", WHEN),
    7: ("route", "scenarios", WHEN),
    9: ("wires", "runs", WHEN),
}
# Of other machines, which would take a verilated cell each.
OTHER_MACHINES = ("back_outside", "front_outside", "busy_wires", "two_units")
LEAST = {"scenarios": 20, "runs": 40, "contended": 100}
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


def replay(source, build, records, *options):
    return call(source / "testbench/rtl/replay.py", "--kit", build / "rtl_kit", "--work", build / "rtl",
                "--leave-out-voxels", *options, *records)


def compared(case, source, build):
    records = records_of(case, source, build, build / f"rtl-{case}")
    code, text = replay(source, build, records, "--faults")  # the cell that `faults` needs, too: built once
    print(text)
    replayed = sum(int(n) for n in re.findall(r"(\d+) records, 0 with differences", text))
    if code != 0 or replayed < LEAST[case]:
        sys.exit(f"code {code}, {replayed} records without a difference; expected code 0 and {LEAST[case]} at least")


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


def main(case, source, build):
    source, build = pathlib.Path(source), pathlib.Path(build)
    if case == "faults":
        return 1 if found(source, build) else 0
    compared(case, source, build)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
