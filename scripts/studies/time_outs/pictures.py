"""The chart of the time-outs, from the rows of time_outs.csv."""
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from studies.time_outs.design import MACHINES, TIME_OUTS, name_of
from studies.charts import finish, panels

# Fit for the colour-blind; the machines that end are blue and green.
COLOURS = dict(zip(MACHINES, ["#0072b2", "#009e73", "#56b4e9", "#d55e00", "#e69f00", "#cc79a7"]))
MARKERS = dict(zip(MACHINES, ["o", "s", "^", "D", "v", "P"]))
ROWS = ["runs with a false alarm, %", "alarms per million\ncell cycles", "cells of knots that\nnever give alarm, %",
        "first lasting alarm,\ncycles after the knot"]
SHOWN = [cycles for cycles in TIME_OUTS if cycles <= 2 ** 14]  # longer time-outs exceed the runs
FLOOR = 0.003  # least rate drawn, on a logarithmic axis: below one alarm in all runs of a load and machine


def power(value, _=None):
    return f"$2^{{{round(value).bit_length() - 1}}}$"


def time_out_axis(axis, label):
    axis.set_xscale("log", base=2)
    axis.set_xlim(TIME_OUTS[0] / 1.3, SHOWN[-1] * 1.3)
    axis.xaxis.set_major_locator(FixedLocator(SHOWN[::2]))
    axis.xaxis.set_minor_locator(NullLocator())
    axis.xaxis.set_major_formatter(FuncFormatter(power))
    if label:
        axis.set_xlabel("time-out T, cycles")


def draw_shares(axis, machine, group):
    axis.plot(SHOWN, [100 * group.share_with("false", cycles) for cycles in SHOWN], **line(machine))


def draw_rates(axis, machine, group):
    for kind, style in [("false", "-"), ("early", ":")]:
        rates = [(cycles, group.rate(kind, cycles)) for cycles in TIME_OUTS if group.rate(kind, cycles) > 0]
        if rates:
            axis.plot(*zip(*rates), **{**line(machine), "linestyle": style})


def draw_delays(axis, machine, group):
    if not group.alarming:
        return
    _, median, _ = group.first_waits()
    later = [(cycles, cycles + median) for cycles in SHOWN if cycles + median > 0]
    axis.plot(*zip(*later), **line(machine))


def draw_misses(axis, groups):
    """A bar for each machine that locks; the values don't depend on T."""
    locking = [(machine, group) for machine, group in groups if group.locked]
    for place, (machine, group) in enumerate(locking):
        share = 100 * group.missed_cells()
        axis.bar(place, share, color=COLOURS[machine], width=0.7)
        axis.annotate(f"{share:.1f}\n{group.sum('missed_knots'):.0f} of {group.sum('knots'):.0f}", (place, share),
                      ha="center", va="bottom", fontsize=6.5, xytext=(0, 1), textcoords="offset points")
    axis.set_xticks([])
    axis.set_xlim(-0.8, max(len(locking), 1) - 0.2)
    axis.set_xlabel("at every T; second line: knots missed", fontsize=7.5)


def line(machine):
    return {"color": COLOURS[machine], "marker": MARKERS[machine], "markersize": 3, "linewidth": 1.2}


def draw(results, path):
    loads = results.loads
    figure, axes = panels(len(ROWS), len(loads), 2.9 * len(loads) + 0.6, 9.4, sharey="row")
    for column, load in enumerate(loads):
        groups = [(machine, results.groups[load, machine]) for machine in results.machines
                  if (load, machine) in results.groups]
        for machine, group in groups:
            draw_shares(axes[0][column], machine, group)
            draw_rates(axes[1][column], machine, group)
            draw_delays(axes[3][column], machine, group)
        draw_misses(axes[2][column], groups)
        axes[3][column].plot(SHOWN, SHOWN, color="black", linestyle="--", linewidth=0.8)
        axes[0][column].set_title(load)
        for row in (0, 1, 3):
            time_out_axis(axes[row][column], row == 3)
    for row, label in enumerate(ROWS):
        axes[row][0].set_ylabel(label)
    axes[0][0].set_ylim(-4, 104)
    axes[1][0].set_yscale("log")
    axes[1][0].set_ylim(bottom=FLOOR)
    axes[2][0].set_ylim(0, axes[2][0].get_ylim()[1] * 1.35)
    axes[3][0].set_yscale("log", base=2)
    axes[3][0].set_ylim(SHOWN[0] / 2, SHOWN[-1] * 2)
    axes[3][0].yaxis.set_major_formatter(FuncFormatter(power))
    handles = [Line2D([], [], label=name_of(machine), **line(machine)) for machine in results.machines]
    handles += [Line2D([], [], color="black", linestyle=":", label="early alarms"),
                Line2D([], [], color="black", linestyle="--", linewidth=0.8, label="T")]
    title = (f"A time-out in each cell against the proof: {results.cells}x{results.cells} cells, synthetic traffic of "
             f"{len(loads)} kinds, {len(results.rows)} runs\n"
             "false alarms (dotted: early ones, in cells that locked), cells that never give alarm, and how long after "
             "the first knot the first lasting alarm comes (median)")
    finish(figure, title, handles, 90, path)
