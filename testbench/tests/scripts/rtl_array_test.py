#!/usr/bin/python3
"""RTL cells in the running array: rtl_array_test.py same|contended|whole|faults SOURCE BUILD

`same`: with four RTL cells, which load themselves or take over after loading, a run has the hashes, the cycles and the statistics of
the model's cells alone. `whole`: so has one with four whole RTL cells, which have voxels. `contended`: the same where buffers of one message and narrow links make rays wait for each other. `faults`:
errors that are put into the RTL cells are named, or the hash of the schedule shows them."""
import json
import pathlib
import re
import shutil
import subprocess
import sys

RUNS = {
    "same": ["facing_mirrors.nff"],
    "whole": ["cornell.nff"],
    "contended": ["still_life.nff", "--hit", "depth", "--viewer", "infinity", "--buffer", "1", "--link-bits", "4", "--traversal-units", "1",
                  "--ray-store", "5"],
}
CELLS = {"same": ["--rtl", "0..1,0..1"], "whole": ["--rtl", "11..12,11..12", "--whole"],
         "contended": ["--rtl", "16..17,8", "--rtl", "17..18,11"]}
# Number in raycell_numbers.sv: its name and what is said of it; None: the hash alone shows it.
FAULTS = {1: ("rounding", r"cell \(\d+, \d+\), cycle \d+: .*field '"),
          3: ("credit", r"cell \(\d+, \d+\), cycle \d+: output .*the far buffer is full"),
          5: ("order by age", r"cell \(\d+, \d+\), cycle \d+: .* waits, though its way to .* is free"),
          6: ("turn", None),
          9: ("wires", r"cell \(\d+, \d+\), cycle \d+: output .*the wires are busy")}
NOT_COMPARED = ("program", "wall", "memory", "host", "seconds", "config", "per_second", "activations", "ranks", "model")


def call(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def words_of(case, source):
    scene, *options = RUNS[case]
    return [source / "scenes" / scene, "--cells", "24x24", "--quiet", *options]


def pure(case, source, build, folder):
    code, text = call(build / "raycell", "render", *words_of(case, source), "-o", folder / "pure")
    if code != 0:
        sys.exit(f"the model's run: code {code}\n{text}")


def with_rtl(case, source, build, folder, *more):
    faults_too = [] if case == "whole" else ["--faults"]
    return call(source / "testbench/rtl/render.py", "--program", build / "rtl_tb", "--work", build / "rtl", "--optimise=-O0", *faults_too,
                *words_of(case, source), *CELLS[case], *more, "-o", folder / "rtl")


def report(path):
    full = json.loads(path.with_suffix(".json").read_text())
    return {key: value for key, value in full.items() if key not in NOT_COMPARED}


def differences(folder):
    """Names of what is not the same in the two runs."""
    found = []
    one, other = report(folder / "pure"), report(folder / "rtl")
    for key in sorted(set(one) | set(other)):
        if one.get(key) != other.get(key):
            found.append(f"{key}: {one.get(key)} and {other.get(key)}"[:300])
    for ending in (".cells.csv", ".exr"):
        if (folder / f"pure{ending}").read_bytes() != (folder / f"rtl{ending}").read_bytes():
            found.append(ending)
    return found


def same(case, source, build, folder):
    pure(case, source, build, folder)
    failures = 0
    for start in ("load",) if case == "whole" else ("load", "trace"):
        code, text = with_rtl(case, source, build, folder, "--rtl-from", start)
        found = differences(folder) if code == 0 else [f"code {code}: {text[-1000:]}"]
        failures += bool(found)
        print(f"--rtl-from {start}: {'the same' if not found else found}")
    return failures


def faults(source, build, folder):
    failures = 0
    pure("contended", source, build, folder)
    for number, (name, expected) in FAULTS.items():
        code, text = with_rtl("contended", source, build, folder, "--rtl-fault", number)
        said = re.search(expected or "$^", text)
        hashes = code == 0 and any("hash" in line for line in differences(folder))
        fine = said if expected else hashes
        failures += not fine
        print(f"{'found' if fine else 'MISSED'}: {name}: code {code}: {said.group(0) if said else text[-300:]}")
    return failures


def main(case, source, build):
    source, build = pathlib.Path(source), pathlib.Path(build)
    folder = build / f"rtl-array-{case}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return 1 if (faults(source, build, folder) if case == "faults" else same(case, source, build, folder)) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
