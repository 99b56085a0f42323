#!/usr/bin/python3
"""Renders with RTL cells in the array: raycell render's words, and --rtl X0..X1,Y0..Y1.

    testbench/rtl/render.py SCENE --cells 24x24 --rtl 3..4,0..1 -o out/a

Words that are not of render.py are handed to rtl_tb, which has all of raycell render and --rtl, --rtl-from, --rtl-fault. The cell is
verilated for the machine of these words, as a library; it is kept in the work folder until the cell or the machine changes. The
exit code is rtl_tb's: that of raycell render, or 2 if an RTL cell did what the model would not have done."""

import argparse
import os
import subprocess
import sys
import tempfile

from simulators import HEADER, MACHINE, SOURCE, Failed, add_sizes, machine_in, run, verilated


def library_of(words, options):
    """The library of the cell for the machine that the words of rtl_tb describe."""
    with tempfile.TemporaryDirectory(dir=options.work) as folder:
        units = ["--rtl-units", folder, "--rtl-voxels", str(options.voxels), "--rtl-edges", str(options.edges)]
        run([options.program, *words, "--rtl-package", os.path.join(folder, MACHINE),
             "--rtl-header", os.path.join(folder, HEADER)] + options.whole * units)
        machine = machine_in(folder, options.whole)
    return verilated(machine, options, name="rtl_cell.so", bench=["array/port_cell_library.cpp", "bench/verilated_cell.cpp"],
                     compile_flags="-fPIC", link_flags="-shared")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False,
                                     epilog="All other words go to rtl_tb: see build/rtl_tb render --help.")
    parser.add_argument("--program", default=os.path.join(SOURCE, "build", "rtl_tb"), help="rtl_tb")
    parser.add_argument("--work", default=os.path.join(SOURCE, "build", "rtl"), help="folder of the verilated cells")
    parser.add_argument("--verilator", default="verilator", help="Verilator")
    parser.add_argument("--optimise", default="-O1", help="of the C++ compiler")
    parser.add_argument("--faults", action="store_true", help="build a cell that errors can be put into (--rtl-fault N)")
    add_sizes(parser)
    options, words = parser.parse_known_args()
    options.work = os.path.abspath(options.work)
    os.makedirs(options.work, exist_ok=True)
    if words[:1] != ["render"]:
        words = ["render"] + words
    library = library_of(words, options)
    return subprocess.run([options.program, *words, "--rtl-cell", library], check=False).returncode


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as error:
        print(f"render.py: {error}", file=sys.stderr)
        sys.exit(1)
