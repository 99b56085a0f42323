#!/usr/bin/env python3
"""The SystemVerilog cell against golden vectors: rtl_test.py scenarios|runs|faults SOURCE BUILD

`scenarios`: those of cell_tb that need no voxels. `runs`: cells of real runs in which no voxel lies. `faults`: errors that
are put into the cell on purpose are found by the vectors, and named by cycle and field."""
import pathlib
import re
import shutil
import subprocess
import sys

# Number in raycell_numbers.sv: what the first difference has to say.
FAULTS = {
    1: ("rounding", r"cycle \d+: out .* field '"),
    2: ("tie", r"cycle \d+: (out|take) "),
    3: ("credit", r"cycle \d+: (out|take) .*expected in cycle"),
    4: ("age", r"cycle \d+: (out|take) "),
    5: ("order", r"cycle \d+: (out|take) "),
    6: ("turn", r"cycle \d+: (out|take) "),
    7: ("route", r"cycle \d+: (out|take) "),
    9: ("wires", r"cycle \d+: (out|take) .*expected in cycle"),
    10: ("back-off", r"cycle \d+: (out|take) "),
}
# Of these no scenario tells anything: they need runs.
IN_RUNS = {1, 2, 10}
LEAST = {"scenarios": 20, "runs": 40}


def call(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def records_of(case, source, build, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if case == "scenarios":
        code, text = call(build / "cell_tb", "--write", f"{folder}/")
    else:
        code, text = call(build / "raycell", "render", source / "scenes/facing_mirrors.nff", "--cells", "24x24",
                          "--quiet", "--golden", "0..23,0..1", "--golden", "0..23,21..23", "-o", folder / "run")
    if code != 0:
        sys.exit(f"recording: code {code}\n{text}")
    return sorted(folder.glob("*.txt"))


def replay(source, build, records, *options):
    return call(source / "testbench/rtl/replay.py", "--kit", build / "rtl_kit", "--work", build / "rtl",
                "--leave-out-voxels", *options, *records)


def compared(case, source, build):
    records = records_of(case, source, build, build / f"rtl-{case}")
    code, text = replay(source, build, records, *(["--faults"] if case == "scenarios" else []))
    print(text)
    replayed = sum(int(n) for n in re.findall(r"(\d+) records, 0 with differences", text))
    if code != 0 or replayed < LEAST[case]:
        sys.exit(f"code {code}, {replayed} records without a difference; expected code 0 and {LEAST[case]} at least")


def found(source, build):
    failures = 0
    records = {True: records_of("runs", source, build, build / "rtl-faults-runs"),
               False: records_of("scenarios", source, build, build / "rtl-faults-scenarios")}
    for fault, (name, expected) in FAULTS.items():
        code, text = replay(source, build, records[fault in IN_RUNS], "--faults", "--fault", fault)
        first = text.splitlines()[0 if "left out" not in text.splitlines()[0] else 1]
        fine = code == 2 and re.search(expected, first)
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
