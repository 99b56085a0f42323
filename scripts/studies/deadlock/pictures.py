"""The charts of the deadlock sweep, from the rows of deadlock.csv."""
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from studies.charts import count_axis, finish, panels, thousands
from studies.deadlock.design import NETWORKS
from studies.deadlock.rows import smallest_safe
from studies.deadlock.tables import NONE, POSTPONE

# Fit for the colour-blind.
DEPTH_COLOURS = ["#d55e00", "#0072b2", "#009e73", "#7f7f7f"]
NETWORK_COLOURS = dict(zip(NETWORKS, ["#d55e00", "#e69f00", "#0072b2", "#009e73"]))
MARKERS = ["o", "s", "^", "D"]
STYLES = {NONE: "-", POSTPONE: "--"}
MODE_NAMES = {NONE: "without recovery", POSTPONE: "with recovery (postpone, reserved)"}


def store_axis(axis, stores):
    axis.set_xticks(range(len(stores)), [str(m) for m in stores])
    axis.set_xlim(-0.4, len(stores) - 0.6)
    axis.set_xlabel("M, slots")


def logarithmic(axis):
    """Makes the y axis logarithmic, with plain numbers; between powers of ten only if there are few powers."""
    axis.set_yscale("log")
    low, high = axis.get_ylim()
    axis.yaxis.set_major_formatter(FuncFormatter(thousands))
    few = high / low < 30
    axis.yaxis.set_minor_locator(LogLocator(subs=[2, 3, 5] if few else []))
    axis.yaxis.set_minor_formatter(FuncFormatter(thousands) if few else NullFormatter())


def stores_of(results, load):
    return sorted({m for networks in results.networks(load) for depth in results.depths(load) for mode in STYLES
                   for m, _ in results.line(load, networks, depth, mode)})


def plot(axis, stores, line, value, dodge=0, **how):
    points = [(stores.index(m) + dodge, value(group)) for m, group in line]
    if points:
        axis.plot(*zip(*points), markersize=4, linewidth=1.4, **how)


def draw_locks(results, prefix):
    """The main chart, as PNG and SVG: the share of runs that did not end, a row per load, a panel per network."""
    networks = [n for n in NETWORKS if any(n in results.networks(load) for load in results.loads)]
    depths = sorted({depth for load in results.loads for depth in results.depths(load)})
    figure, axes = panels(len(results.loads), len(networks), 3.3 * len(networks), 2.7 * len(results.loads) + 1.1,
                          sharey=True)
    for line, load in zip(axes, results.loads):
        cells, _ = results.main[load]
        stores = stores_of(results, load)
        for axis, name in zip(line, networks):
            for place, depth in enumerate(depths):
                for number, (mode, style) in enumerate(STYLES.items()):
                    # Side by side in x, so that each point's height is its value.
                    lines = len(depths) * len(STYLES)
                    dodge = 0.7 * ((number * len(depths) + place) / (lines - 1) - 0.5)
                    plot(axis, stores, results.line(load, name, depth, mode),
                         lambda group: 100 * group.share(lambda row: not row.completed), dodge,
                         linestyle=style, color=DEPTH_COLOURS[place % len(DEPTH_COLOURS)], marker=MARKERS[place % 4],
                         fillstyle="full" if mode == NONE else "none")
            axis.set_title(f"{load} {cells}x{cells}, {name}")
            store_axis(axis, stores)
            axis.set_xlim(-0.5, len(stores) - 0.5)
        line[0].set_ylabel("runs that did not end, %")
        line[0].set_ylim(-4, 104)
    handles = [Line2D([], [], color=DEPTH_COLOURS[i % 4], marker=MARKERS[i % 4], markersize=4,
                      label=f"buffers of {depth}") for i, depth in enumerate(depths)]
    handles += [Line2D([], [], color="black", linestyle=style, label=MODE_NAMES[mode])
                for mode, style in STYLES.items()]
    title = ("Which machines lock: share of the seeds whose run did not end (deadlock, or cut off while trees were "
             "postponed again and again)\nagainst the ray store M, per network and buffer depth; "
             "equal lines are drawn beside each other")
    finish(figure, title, handles, 110, *(prefix.with_name(prefix.name + end) for end in (".png", ".svg")))


