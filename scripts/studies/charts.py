"""What the sweeps' charts share: style, panels, axes, files."""
import matplotlib
import matplotlib.pyplot as plt

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.color": "#e5e5e5", "axes.axisbelow": True,
                     "svg.hashsalt": "raycell"})


LEGEND_INCHES = 0.4


def panels(rows, columns, width, height, **how):
    return plt.subplots(rows, columns, figsize=(width, height), squeeze=False, **how)


def finish(figure, title, handles, dpi, *paths):
    """Puts the title above the panels and the legend below them, and writes a file for each path."""
    height = figure.get_figheight()
    figure.suptitle(title, fontsize=11, y=1 - 0.1 / height).set_in_layout(False)  # its room is added below
    figure.legend(handles=handles, loc="lower center", ncol=min(len(handles), 12), frameon=False, columnspacing=1.4,
                  handletextpad=0.4)
    title_inches = 0.15 + 0.2 * len(title.splitlines())
    figure.tight_layout(rect=(0, LEGEND_INCHES / height, 1, 1 - title_inches / height))
    for path in paths:
        how = {"metadata": {"Date": None}} if path.suffix == ".svg" else {}
        figure.savefig(path, dpi=dpi, **how)
    plt.close(figure)


def thousands(value, _=None):
    return f"{value / 1e6:g} M" if value >= 1e6 else f"{value / 1e3:g} k" if value >= 1e3 else f"{value:g}"


def count_axis(axis, ticks=5):
    axis.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(ticks))
    axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(thousands))


def logarithmic_axis(axis):
    """Makes the x axis logarithmic, with plain numbers at 1, 2, 3 and 5."""
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=[1, 2, 3, 5]))
    axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(thousands))
    axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
