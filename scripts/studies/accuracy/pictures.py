"""The charts of accuracy, from the rows of accuracy.csv."""
from matplotlib.lines import Line2D

from studies.accuracy.design import RUNGS, SHADOWS
from studies.accuracy.rows import name_of, pareto
from studies.accuracy.tables import PAPER_CELL_BITS, PAPER_VOXEL_BITS
from studies.charts import count_axis, finish, logarithmic_axis, panels

COLOURS = dict(zip(RUNGS, ["#0072b2", "#009e73", "#e69f00", "#d55e00", "#7f7f7f"]))  # fit for the colour-blind
MARKERS = dict(zip(SHADOWS, ["o", "s", "^"]))
TOP_DB = 100  # larger values look equal to the eye and are drawn here


def draw_front(results, prefix):
    """Cycles against error with the Pareto front, as PNG and SVG: for each scene a panel, and to its right a narrow
    one for precasting, which takes many times the cycles."""
    rows = -(-len(results.scenes) // 2)
    figure, axes = panels(rows, 4, 15.5, 5.4 * rows + 0.9, gridspec_kw={"width_ratios": [3.2, 1, 3.2, 1]})
    for index, axis in enumerate(axes.flat):
        if index // 2 < len(results.scenes):
            draw_front_panel(axis, results, results.scenes[index // 2], precast=index % 2 == 1)
        else:
            axis.set_visible(False)
    title = (f"Machine cycles against image error, {results.front_cells}x{results.front_cells} cells: "
             "hit test x word bits x shadow mode, and one normal per voxel\n"
             "Cycles from the loaded array to the finished picture (precast + trace); the key names the Pareto front as "
             "hit test/word bits/shadow mode")
    finish(figure, title, front_legend(), 110, *(prefix.with_name(prefix.name + end) for end in (".png", ".svg")))


def front_legend():
    def dot(marker, colour, label, **how):
        return Line2D([], [], linestyle="", marker=marker, color=colour, label=label, **how)
    return ([dot("o", COLOURS[hit], hit) for hit in RUNGS] + [dot(MARKERS[s], "black", s) for s in SHADOWS]
            + [dot("o", "black", "one normal per voxel", fillstyle="none"),
               dot("o", "black", "10 bits", markersize=3.5), dot("o", "black", "20 bits", markersize=7),
               Line2D([], [], color="black", linewidth=1, label="Pareto front")])


def draw_front_panel(axis, results, scene, precast):
    points = results.front_points(scene)
    front = pareto(points)
    for row in points:
        c = row.configuration
        if (c.shadows == "precast") == precast:
            axis.plot(row.picture_cycles, min(row.psnr_total_db, TOP_DB), MARKERS[c.shadows], color=COLOURS[c.hit],
                      fillstyle="none" if c.normals == "voxel" else "full", markersize=0.35 * c.word_bits, alpha=0.8)
    decibels = [min(row.psnr_total_db, TOP_DB) for row in points]
    axis.set_ylim(min(decibels) - 3, max(decibels) + 4)
    axis.set_xlabel("cycles" if precast else "cycles, precast + trace")
    count_axis(axis, 2 if precast else 6)
    if precast:
        axis.set_title(f"{scene}, precast")
        axis.tick_params(labelleft=False)
    else:
        loads = [row.load_cycles for row in points]
        least, most = (f"{value:,.0f}" for value in (min(loads), max(loads)))
        axis.set_title(f"{scene} (before it, loading: {least if least == most else f'{least} to {most}'} cycles)")
        axis.set_ylabel("PSNR against the truth, dB (higher: smaller error)")
        draw_front_line(axis, front)
    label_front(axis, [(n, row) for n, row in enumerate(front, 1)
                       if (row.configuration.shadows == "precast") == precast])


def label_front(axis, numbered):
    """Writes the numbers of the front's points; numbers that would overlap share a label."""
    (left, right), (low, high) = axis.get_xlim(), axis.get_ylim()
    groups = []
    for number, row in numbered:
        x, y = row.picture_cycles, min(row.psnr_total_db, TOP_DB)
        near = groups and (x - groups[-1][1]) / (right - left) < 0.035 and (y - groups[-1][2]) / (high - low) < 0.03
        if near:
            groups[-1][0].append(number)
        else:
            groups.append(([number], x, y))
    for numbers, x, y in groups:
        text = str(numbers[0]) if len(numbers) == 1 else f"{numbers[0]}-{numbers[-1]}"
        axis.annotate(text, (x, y), xytext=(-5, 4), textcoords="offset points", ha="right", fontsize=8,
                      fontweight="bold")


def draw_front_line(axis, front):
    """Draws the front as steps to its best point, and the key to its numbers in the empty part above the front."""
    cycles = [row.picture_cycles for row in front]
    axis.step(cycles, [min(row.psnr_total_db, TOP_DB) for row in front], where="post", color="black", linewidth=1,
              zorder=1)
    low, high = axis.get_xlim()
    axis.set_xlim(low - 0.04 * (high - low), high)
    left = (cycles[-1] - low) / (high - low) > 0.55
    key = "Pareto front\n" + "\n".join(f"{n:2d} {name_of(row.configuration)}" for n, row in enumerate(front, 1))
    axis.text(0.02 if left else 0.98, 0.98, key, transform=axis.transAxes, ha="left" if left else "right", va="top",
              multialignment="left", fontsize=8, family="monospace", bbox={"facecolor": "white", "edgecolor": "#bbbbbb",
                                                              "alpha": 0.85})


def draw_bits(results, path):
    """Storage against error; a line marks the paper's estimate."""
    kinds = [("fullest_cell_bits", "bits of the fullest cell", PAPER_CELL_BITS, "paper: 5 Kbyte per cell"),
             ("bits_per_voxel", "bits per voxel, mean", PAPER_VOXEL_BITS, "paper: 40 bytes per voxel")]
    figure, axes = panels(2, len(results.scenes), 3.9 * len(results.scenes) + 0.5, 8.4, sharey=True)
    for line, (kind, label, limit, limit_label) in zip(axes, kinds):
        for axis, scene in zip(line, results.scenes):
            for hit in RUNGS:
                draw_bits_line(axis, results.word_lengths(scene, results.full_cells, hit), kind, COLOURS[hit])
            axis.axvline(limit, color="black", linestyle="--", linewidth=1)
            axis.text(limit, 0.97, limit_label + " ", rotation=90, ha="right", va="top", fontsize=8,
                      transform=axis.get_xaxis_transform())
            logarithmic_axis(axis)
            axis.set_title(scene)
            axis.set_xlabel(label)
        line[0].set_ylabel("PSNR against the truth, dB")
    low, high = axes[0][0].get_ylim()
    axes[0][0].set_ylim(low, high + 4)
    title = (f"Storage against image error, {results.full_cells}x{results.full_cells} cells, words of 8 to 32 bits; "
             "the numbers along a line are word bits")
    finish(figure, title, [Line2D([], [], color=COLOURS[hit], marker="o", markersize=4, label=hit) for hit in RUNGS],
           90, path)


def draw_bits_line(axis, rows, kind, colour):
    x = [getattr(row, kind) for row in rows]
    y = [min(row.psnr_total_db, TOP_DB) for row in rows]
    axis.plot(x, y, "-o", color=colour, markersize=2.5, linewidth=1)
    for row, px, py in zip(rows, x, y):
        if row.configuration.word_bits in (8, 12, 16, 20, 32) and row.configuration.hit in ("edge", "depth"):
            axis.annotate(row.configuration.word_bits, (px, py), xytext=(0, 4), textcoords="offset points", fontsize=7,
                          ha="center", color=colour)
            axis.plot(px, py, "o", color=colour, markersize=4.5)


def draw_split(results, path):
    """The two parts of the error over the word length: a row per scene, a column per rung."""
    kinds = [("psnr_discretisation_db", "discretisation: exact arithmetic against the truth", "#f0b080", 5),
             ("psnr_arithmetic_db", "arithmetic: words against exact arithmetic", "#7fb8e0", 5),
             ("psnr_total_db", "total: words against the truth", "black", 1.2)]
    figure, axes = panels(len(results.scenes), len(RUNGS), 2.9 * len(RUNGS), 2.3 * len(results.scenes) + 1.1,
                          sharex=True, sharey=True)
    for line, scene in zip(axes, results.scenes):
        for axis, hit in zip(line, RUNGS):
            rows = results.word_lengths(scene, results.full_cells, hit)
            for kind, _, colour, width in kinds:
                axis.plot([r.configuration.word_bits for r in rows], [min(getattr(r, kind), TOP_DB) for r in rows],
                          color=colour, linewidth=width)
            axis.set_title(f"{scene}, {hit}", fontsize=9)
        line[0].set_ylabel("PSNR, dB")
    for axis in axes[-1]:
        axis.set_xlabel("word bits")
        axis.set_xticks([8, 12, 16, 20, 24, 28, 32])
    axes[0][0].set_ylim(10, TOP_DB + 3)
    title = (f"Where the error comes from, {results.full_cells}x{results.full_cells} cells; above {TOP_DB} dB is drawn "
             f"at {TOP_DB}")
    handles = [Line2D([], [], color=colour, linewidth=width, label=label) for _, label, colour, width in kinds]
    finish(figure, title, handles, 80, path)
