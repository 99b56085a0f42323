"""Tables and charts of how whole jobs grow."""
import math
import statistics

from studies.bench.growth import KEYS, LEVELS, PHASES, RAYS
from studies.charts import finish, panels, plt
from studies.tables import table

COLOURS = {"load": "#4477aa", "precast": "#ccbb44", "trace": "#ee6677"}
MARKERS = "os^Dv"
LEAST_LINE_SIDE = 64  # cells a side; shorter runs end before their cost shows


class Series:
    """A row of panels: the factor that varies, and the rows in which only this factor varies."""

    def __init__(self, title, axis, varies, rows):
        self.title, self.axis, self.varies, self.rows = title, axis, varies, rows

    def lines(self):
        """{(name, shadows): rows in the order of the factor that varies}"""
        lines = {}
        for row in self.rows:
            name = row["scene"].split("-")[0] if self.varies == "primitives" else row["scene"]
            lines.setdefault((name, row["shadows"]), []).append(row)
        return {key: sorted(line, key=lambda row: row[self.varies]) for key, line in lines.items()}


def medians(rows):
    """One row for all rounds of a job: medians of what was measured."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in KEYS if key != "round"), []).append(row)
    return [{k: statistics.median(r[k] for r in group) if isinstance(v, float) else v for k, v in group[0].items()}
            for group in groups.values()]


def series_of(rows, side):
    """The series that the rows hold. `side`: cells a side in all series but the first."""
    usual = {"side": side, "depth": LEVELS, "max_depth": RAYS}

    def alone(varies, scenes):
        fixed = {k: v for k, v in usual.items() if k != varies}
        return [row for row in rows if row["scene"] in scenes and all(row[k] == v for k, v in fixed.items())]

    growing = {row["scene"] for row in rows if any(row[k] != v for k, v in usual.items())}
    every = {row["scene"] for row in rows}
    families = {name for name in every if sum(other.split("-")[0] == name.split("-")[0] for other in every) > 1}
    at = f"{side}x{side} cells"
    made = [Series("the array's side", "cells a side", "side", alone("side", growing or every)),
            Series(f"depth, {at}", "depth levels", "depth", alone("depth", growing)),
            Series(f"primitives, {at}", "primitives of the scene", "primitives", alone("scene", families)),
            Series(f"generations of rays, {at}", "max-depth", "max_depth", alone("max_depth", growing))]
    return [each for each in made if len({row[each.varies] for row in each.rows}) > 1]


def seconds(value):
    return f"{value:.3g}"


def series_table(series):
    head = [series.axis, "scene", "shadows", "rays", *(f"{phase}, M hops" for phase in PHASES),
            *(f"{phase}, s" for phase in PHASES), "whole job, s", "wall, s", "peak, MB"]
    lines = []
    for (_, shadows), rows in sorted(series.lines().items()):
        for row in rows:
            lines.append([f"{row[series.varies]:.0f}", row["scene"], shadows, f"{row['rays']:,.0f}",
                          *(f"{row[f'hops_{phase}'] / 1e6:.2f}" for phase in PHASES),
                          *(seconds(row[f"processor_{phase}"]) for phase in PHASES), seconds(row["processor_job"]),
                          seconds(row["wall_job"]), f"{row['peak_memory_bytes'] / 1e6:.0f}"])
    return table(head, lines)


def fit_line(points):
    """Slope and factor of the least-squares line through the logarithms of (x, y)."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x, mean_y = (statistics.fmean(values) for values in zip(*logs))
    slope = sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)
    return slope, math.exp(mean_y - slope * mean_x)


def hops_and_walls(rows):
    """Per scene, (hops, wall seconds of load and trace, side) of growing arrays."""
    lines = {}
    for row in rows:
        if row["shadows"] != "per-hit" or row["side"] < LEAST_LINE_SIDE:
            continue
        hops, wall = (sum(row[f"{quantity}_{phase}"] for phase in PHASES) for quantity in ("hops", "wall"))
        lines.setdefault(row["scene"], []).append((hops, wall, row["side"]))
    return {scene: sorted(line) for scene, line in lines.items() if len({side for _, _, side in line}) > 1}


def line_rows(lines):
    rows = []
    for scene, line in sorted(lines.items()):
        slope, _ = fit_line([(hops, wall) for hops, wall, _ in line])
        each = [wall / hops for hops, wall, _ in line]
        rows.append([scene, f"{line[0][2]:.0f}² to {line[-1][2]:.0f}²", f"{slope:.3f}", f"{1e9 * min(each):.0f}",
                     f"{1e9 * max(each):.0f}", f"{max(each) / min(each):.2f}"])
    return rows


