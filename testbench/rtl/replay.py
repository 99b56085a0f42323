#!/usr/bin/python3
"""Replays golden vectors with the SystemVerilog cell, by Verilator or, with --icarus, by Icarus Verilog.

    testbench/rtl/replay.py [--kit build/rtl_kit] [--work build/rtl] RECORD.txt ...

Records of one machine share a verilated cell; it is kept in the work folder until the cell or its package
changes. Code 0: no difference; 2: some, named by record, cycle and field; 1: a wrong file, or no simulator."""

import argparse
import os
import sys

from icarus import by_icarus
from simulators import HEADER, MACHINE, SOURCE, Failed, add_sizes, machine_in, run, sizes_of, verilated

BENCH = ["bench/replay_main.cpp", "bench/hex_record.cpp", "bench/verilated_cell.cpp", "bench/coverage.cpp"]


def machine_of(record, options):
    """The machine's packages and the benches' header, and the record's line for the replay."""
    work = os.path.join(options.work, "machine")
    os.makedirs(work, exist_ok=True)
    line = run([options.kit, record, "--package", os.path.join(work, MACHINE), "--header", os.path.join(work, HEADER),
                "--setup"] + options.whole * (["--cell", work] + sizes_of(options))).stdout
    return machine_in(work, options.whole), line


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
        machine, line = machine_of(os.path.abspath(record), options)
        found.setdefault(machine, []).append(line)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", metavar="RECORD.txt", help="golden vectors, their .hex files beside them")
    parser.add_argument("--kit", default=os.path.join(SOURCE, "build", "rtl_kit"), help="rtl_kit")
    parser.add_argument("--work", default=os.path.join(SOURCE, "build", "rtl"), help="folder of the verilated cells")
    parser.add_argument("--verilator", default="verilator", help="Verilator")
    parser.add_argument("--icarus", action="store_true", help="by Icarus Verilog (11 was used), which is slow; without coverage")
    parser.add_argument("--optimise", default="-O0", help="of the C++ compiler; -O0 is ready soonest")
    parser.add_argument("--coverage", action="store_true", help="print what the records made the cell do")
    parser.add_argument("--leave-out-voxels", action="store_true",
                        help="leave out records in whose cell a span begins, instead of failing at it")
    add_sizes(parser)
    parser.add_argument("--every-cycle", action="store_true", help="run cycles in which the cell is idle, too")
    parser.add_argument("--faults", action="store_true", help="build a cell that errors can be put into")
    parser.add_argument("--fault", type=int, action="append",
                        help="put this error in, with --faults (raycell_numbers.sv); several: a replay for each")
    options = parser.parse_args()
    if options.icarus and (options.coverage or options.every_cycle or options.whole):
        parser.error("--icarus: expected none of --coverage, --every-cycle, --whole beside it")
    if options.fault and not options.faults:
        parser.error("--fault: expected --faults, too")
    options.work = os.path.abspath(options.work)
    os.makedirs(options.work, exist_ok=True)
    code = 0
    found = groups(options)
    left_out = len(options.records) - sum(len(lines) for lines in found.values())
    if left_out:
        print(f"{left_out} records left out: a span begins in their cells")
    for machine, lines in found.items():
        command = [] if options.icarus else [verilated(machine, options, "rtl_replay", BENCH)]
        command += ["--coverage"] * options.coverage + ["--every-cycle"] * options.every_cycle
        for fault in options.fault or [0]:
            if fault:
                print(f"fault {fault}")
            if options.icarus:
                code = max(code, by_icarus(machine, lines, fault, options))
                continue
            # Microprograms are read from the current folder.
            done = run(command + ["--fault", str(fault)], log=True, input="".join(lines),
                       cwd=os.path.dirname(os.path.dirname(command[0])))
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
