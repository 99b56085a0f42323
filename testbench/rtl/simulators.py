"""The SystemVerilog cell of a machine as a program or a library: by Verilator, or for Icarus Verilog. What is built is kept in the
work folder until the cell or the machine changes."""

import hashlib
import os
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PACKAGES = ["raycell_numbers.sv", "raycell_cell.sv"]        # in the order in which they need each other
WHOLE_PACKAGES = ["microcode.sv", "visit.sv", "shade.sv", "load.sv"]
EMPTY_ONLY = ("empty_cell.sv", "walk.sv", "traversal_unit.sv", "load_unit.sv")
MACHINE, HEADER = "raycell_pkg.sv", "raycell_rtl.hpp"


class Failed(Exception):
    pass


def run(command, log=None, **options):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0 and log is None:
        raise Failed(f"{os.path.basename(command[0])}: code {done.returncode}\n{done.stdout[-3000:]}")
    return done


def files_of(folder, first):
    units = sorted(name for name in os.listdir(folder) if name.endswith(".sv") and name not in first)
    return [os.path.join(folder, name) for name in first + units]


def sources(whole):
    """Files of the cell, in the order in which they need each other."""
    cell = files_of(os.path.join(HERE, "sv", "cell"), ["waivers.vlt"] + PACKAGES)
    if not whole:
        return cell
    folder = os.path.join(HERE, "sv", "whole")
    shared = [path for path in cell if os.path.basename(path) not in EMPTY_ONLY]
    return [os.path.join(folder, "waivers.vlt")] + shared + files_of(folder, ["raycell_whole.sv"])


def machine_in(folder, whole):
    """What the kit has written of a machine: names and texts."""
    names = [MACHINE, HEADER]
    if whole:
        names += sorted(name for name in os.listdir(folder) if name.endswith(".hex") or name in WHOLE_PACKAGES)
    texts = []
    for name in names:
        with open(os.path.join(folder, name), encoding="utf-8") as text:
            texts.append((name, text.read()))
    return tuple(texts)


def sizes_of(options):
    """The kit's words for the memories of the whole cell."""
    return ["--voxels", str(options.voxels), "--edges", str(options.edges)]


def add_sizes(parser):
    parser.add_argument("--whole", action="store_true", help="the whole cell, with voxels, instead of the one without")
    parser.add_argument("--voxels", type=int, default=128, help="with --whole: voxels that a cell holds")
    parser.add_argument("--edges", type=int, default=512, help="with --whole: edges of all its voxels")


def folder_of(machine, bench, options, simulator="verilator"):
    """The folder of what is built, with the machine's files in it."""
    digest = hashlib.sha256(str((machine, options.faults, simulator, options.optimise, options.whole)).encode())
    others = [os.path.join(HERE, folder, name) for folder in ("array", "bench")
              for name in sorted(os.listdir(os.path.join(HERE, folder))) if name.endswith(".hpp")]
    datapath = files_of(os.path.join(HERE, "sv", "datapath"), []) if options.whole else []
    for path in sources(options.whole) + datapath + others + [os.path.join(HERE, name) for name in bench]:
        with open(path, "rb") as text:
            digest.update(text.read())
    folder = os.path.join(options.work, digest.hexdigest()[:16])
    os.makedirs(folder, exist_ok=True)
    for name, text in machine:
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return folder


def verilated(machine, options, name, bench, compile_flags="", link_flags=""):
    """A program, or a library, around the cell of a machine. Microprograms are read from the folder that its `obj` is in."""
    folder = folder_of(machine, bench, options)
    program = os.path.join(folder, "obj", name)
    if os.path.exists(program):
        return program
    top = "whole_cell" if options.whole else "empty_cell"
    packages = [os.path.join(folder, name) for name in [MACHINE] + options.whole * WHOLE_PACKAGES]
    units = options.whole * [f"-I{HERE}/sv/datapath"] + packages + sources(options.whole)
    silent = run([options.verilator, "--lint-only", "-Wall", "--top-module", top] + units).stdout
    if silent.strip():
        raise Failed(f"verilator --lint-only -Wall is not silent:\n{silent}")
    defined = options.faults * " -DRTL_FAULTS" + options.whole * " -DRTL_WHOLE"
    command = [options.verilator, "--cc", "--exe", "--build", "-j", "1", "-O3", "--unroll-count", "4",
               "--x-assign", "0", "--top-module", top, "--Mdir", os.path.join(folder, "obj"),
               "-CFLAGS", f"-std=c++17 {options.optimise} -I{SOURCE} -I{folder} {compile_flags}{defined}"]
    command += units + [os.path.join(HERE, file_name) for file_name in bench] + ["-o", name]
    if link_flags:
        command += ["-LDFLAGS", link_flags]
    if options.faults:
        command.append("+define+RTL_FAULTS")
    environment = dict(os.environ)
    if any(os.access(os.path.join(path, "ccache"), os.X_OK) for path in environment["PATH"].split(":")):
        environment.setdefault("OBJCACHE", "ccache")
    run(command, env=environment)
    return program
