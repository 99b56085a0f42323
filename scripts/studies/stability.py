"""Runs the stability studies, writes their tables and draws one small chart for each."""
import argparse
import csv
import pathlib
import tempfile

from studies import frame_rows, programs

COLOURS = {"exact": "black", "fixed 32": "tab:purple", "fixed 24": "tab:blue", "fixed 20": "tab:green",
           "fixed 16": "tab:orange", "fixed 12": "tab:red", "fixed 8": "tab:brown",
           "depth": "tab:red", "interval": "tab:orange", "plane": "tab:olive", "mask": "tab:blue", "edge": "black"}


class Study:
    """The rows of one study."""

    def __init__(self, file):
        with open(file, newline="") as stream:
            self.rows = list(csv.DictReader(stream))

    def values(self, column):
        """The different values of a column, in order of appearance."""
        return list(dict.fromkeys(row[column] for row in self.rows))

    def line(self, x, y, **where):
        """Two lists of numbers from the rows that match, in order of x."""
        rows = [r for r in self.rows if all(r[k] == str(v) for k, v in where.items())]
        points = sorted((float(r[x]), float(r[y])) for r in rows)
        return [p[0] for p in points], [p[1] for p in points]


def lines(axis, study, key, x, y, names=None, labels=True, style="-", **where):
    for name in names or study.values(key):
        xs, ys = study.line(x, y, **{key: name}, **where)
        axis.plot(xs, ys, style, marker=".", color=COLOURS.get(name), label=name if labels else None, lw=1.2)


def slopes(axis, study):
    for rung in ["depth", "interval", "edge"]:
        axis.plot(*study.line("slope", f"{rung}_leak_percent", arithmetic="fixed 20"), marker=".", lw=1.2,
                  color=COLOURS[rung], label=rung + ", 20 bits")
    axis.plot(*study.line("slope", "edge_leak_percent", arithmetic="fixed 12"), "--", marker=".", lw=1.2,
              color=COLOURS["mask"], label="edge, 12 bits")
    axis.set_xscale("symlog", linthresh=0.1)
    axis.set_yscale("symlog", linthresh=0.01)
    axis.set(title="Planes of a slope", xlabel="slope of the plane, depth per cell", ylabel="rays that leak, %")


def dda_drift(axis, study):
    for method, colour in [("re-based walk", "tab:green"), ("plain DDA", "tab:red")]:
        axis.plot(*study.line("word_bits", "largest_error_cells", method=method), marker=".", color=colour,
                  label=method, lw=1.2)
    axis.set_yscale("log")
    axis.axhline(0.5, color="grey", lw=0.8, ls=":")
    axis.set(title="A ray over 1024 cells", xlabel="word, bits (fraction: 2 less, plain DDA 11 less)",
             ylabel="largest error, cells")


def span_drift(axis, study):
    for method, colour in [("16 guard bits", "tab:green"), ("no guard bits", "tab:red")]:
        axis.plot(*study.line("word_bits", "largest_depth_error_cells", method=method), marker=".", color=colour,
                  label="depth, " + method, lw=1.2)
        axis.plot(*study.line("word_bits", "largest_normal_error_rad", method=method), "--", color=colour,
                  label="normal, " + method, lw=1.2)
    axis.set_yscale("log")
    axis.set(title="A span at its 1024th cell", xlabel="word, bits", ylabel="largest error, cells or rad")


def normals(axis, study):
    rows = [r for r in study.rows if r["root"] == "newton 64" and r["opening_deg"] == "60"]
    bits = [int(r["arithmetic"].split()[1]) for r in rows]
    axis.plot(bits, [float(r["largest_length_error"]) for r in rows], marker=".", color="tab:blue", lw=1.2,
              label="length")
    axis.plot(bits, [float(r["largest_angle_error_rad"]) for r in rows], marker=".", color="tab:green", lw=1.2,
              label="angle, rad")
    tables = [r for r in study.rows if r["root"].startswith("table")]
    for row in tables:
        axis.plot(20, float(row["largest_length_error"]), "x", color="tab:red")
        axis.annotate(row["root"], (20, float(row["largest_length_error"])), fontsize=6, xytext=(4, -2),
                      textcoords="offset points")
    axis.set_yscale("log")
    axis.set(title="Normals made unit, 60° apart", xlabel="word, bits", ylabel="largest error")


