#!/usr/bin/python3
"""Runs the traversal unit in SystemVerilog over records of cells of a real run.

Usage: check_traversal.py BUILD FOLDER SCENE RUNG WORD_BITS [--cells X0..X1,Y0..Y1] [--array WxH]

Exit code 0 if every ray's decision, counts, cycles and fields are those of the model.
"""
import argparse
import glob
import os
import shutil
import sys

from check_vectors import UNITS, build, run


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", help="folder with raycell and cell_tb")
    parser.add_argument("folder", help="where to work; emptied first")
    parser.add_argument("scene")
    parser.add_argument("rung", choices=("interval", "edge"))
    parser.add_argument("word_bits", type=int)
    parser.add_argument("--cells", default="10..13,10..13", help="the cells that are recorded")
    parser.add_argument("--array", default="24x24", help="cells of the array")
    wanted = parser.parse_args()
    programs = os.path.abspath(wanted.build)
    scene = os.path.abspath(wanted.scene)
    shutil.rmtree(wanted.folder, ignore_errors=True)
    os.makedirs(wanted.folder)
    run([f"{programs}/raycell", "render", scene, "--cells", wanted.array, "--hit", wanted.rung, "--word-bits",
         str(wanted.word_bits), "--golden", wanted.cells, "--golden-part", "traversal", "-o", "run"], wanted.folder)
    records = sorted(os.path.basename(name) for name in glob.glob(os.path.join(wanted.folder, "run.traversal_*.txt")))
    print(run([f"{programs}/cell_tb", "--replay", *records, "--hardware", "."], wanted.folder), end="")
    run(["verilator", "--lint-only", "-Wall", f"-I{UNITS}", "microcode.sv", "visit.sv",
         os.path.join(UNITS, "traversal.sv"), "--top-module", "traversal"], wanted.folder)
    text = run(build(wanted.folder, False, False, "traversal_tb"), wanted.folder)
    print(text, end="")
    return 0 if ", 0 differences" in text and "rays" in text else 1


if __name__ == "__main__":
    sys.exit(main())