def draw_occupancy(results, path):
    """Completed share, cycles, occupancy and destroyed sub-trees against M, at the smallest buffer depth."""
    kinds = [("pixels completed, %", False, lambda g: 100 * g.median(lambda r: r.completed_share)),
             ("cycles of runs that all ended", True, lambda g: g.median(lambda r: r.cycles)),
             ("ray store: peak (thin) and mean", True, lambda g: max(g.median(lambda r: r.ray_store_mean), 1e-3)),
             ("ray buffers: mean occupancy", True,
              lambda g: max(g.median(lambda r: r.buffer_use("ray")[1]), 1e-4)),
             ("destroyed sub-trees", True, lambda g: g.median(lambda r: r.destroyed))]
    figure, axes = panels(len(results.loads), len(kinds), 3.2 * len(kinds), 2.9 * len(results.loads) + 1.0)
    for line, load in zip(axes, results.loads):
        cells, _ = results.main[load]
        stores = stores_of(results, load)
        depth = results.depths(load)[0]
        for axis, (title, powers, value) in zip(line, kinds):
            for networks in results.networks(load):
                for mode, style in STYLES.items():
                    runs = results.line(load, networks, depth, mode)
                    how = {"color": NETWORK_COLOURS[networks], "linestyle": style}
                    if title.startswith("cycles"):
                        runs = [(m, group) for m, group in runs if group.safe]
                    if title.startswith("destroyed"):
                        runs = [(m, group) for m, group in runs if value(group) > 0]
                    plot(axis, stores, runs, value, marker="o", **how)
                    if title.startswith("ray store"):
                        points = [(stores.index(m), max(r.ray_store_peak for r in g.rows)) for m, g in runs]
                        if points:
                            axis.plot(*zip(*points), linewidth=0.7, **how)
            axis.set_title(f"{load} {cells}x{cells}: {title}", fontsize=8)
            store_axis(axis, stores)
            if powers:
                logarithmic(axis)
    handles = [Line2D([], [], color=NETWORK_COLOURS[n], marker="o", markersize=4, label=n) for n in NETWORKS]
    handles += [Line2D([], [], color="black", linestyle=style, label=MODE_NAMES[mode])
                for mode, style in STYLES.items()]
    finish(figure, "What M does: medians over the seeds, buffers of one message", handles, 90, path)


def draw_bits(results, path):
    """Storage against cycles of every configuration whose runs all end: the choices of an architect."""
    figure, axes = panels(1, len(results.loads), 6.2 * len(results.loads), 5.2)
    depths = sorted({depth for load in results.loads for depth in results.depths(load)})
    for axis, load in zip(axes[0], results.loads):
        cells, _ = results.main[load]
        for networks in results.networks(load):
            for place, depth in enumerate(depths):
                for mode, style in STYLES.items():
                    draw_bits_line(axis, results.line(load, networks, depth, mode), NETWORK_COLOURS[networks],
                                   MARKERS[place % 4], style)
        axis.set_title(f"{load}, {cells}x{cells} cells")
        axis.set_xlabel("bits of buffers, ray store and registers, a cell")
        logarithmic(axis)
        count_axis(axis, 7)
    axes[0][0].set_ylabel("cycles from the loaded array to the picture (median)")
    handles = [Line2D([], [], color=NETWORK_COLOURS[n], label=n) for n in NETWORKS]
    handles += [Line2D([], [], color="black", linestyle="", marker=MARKERS[i % 4], markersize=4,
                       label=f"buffers of {depth}") for i, depth in enumerate(depths)]
    handles += [Line2D([], [], color="black", linestyle=style, label=MODE_NAMES[mode].split(" (")[0])
                for mode, style in STYLES.items()]
    title = ("What a cell stores against what a frame takes: only where every seed ended; the number is the smallest "
             "safe M")
    finish(figure, title, handles, 100, path)


def draw_bits_line(axis, line, colour, marker, style):
    safe = smallest_safe(line)
    if not safe:
        return
    runs = [(m, group) for m, group in line if m >= safe[0]]
    points = [(group.rows[0].cell_bits, group.median(lambda row: row.cycles)) for _, group in runs]
    axis.plot(*zip(*points), color=colour, marker=marker, linestyle=style, markersize=4, linewidth=0.9,
              fillstyle="full" if style == "-" else "none")
    axis.annotate(safe[0], points[0], xytext=(3, 3), textcoords="offset points", fontsize=7, color=colour)
