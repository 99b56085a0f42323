#!/usr/bin/python3
"""Runs the shading unit in SystemVerilog over the hits in records of cells of a real run.

Usage: check_shading.py BUILD FOLDER SCENE RUNG WORD_BITS [--cells X0..X1,Y0..Y1] [--array WxH] [--traversal]
                        [-- OPTIONS OF RENDER]

Exit code 0 if every child, intensity, charge and cycle count is that of the model. --traversal: the traversal unit, whose
programs are in the same encoding, too.
"""
import argparse
import glob
import os
import shutil
import sys

from check_vectors import UNITS, build, run

PACKAGES = ["microcode.sv", "visit.sv", "shade.sv"]


def main():
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", help="folder with raycell and cell_tb")
    parser.add_argument("folder", help="where to work; emptied first")
    parser.add_argument("scene")
    parser.add_argument("rung", choices=("interval", "edge"))
    parser.add_argument("word_bits", type=int)
    parser.add_argument("--cells", default="10..13,10..13", help="the cells that are recorded")
    parser.add_argument("--array", default="24x24", help="cells of the array")
    parser.add_argument("--traversal", action="store_true", help="compare the traversal unit as well")
    wanted = parser.parse_args(sys.argv[1:cut])
    programs = os.path.abspath(wanted.build)
    scene = os.path.abspath(wanted.scene)
    shutil.rmtree(wanted.folder, ignore_errors=True)
    os.makedirs(wanted.folder)
    run([f"{programs}/raycell", "render", scene, "--cells", wanted.array, "--hit", wanted.rung, "--word-bits",
         str(wanted.word_bits), "--golden", wanted.cells, "--golden-part", "traversal", "-o", "run", *sys.argv[cut + 1:]],
        wanted.folder)
    records = sorted(os.path.basename(name) for name in glob.glob(os.path.join(wanted.folder, "run.traversal_*.txt")))
    print(run([f"{programs}/cell_tb", "--replay", *records, "--hardware", ".", "--shading"], wanted.folder), end="")
    same = True
    for unit in ["shading"] + ["traversal"] * wanted.traversal:
        run(["verilator", "--lint-only", "-Wall", f"-I{UNITS}", *PACKAGES, os.path.join(UNITS, unit + ".sv"),
             "--top-module", unit], wanted.folder)
        text = run(build(wanted.folder, False, False, unit + "_tb"), wanted.folder)
        print(text, end="")
        same = same and ", 0 differences" in text
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
