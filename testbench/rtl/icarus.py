"""Replays golden vectors with the SystemVerilog cell without voxels, by Icarus Verilog."""

import os
import re

from simulators import HERE, MACHINE, Failed, folder_of, run, sources

BENCH = ["bench/cell_tb.sv"]


def compiled(machine, options):
    """The replay program of a machine, built if it is not there."""
    folder = folder_of(machine, BENCH, options, "icarus")
    program = os.path.join(folder, "cell_tb.vvp")
    if os.path.exists(program):
        return program
    # Icarus takes an imported name in a port's expression for an implicit net, unless there are none.
    with open(os.path.join(folder, "no_implicit_nets.sv"), "w", encoding="utf-8") as file:
        file.write("`default_nettype none\n")
    command = ["iverilog", "-g2012", "-s", "cell_tb", "-o", program + ".part"] + ["-DRTL_FAULTS"] * options.faults
    command += [os.path.join(folder, name) for name in ("no_implicit_nets.sv", MACHINE)]
    run(command + [name for name in sources(False) if name.endswith(".sv")] + [os.path.join(HERE, name) for name in BENCH])
    os.replace(program + ".part", program)
    return program


def layouts_of(record):
    """Fields and bits of the messages, from a record's head."""
    found = {}
    with open(record, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if words[0] == "layout":
                found[words[1]] = [(field, int(bits)) for field, bits in (word.rsplit(":", 1) for word in words[2:])]
            if words[0] == "begin":
                return found
    return found


def named(line, record):
    """A difference, with the first field in which two messages differ."""
    parts = re.match(r"(.*: )sent (\d+) ([0-9a-fx]+), expected (\d+) ([0-9a-fx]+)$", line)
    if not parts:
        return line
    head, cycles, sent, due, expected = parts.groups()
    if cycles != due:
        return f"{head}cycles on the link are {cycles}, expected {due}"
    if "x" in sent:
        return f"{head}bits are {sent}, expected {expected}"
    width = 4 * len(sent)
    sent, expected = f"{int(sent, 16):0{width}b}", f"{int(expected, 16):0{width}b}"
    kinds = ["ray", "shadow_ray", "intensity", "verdict", "verdict", "verdict"]
    kind, at = int(expected[:3], 2), 0
    for field, bits in layouts_of(record).get(kinds[kind], []) if kind < len(kinds) else []:
        own, other = int(sent[at:at + bits], 2), int(expected[at:at + bits], 2)
        if own != other:
            return f"{head}field '{field}' is {own}, expected {other}"
        at += bits
    return f"{head}bits differ behind the fields"


def by_icarus(machine, lines, fault, options):
    """Replays each record of a machine; the code of all."""
    package = dict(machine)[MACHINE]
    program = compiled(machine, options)
    failed, compared, cycles = 0, 0, 0
    for line in lines:
        record, x, y, _, viewer = line.split()
        digits = int(re.search(r"MESSAGE_BITS = (\d+);", package).group(1)) // 4
        text = run(["vvp", program, f"+stem={os.path.splitext(record)[0]}", f"+x={x}", f"+y={y}",
                    f"+viewer={viewer[:digits].ljust(digits, '0')}", f"+fault={fault}"]).stdout
        for difference in re.findall(r"^cycle \d+: .*$", text, re.MULTILINE):
            print(f"{record}: {named(difference, record)}")
        summary = re.search(r"^(\d+) differences, (\d+) events compared, (\d+) cycles$", text, re.MULTILINE)
        if not summary:
            raise Failed(f"vvp: it did not come to its end:\n{text[-2000:]}")
        failed += summary.group(1) != "0"
        compared, cycles = compared + int(summary.group(2)), cycles + int(summary.group(3))
    print(f"{len(lines)} records, {failed} with differences; {compared} events compared, {cycles} cycles of the cell run")
    return 2 if failed else 0