def grazing(axis, study):
    lines(axis, study, "arithmetic", "grazing_rad", "below_percent")
    axis.set_xscale("log")
    axis.set(title="Reflection at grazing angles", xlabel="angle to the surface, rad",
             ylabel="rays under the surface, %")


def critical(axis, study):
    lines(axis, study, "arithmetic", "from_critical_rad", "largest_angle_error_rad",
          ["fixed 32", "fixed 24", "fixed 20", "fixed 16", "fixed 12"])
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set(title="Refraction near the critical angle", xlabel="short of the critical angle, rad",
             ylabel="largest error, rad")


def mirrors(axis, study):
    names = ["exact", "fixed 24", "fixed 20", "fixed 16", "fixed 12"]
    lines(axis, study, "arithmetic", "generations", "largest_position_error_cells", names)
    lines(axis, study, "arithmetic", "generations", "largest_intensity_error", names, labels=False, style=":")
    axis.set_xscale("symlog", linthresh=1)
    axis.set_xticks([0, 1, 4, 16, 62], ["0", "1", "4", "16", "62"])
    axis.set_yscale("log")
    axis.set(title="Two facing mirrors", xlabel="generation", ylabel="largest error: place, cells\n(dotted: intensity)")


def offset(axis, study):
    for name in study.values("arithmetic"):
        rows = [r for r in study.rows if r["arithmetic"] == name]
        def wrong(row):
            return float(row["wrongly_shadowed_percent"]) + float(row["wrongly_lit_percent"])
        swept = sorted((float(r["offset_cells"]), wrong(r)) for r in rows if r["is_default"] == "0")
        axis.plot([p[0] for p in swept], [p[1] for p in swept], marker=".", color=COLOURS[name], label=name, lw=1.2)
        default = next(r for r in rows if r["is_default"] == "1")
        axis.plot(float(default["offset_cells"]), wrong(default), "o", mfc="none", ms=9, color=COLOURS[name])
    axis.set_xscale("symlog", linthresh=1e-9)
    axis.set_xticks([0, 1e-8, 1e-6, 1e-4, 1e-2])
    axis.set_yscale("symlog", linthresh=0.01)
    axis.set_ylim(-0.001, 2)
    axis.set(title="Shadow rays and the normal offset", xlabel="offset, cells (circle: default)",
             ylabel="wrong verdicts,\n% of lit + % of dark points")


def near_viewer(axis, study):
    def plot(rung, arithmetic, style, colour, label):
        axis.plot(*study.line("viewer_cells", "wrong_first_hit_percent", rung=rung, arithmetic=arithmetic), style,
                  marker=".", color=colour, label=label, lw=1.2)
    for rung in ["depth", "mask", "edge"]:
        plot(rung, "fixed 20", "-", COLOURS[rung], rung)
    plot("edge", "fixed 12", "--", "tab:grey", "edge, 12 bits")
    axis.set_xscale("log")
    axis.set_yscale("symlog", linthresh=0.1)
    axis.set_ylim(bottom=-0.01)
    axis.set(title="Viewer near the screen, 20 bits", xlabel="viewer's distance, cells",
             ylabel="wrong first hits, % of pixels")


def coincident(axis, study):
    lines(axis, study, "arithmetic", "angle_deg", "wrong_within_cells", ["fixed 20", "fixed 16", "fixed 12"],
          surfaces="crossing", rung="edge")
    for rung in ["interval", "depth"]:
        axis.plot(*study.line("angle_deg", "wrong_within_cells", surfaces="crossing", rung=rung), "--", marker=".",
                  color="tab:blue" if rung == "interval" else "tab:grey", label=f"{rung}, exact", lw=1.2)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set(title="Planes that cross", xlabel="angle between them, degrees",
             ylabel="wrong one seen within, cells")


def small(axis, study):
    for rung in ["depth", "mask", "edge"]:
        axis.plot(*study.line("size_cells", "found_percent", rung=rung, arithmetic="fixed 20"), marker=".",
                  color=COLOURS[rung], label=f"{rung}, found", lw=1.2)
        if rung != "depth":
            axis.plot(*study.line("size_cells", "false_hit_percent", rung=rung, arithmetic="fixed 20"), ":",
                      marker=".", color=COLOURS[rung], label=f"{rung}, hit beside it", lw=1.2)
    axis.plot(*study.line("size_cells", "found_percent", rung="edge", arithmetic="fixed 12"), "--", marker=".",
              color="tab:grey", label="edge, 12 bits, found", lw=1.2)
    axis.set_xscale("log")
    axis.set(title="Small triangles, 20 bits", xlabel="size, cells", ylabel="rays, %")


