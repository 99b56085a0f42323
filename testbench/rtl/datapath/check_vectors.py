#!/usr/bin/python3
"""Runs microprograms on the datapath in SystemVerilog over vectors that microcode_tb writes.

Usage: check_vectors.py MICROCODE_TB FOLDER WORD_BITS [--runs N] [--programs NAMES] [--icarus] [--faults]

Exit code 0 if nothing differs; with --faults, if each of the errors put in on purpose is found.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
UNITS = os.path.join(os.path.dirname(HERE), "sv", "datapath")
FAULTS = {
    1: "never rounds to the nearest",
    2: "rounds ties up, not to even",
    3: "does not saturate",
    4: "loses the carry between the accumulator's halves",
    5: "does not shift by 8 or more into the accumulator",
    6: "takes a part that is not the last one with a sign",
    7: "compares with less or equal",
    8: "saturates one above the least number",
    9: "counts leading zeros of 2 and 3 wrongly",
    10: "takes the next line of a table",
}


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"check_vectors: {command[0]} ended with {done.returncode}, expected 0:\n{done.stdout[-3000:]}")
    return done.stdout


def build(folder, icarus, faults, bench="datapath_tb"):
    """Compiles the test bench and returns the command that runs it."""
    bench_file = os.path.join(HERE, bench + ".sv")
    units = [f"-I{UNITS}"]
    defines = ["-DDATAPATH_FAULTS"] if faults else []
    packages = [name for name in ("raycell_pkg.sv", "microcode.sv", "visit.sv", "shade.sv", "load.sv")
                if os.path.exists(os.path.join(folder, name))]
    if icarus:
        run(["iverilog", "-g2012", *units, f"-y{UNITS}", "-Y.sv", *defines, "-s", bench, "-o", "bench",
             *packages, bench_file], folder)
        return ["vvp", "-n", "bench"]
    run(["verilator", "--lint-only", "-Wall", *units, *defines, "microcode.sv", os.path.join(UNITS, "datapath.sv"),
         "--top-module", "datapath"], folder)
    run(["verilator", "--binary", "--timing", "-O3", "-Wno-fatal", *units, *defines, *packages, bench_file,
         "--top-module", bench, "--Mdir", f"built_{bench}", "-j", "1", "-CFLAGS", "-O1"], folder)
    return [f"built_{bench}/V{bench}"]


def differences(text):
    """The number in the last line of a bench's output."""
    found = re.findall(r"(\d+) differences$", text, re.MULTILINE)
    if not found or "programs," not in text:
        sys.exit("check_vectors: the simulation ended early, expected a line with the number of differences:\n"
                 + text[-1000:])
    return int(found[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("microcode_tb", help="the program")
    parser.add_argument("folder", help="where to work; emptied first")
    parser.add_argument("word_bits", type=int)
    parser.add_argument("--runs", type=int, default=100, help="vectors of each program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--programs", default="", help="these alone, commas between them")
    parser.add_argument("--icarus", action="store_true", help="Icarus Verilog instead of Verilator")
    parser.add_argument("--faults", action="store_true", help="each error put in on purpose must be found")
    wanted = parser.parse_args()
    shutil.rmtree(wanted.folder, ignore_errors=True)
    os.makedirs(wanted.folder)
    print(run([os.path.abspath(wanted.microcode_tb), "--word-bits", str(wanted.word_bits), "--runs", str(wanted.runs),
               "--seed", str(wanted.seed), "--export", ".", *(["--programs", wanted.programs] if wanted.programs else [])],
              wanted.folder), end="")
    simulate = build(wanted.folder, wanted.icarus, wanted.faults)
    if not wanted.faults:
        text = run(simulate, wanted.folder)
        print(text, end="")
        return 1 if differences(text) else 0
    missed = []
    for number, what in FAULTS.items():
        text = run([*simulate, f"+fault={number}"], wanted.folder)
        first = next((line for line in text.splitlines() if "expected" in line), "not found")
        print(f"error {number}, {what}: {differences(text)} differences, the first: {first}")
        if first == "not found":
            missed.append(number)
    print(f"{len(FAULTS) - len(missed)} of {len(FAULTS)} errors found")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
