#!/usr/bin/python3
"""Replays golden vectors with the SystemVerilog cell, verilated.

    testbench/rtl/replay.py [--kit build/rtl_kit] [--work build/rtl] RECORD.txt ...

Records of one machine share a verilated cell; it is kept in the work folder until the cell or its package
changes. Code 0: no difference; 2: some, named by record, cycle and field; 1: a wrong file, or no Verilator."""

import argparse
import hashlib
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PACKAGES = ["raycell_numbers.sv", "raycell_cell.sv"]        # in the order in which they need each other
BENCH = ["replay_main.cpp", "hex_record.cpp", "verilated_cell.cpp", "coverage.cpp"]
MACHINE, HEADER = "raycell_pkg.sv", "raycell_rtl.hpp"


class Failed(Exception):
    pass


def sources():
    folder = os.path.join(HERE, "sv", "cell")
    units = sorted(name for name in os.listdir(folder) if name.endswith(".sv") and name not in PACKAGES)
    return [os.path.join(folder, name) for name in ["waivers.vlt"] + PACKAGES + units]


def run(command, log=None, **options):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0 and log is None:
        raise Failed(f"{os.path.basename(command[0])}: code {done.returncode}\n{done.stdout[-3000:]}")
    return done


def package_of(kit, record, work):
    """The machine's package, the benches' header, and the record's line for the replay."""
    package, header = os.path.join(work, MACHINE), os.path.join(work, HEADER)
    line = run([kit, record, "--package", package, "--header", header, "--setup"]).stdout
    with open(package, encoding="utf-8") as text, open(header, encoding="utf-8") as other:
        return text.read(), other.read(), line


def key_of(package, faults, optimise):
    digest = hashlib.sha256((package + str(faults) + optimise).encode())
    for path in sources() + [os.path.join(HERE, "bench", name) for name in sorted(os.listdir(HERE + "/bench"))]:
        with open(path, "rb") as text:
            digest.update(text.read())
    return digest.hexdigest()[:16]


def verilated(package, header, options):
    """The replay program of a machine, built if it is not there."""
    folder = os.path.join(options.work, key_of(package, options.faults, options.optimise))
    program = os.path.join(folder, "obj", "rtl_replay")
    if os.path.exists(program):
        return program
    os.makedirs(folder, exist_ok=True)
    for name, text in ((MACHINE, package), (HEADER, header)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    lint = [options.verilator, "--lint-only", "-Wall", "--top-module", "empty_cell", os.path.join(folder, MACHINE)]
    silent = run(lint + sources()).stdout
    if silent.strip():
        raise Failed(f"verilator --lint-only -Wall is not silent:\n{silent}")
    command = [options.verilator, "--cc", "--exe", "--build", "-j", "1", "-O3", "--unroll-count", "4",
               "--x-assign", "0", "--top-module", "empty_cell", "--Mdir", os.path.join(folder, "obj"),
               "-CFLAGS", f"-std=c++17 {options.optimise} -I{SOURCE} -I{folder}" + (" -DRTL_FAULTS" * options.faults),
               os.path.join(folder, MACHINE)]
    command += sources() + [os.path.join(HERE, "bench", name) for name in BENCH] + ["-o", "rtl_replay"]
    if options.faults:
        command.append("+define+RTL_FAULTS")
    environment = dict(os.environ)
    if any(os.access(os.path.join(path, "ccache"), os.X_OK) for path in environment["PATH"].split(":")):
        environment.setdefault("OBJCACHE", "ccache")
    run(command, env=environment)
    return program


def has_span(record):
    """Whether a span begins in the record's cell: it would be tried as a voxel, which this cell can't do."""
    column = None
    with open(record, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if words[0] == "cell":
                column = words[1]
            if len(words) > 8 and words[1] == "in" and words[6] == "span" and words[8] == column:
                return True
    return False


def groups(options):
    """Records by the machine that they are of."""
    found = {}
    for record in options.records:
        if options.leave_out_voxels and has_span(record):
            continue
        package, header, line = package_of(options.kit, record, options.work)
        found.setdefault((package, header), []).append(line)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", metavar="RECORD.txt", help="golden vectors, their .hex files beside them")
    parser.add_argument("--kit", default=os.path.join(SOURCE, "build", "rtl_kit"), help="rtl_kit")
    parser.add_argument("--work", default=os.path.join(SOURCE, "build", "rtl"), help="folder of the verilated cells")
    parser.add_argument("--verilator", default="verilator", help="Verilator")
    parser.add_argument("--optimise", default="-O0", help="of the C++ compiler; -O0 is ready soonest")
    parser.add_argument("--coverage", action="store_true", help="print what the records made the cell do")
    parser.add_argument("--leave-out-voxels", action="store_true",
                        help="leave out records in whose cell a span begins, instead of failing at it")
    parser.add_argument("--every-cycle", action="store_true", help="run cycles in which the cell is idle, too")
    parser.add_argument("--faults", action="store_true", help="build a cell that errors can be put into")
    parser.add_argument("--fault", type=int, action="append",
                        help="put this error in, with --faults (raycell_numbers.sv); several: a replay for each")
    options = parser.parse_args()
    options.work = os.path.abspath(options.work)
    os.makedirs(options.work, exist_ok=True)
    code = 0
    found = groups(options)
    left_out = len(options.records) - sum(len(lines) for lines in found.values())
    if left_out:
        print(f"{left_out} records left out: a span begins in their cells")
    for (package, header), lines in found.items():
        command = [verilated(package, header, options)]
        command += ["--coverage"] * options.coverage + ["--every-cycle"] * options.every_cycle
        for fault in options.fault or [0]:
            if fault:
                print(f"fault {fault}")
            done = run(command + ["--fault", str(fault)], log=True, input="".join(lines))
            print(done.stdout, end="")
            if done.returncode not in (0, 2):
                raise Failed(f"rtl_replay: code {done.returncode}")
            code = max(code, done.returncode)
    return code


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as error:
        print(f"replay.py: {error}", file=sys.stderr)
        sys.exit(1)