def saturation(axis, study):
    inputs = study.values("input")
    palette = ["tab:blue", "tab:red", "tab:orange", "tab:green", "tab:purple", "tab:brown"]
    for name, colour in zip(inputs, palette):
        axis.plot(*study.line("value", "rms_error", input=name, arithmetic="fixed 20"), marker=".", label=name,
                  color=colour, lw=1.2)
    axis.set_xscale("symlog", linthresh=1e-6)
    axis.set_xticks([0, 1e-3, 1, 1e3, 1e6, 1e9])
    axis.set_yscale("log")
    axis.set(title="Inputs beyond the formats, 20 bits", xlabel="input's value", ylabel="error of the picture, rms")


def chord_error(axis, study):
    for radius, style in [("0.5", ":"), ("2", "--"), ("8", "-")]:
        for arithmetic in ["exact", "fixed 20", "fixed 8"]:
            axis.plot(*study.line("chord_error_cells", "largest_place_error_cells", arithmetic=arithmetic, radius_cells=radius), style,
                      marker=".", color=COLOURS[arithmetic], label=f"{arithmetic}, radius {radius}", lw=1.2)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set(title="Spheres of facets", xlabel="chord error, cells", ylabel="largest distance of a hit\nfrom the sphere, cells")


def loading_order(axis, study):
    for surfaces, style in [("apart", "-"), ("each twice", ":")]:
        for arithmetic in study.values("arithmetic"):
            rows = {row["rung"]: row for row in study.rows if row["surfaces"] == surfaces and row["arithmetic"] == arithmetic}
            axis.plot(list(rows), [float(row["other_pixels_percent"]) for row in rows.values()], style, marker=".",
                      color=COLOURS[arithmetic], label=f"{surfaces}, {arithmetic}", lw=1.2)
    axis.set_yscale("symlog", linthresh=0.01)
    axis.set(title="Polygons loaded in another order", xlabel="rung", ylabel="pixels that change, %")


CHARTS = [slopes, dda_drift, span_drift, normals, grazing, critical, mirrors, offset, near_viewer, coincident, small,
          chord_error, loading_order, saturation]


def draw(folder, file):
    from matplotlib import pyplot as plt  # needed only here
    figure, axes = plt.subplots(5, 3, figsize=(14, 18.5))
    for axis, chart in zip(axes.flat, CHARTS):
        chart(axis, Study(folder / f"{chart.__name__}.csv"))
        axis.grid(True, lw=0.3)
        axis.legend(fontsize=7, framealpha=0.7)
    for axis in axes.flat[len(CHARTS):]:
        axis.set_visible(False)
    figure.tight_layout()
    figure.savefig(file, dpi=75)


def summary(text):
    """A table of the boundaries and treatments that the program printed."""
    rows = ["| study | boundary | treatment |", "|---|---|---|"]
    name = boundary = ""
    for line in text.splitlines():
        if line.startswith("## "):
            name = line[3:]
        elif line.startswith("Boundary: "):
            boundary = line[len("Boundary: "):]
        elif line.startswith("Treatment: "):
            rows.append(f"| {name} | {boundary} | {line[len('Treatment: '):]} |")
    return "\n".join(rows)


def main(root, words):
    parser = argparse.ArgumentParser(prog="scripts/study stability", description=__doc__)
    parser.add_argument("seed", nargs="?", default="1", metavar="SEED", help="default: 1")
    parser.add_argument("--program", type=pathlib.Path, default=root / "build" / "stability_tb",
                        help="the stability_tb to run; raycell is beside it")
    programs.add_out(parser, root)
    options = parser.parse_args(words)
    out = programs.made(options.out)
    with tempfile.TemporaryDirectory() as folder:
        run = programs.run(options.program, "--csv", folder, "--seed", options.seed)
        draw(pathlib.Path(folder), out / "stability.png")
    first, tables = run.output.split("\n", 1)
    tables += frame_rows.text(root, options.program.with_name("raycell"))
    text = f"""# Where the methods break

Made by `scripts/study stability`; {first.lower()}. `exact` is double precision, `fixed N` words of N bits; lengths
are in cell widths. stability.png draws the tables.

{summary(tables)}
{tables}"""
    (out / "stability.md").write_text(text)
    print(summary(tables))
