#!/usr/bin/python3
"""Runs pinned configurations and compares their hashes, cycles and files with those written down.

    check_pins.py PROGRAM_FOLDER            all cases
    check_pins.py PROGRAM_FOLDER NAME ...   some of them
    check_pins.py PROGRAM_FOLDER --renew    writes down what the programs give now

A pin says that something has changed, not that it is wrong. Who changes it on purpose renews it in the commit that does.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
EXPECTED = HERE / "expected.json"
SCENES = HERE.parent.parent / "scenes"
DIGESTED = (".cells.csv", ".ledger.csv", ".vcd", ".waits.json")
# The parts of the report in whole numbers, which the last bits of a library can't change.
COUNTED = ("stages", "units", "hops", "precast", "rays", "messages", "voxels", "message_bits", "storage_bits", "formats",
           "ray_store", "buffers", "deadlock", "activity", "loading")
# More ranks than cores and running as root must be allowed.
MPIRUN = ["mpirun", "-q", "--oversubscribe", "-np"]
MAY_BE_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def read_cases():
    """{name: words of the command}, in the order of the file."""
    cases = {}
    for line in (HERE / "cases.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            name, command = line.split(":", 1)
            cases[name] = shlex.split(command)
    return cases


def command_of(words, programs, prefix):
    """The command of a case: its words with the paths of programs and scenes."""
    words = [w.replace("SCENES", str(SCENES)) for w in words]
    launcher = []
    if words[0] == "mpirun":
        launcher, words = [*MPIRUN, words[1]], words[2:]
    return [*launcher, str(programs / words[0]), *words[1:], "--quiet", "-o", prefix]


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


def run(words, programs):
    """Runs a case and returns its pin: exit code, verdict, cycles, hashes, digests of its files."""
    with tempfile.TemporaryDirectory(prefix="raycell_pins_") as folder:
        done = subprocess.run(command_of(words, programs, "pin"), cwd=folder, capture_output=True, text=True,
                              env={**os.environ, **MAY_BE_ROOT}, check=False)
        report = pathlib.Path(folder, "pin.json")
        if not report.exists():
            return {"exit_code": done.returncode, "message": done.stderr[:500]}
        results = json.loads(report.read_text())
        pin = {"exit_code": done.returncode, "verdict": results["verdict"]}
        pin["cycles"] = {phase: results["cycles"][phase] for phase in ("load", "precast", "trace")}
        pin["hash"] = results["hash"]
        counted = {key: results[key] for key in COUNTED if key in results}
        pin["report"] = digest(json.dumps(counted, sort_keys=True).encode())
        for suffix in DIGESTED:
            path = pathlib.Path(folder, "pin" + suffix)
            if path.exists():
                pin[suffix[1:]] = digest(path.read_bytes())
        return pin


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("programs", type=pathlib.Path, help="folder of the built programs")
    arguments.add_argument("names", nargs="*", help="cases; all by default")
    arguments.add_argument("--renew", action="store_true", help="write down what the programs give now")
    given = arguments.parse_args()
    cases = read_cases()
    expected = json.loads(EXPECTED.read_text()) if EXPECTED.exists() else {}
    names = given.names or list(cases)
    unknown = [name for name in names if name not in cases]
    if unknown:
        arguments.error("no such case: " + ", ".join(unknown))
    changed = []
    for name in names:
        found = run(cases[name], given.programs.resolve())
        if found != expected.get(name):
            changed.append(name)
            print(f"{name}: {' '.join(cases[name])}\n  expected {json.dumps(expected.get(name))}\n"
                  f"  found    {json.dumps(found)}")
            expected[name] = found
    if given.renew:
        kept = {name: expected[name] for name in cases if name in expected}
        EXPECTED.write_text(json.dumps(kept, indent=1) + "\n")
    print(f"{len(names)} pinned runs, {len(changed)} {'renewed' if given.renew else 'changed'}")
    return 1 if changed and not given.renew else 0


if __name__ == "__main__":
    sys.exit(main())
