"""The benchmark's table and chart."""
import statistics

from studies.charts import finish, panels, plt

NAMES = {"sc_fifo": "`sc_fifo`, an SC_METHOD per cell", "cell_module": "`CellModule`", "cell_tile": "`CellTile`",
         "bare_cells": "the same cells, no kernel", "bare_tokens": "tokens alone"}
GOALS = [("cell_tile", "cell_module", 5, "`CellTile` / `CellModule`"),
         ("cell_tile", "bare_cells", 0.4, "`CellTile` / the same cells without the kernel"),
         ("cell_tile", "bare_tokens", 0.4, "`CellTile` / tokens alone"),
         ("cell_module", "sc_fifo", 2, "`CellModule` / `sc_fifo`")]
GOAL_SIDE = 128


def median(group, field):
    return statistics.median(row[field] for row in group)


def ratio(groups, over, under, side):
    """Ratio of two cases' hops per second in the same round, whose runs follow each other; median over rounds."""
    pairs = zip(groups[over, side], groups[under, side])
    return statistics.median(a["hops_per_second"] / b["hops_per_second"] for a, b in pairs)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def per_side(groups, cases, sides, text):
    return [[NAMES[case]] + [text(groups[case, side]) for side in sides] for case in cases]


def goals(groups, sides):
    rows = []
    for over, under, least, name in GOALS:
        values = [ratio(groups, over, under, side) for side in sides]
        row = [name] + [f"{value:.2f}" for value in values]
        if GOAL_SIDE in sides:
            there = values[sides.index(GOAL_SIDE)]
            row.append(f"at least {least:g}: {'reached' if there >= least else 'not reached'}")
        rows.append(row)
    return rows


def jobs_table(jobs):
    rows = [[job["scene"], f"{job['side']:.0f}²", job["granularity"], f"{job['hops'] / 1e6:.1f} M",
             *(f"{job[phase]:.2f}" for phase in ("build", "load", "trace")), f"{job['hops_per_second'] / 1e6:.2f} M",
             f"{job['bytes_per_cell']:.0f}", f"{job['peak_memory_bytes'] / 1e6:.0f} MB"] for job in jobs]
    return table(["scene", "cells", "granularity", "hops", "build, s", "load, s", "trace, s", "hops/s",
                  "bytes per cell", "peak"], rows)


def write_table(path, cases, groups, jobs):
    sides = sorted({side for _, side in groups})
    head = ["", *(f"{side}²" for side in sides)]
    rounds = max(len(group) for group in groups.values())
    lines = ["# What a hop costs", "",
             f"`scripts/study bench`: the same rays and answers, hop by hop, medians of {rounds} rounds; a process per run,",
             "all cases of an array in turn; processor seconds. Every cell sends a ray that is under way for some sixteen",
             "cells; `tokens alone` has no buffers, no units and no time, `sc_fifo` has no units and no time.", "",
             "## Hops per second", ""]
    lines += table(head, per_side(groups, cases, sides, lambda g: f"{median(g, 'hops_per_second') / 1e6:.2f} M"))
    lines += ["", "## Ratios", "", "Of runs that follow each other, median over the rounds.", ""]
    lines += table(head + ([f"goal at {GOAL_SIDE}²"] if GOAL_SIDE in sides else []), goals(groups, sides))
    timed = [case for case in cases if median(groups[case, sides[0]], "cycles_per_second") > 0]
    lines += ["", "## Simulated cycles per second", ""]
    lines += table(head, per_side(groups, timed, sides, lambda g: f"{median(g, 'cycles_per_second'):.0f}"))
    held = [case for case in cases if case != "bare_tokens"]
    lines += ["", "## Bytes per empty cell", ""]
    lines += table(head, per_side(groups, held, sides, lambda g: f"{median(g, 'bytes_per_cell'):.0f}"))
    lines += ["", "## Seconds to build and elaborate", ""]
    lines += table(head, per_side(groups, held, sides, lambda g: f"{median(g, 'build_seconds'):.2f}"))
    if jobs:
        lines += ["", "## Whole jobs", "", "`raycell render`, one run each, wall seconds.", ""] + jobs_table(jobs)
    path.write_text("\n".join(lines) + "\n")


def write_chart(path, cases, hops_per_second):
    sides = sorted({side for _, side in hops_per_second})
    figure, axes = panels(1, 1, 6.4, 4.2)
    axis = axes[0][0]
    handles = [axis.plot(sides, [1e9 / hops_per_second[case, side] for side in sides], marker="o",
                         label=NAMES[case].replace("`", ""))[0] for case in cases]
    axis.set_xscale("log", base=2)
    axis.set_yscale("log")
    axis.set_xticks(sides, [str(side) for side in sides])
    axis.set_xlabel("cells a side")
    axis.set_ylabel("nanoseconds per hop")
    for handle in handles:
        handle.set_label(handle.get_label().replace(", an SC_METHOD per cell", ""))
    finish(figure, "What a hop costs, by who runs the cells", handles, 150, path)
    plt.close(figure)
