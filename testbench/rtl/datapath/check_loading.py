#!/usr/bin/python3
"""Runs the loading unit in SystemVerilog over the load messages of cells of a real run.

Usage: check_loading.py BUILD FOLDER SCENE WORD_BITS [--cells X0..X1,Y0..Y1] [--array WxH]

Exit code 0 if all voxels, edges, lines, objects and sources, every span that goes on and all cycles are those of the
model.
"""
import argparse
import glob
import os
import shutil
import sys

from check_vectors import UNITS, build, run


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", help="folder with raycell, cell_tb and rtl_kit")
    parser.add_argument("folder", help="where to work; emptied first")
    parser.add_argument("scene")
    parser.add_argument("word_bits", type=int)
    parser.add_argument("--cells", default="10..13,10..13", help="the cells that are recorded")
    parser.add_argument("--array", default="24x24", help="cells of the array")
    wanted = parser.parse_args()
    programs = os.path.abspath(wanted.build)
    scene = os.path.abspath(wanted.scene)
    shutil.rmtree(wanted.folder, ignore_errors=True)
    os.makedirs(wanted.folder)
    run([f"{programs}/raycell", "render", scene, "--cells", wanted.array, "--word-bits", str(wanted.word_bits),
         "--golden", wanted.cells, "-o", "run"], wanted.folder)
    records = sorted(os.path.basename(name) for name in glob.glob(os.path.join(wanted.folder, "run.golden_*.txt")))
    run([f"{programs}/rtl_kit", records[0], "--package", "raycell_pkg.sv"], wanted.folder)
    print(run([f"{programs}/cell_tb", "--replay", *records, "--hardware", "."], wanted.folder), end="")
    run(["verilator", "--lint-only", "-Wall", f"-I{UNITS}", "raycell_pkg.sv", "microcode.sv", "load.sv",
         os.path.join(UNITS, "loading.sv"), "--top-module", "loading"], wanted.folder)
    text = run(build(wanted.folder, False, False, "loading_hw_tb"), wanted.folder)
    print(text, end="")
    return 0 if ", 0 differences" in text and "messages" in text else 1


if __name__ == "__main__":
    sys.exit(main())