def write_growth_table(path, rows, side):
    rounds = len({row["round"] for row in rows})
    made = "one run each" if rounds == 1 else f"medians of {rounds} runs"
    rows = medians(rows)
    text = ["# How the cost of a whole job grows", "",
            "`scripts/study bench`: `raycell render`, timed engine, words of 20 bits; hops of the simulated machine,",
            f"processor seconds of the simulator by phase, {made}. Whole job: reading, tessellating,",
            "building, files included; wall seconds beside it.", ""]
    series = series_of(rows, side)
    for each in series:
        text += [f"## By {each.title}", "", series_table(each), ""]
    lines = hops_and_walls(series[0].rows if series and series[0].varies == "side" else [])
    if lines:
        text += ["## Wall time against hops", "",
                 "Of loading and tracing, per-hit shadows. Slope of the straight line through the logarithms; 1: a hop",
                 "costs the same in every array.", "",
                 table(["scene", "cells", "slope", "least ns per hop", "most", "most / least"], line_rows(lines)), ""]
    path.write_text("\n".join(text))
    return lines


def draw_line(axis, series, quantity):
    names = sorted({name for name, _ in series.lines()})
    for (name, shadows), rows in series.lines().items():
        # Loading and tracing come from the runs without precast.
        phases = ["precast"] if shadows == "precast" else ["load", "trace"]
        for phase in phases:
            points = [(row[series.varies], row[f"{quantity}_{phase}"]) for row in rows]
            points = [(x, y) for x, y in points if y > 0]
            axis.plot([x for x, _ in points], [y for _, y in points], color=COLOURS[phase],
                      marker=MARKERS[names.index(name) % len(MARKERS)], markersize=4, linewidth=1)
    axis.set_yscale("log")
    if series.varies == "max_depth":
        axis.set_xticks(sorted({row["max_depth"] for row in series.rows}))
    elif series.varies == "primitives":
        axis.set_xscale("log")
    else:
        axis.set_xscale("log", base=2)
        ticks = sorted({row[series.varies] for row in series.rows})
        axis.set_xticks(ticks, [f"{tick:.0f}" for tick in ticks])
        axis.minorticks_off()


def write_growth_chart(path, rows, side):
    series = series_of(medians(rows), side)
    if not series:
        return
    figure, axes = panels(2, len(series), 3.4 * len(series), 6.2)
    for column, each in enumerate(series):
        for row, (quantity, label) in enumerate([("processor", "processor seconds"), ("hops", "hops")]):
            axis = axes[row][column]
            draw_line(axis, each, quantity)
            axis.set_xlabel(each.axis)
            if column == 0:
                axis.set_ylabel(label)
        axes[0][column].set_title("by " + each.title, fontsize=9)
        for place, name in enumerate(sorted({name for name, _ in each.lines()})):
            marker = MARKERS[place % len(MARKERS)]
            axes[1][column].plot([], [], color="#777777", marker=marker, linestyle="", label=name)
        axes[1][column].legend(fontsize=7, framealpha=0.8, edgecolor="none", loc="best")
    handles = [plt.Line2D([], [], color=COLOURS[phase], label=phase) for phase in PHASES]
    finish(figure, "How the cost of a whole job grows", handles, 150, path)


def write_line_chart(path, lines):
    figure, axes = panels(1, 1, 6.4, 4.6)
    axis = axes[0][0]
    handles = []
    for place, (scene, line) in enumerate(sorted(lines.items())):
        slope, factor = fit_line([(hops, wall) for hops, wall, _ in line])
        each = [wall / hops for hops, wall, _ in line]
        colour = list(COLOURS.values())[place % len(COLOURS)]
        hops = [point[0] for point in line]
        handles += axis.plot(hops, [wall for _, wall, _ in line], marker=MARKERS[place % len(MARKERS)], linestyle="",
                             color=colour, label=f"{scene}: slope {slope:.2f}, ns per hop {1e9 * min(each):.0f} to "
                             f"{1e9 * max(each):.0f} ({max(each) / min(each):.2f})")
        ends = [hops[0], hops[-1]]
        axis.plot(ends, [factor * x ** slope for x in ends], color=colour, linewidth=1)
        for x, y, side in line:
            axis.annotate(f"{side:.0f}²", (x, y), textcoords="offset points", xytext=(4, -9), fontsize=7)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel("hops of loading and tracing")
    axis.set_ylabel("wall seconds")
    axis.legend(handles=handles, fontsize=8, frameon=False, loc="upper left")
    figure.suptitle("Wall time against hops, arrays from "
                    f"{min(p[2] for l in lines.values() for p in l):.0f}² to "
                    f"{max(p[2] for l in lines.values() for p in l):.0f}²", fontsize=11)
    figure.tight_layout()
    figure.savefig(path, dpi=150)
    plt.close(figure)
