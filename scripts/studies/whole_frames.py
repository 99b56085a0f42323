"""Renders whole frames with machines of all kinds, and charts the cycles of loading and trace against the error to the scene."""
import csv
import json

from studies import programs, tables

CELLS = "128x128"
SCENES = ["still_life", "teapot-s4", "balls-s2", "mount-s4", "gears-s1", "tetra-s4", "balls-s4", "tree-s7"]
PRESETS = ["paper", "prototype", "default"]
FAST = ["--buffer", "4", "--loading-units", "4", "--traversal-units", "4", "--networks", "quadrant", "--feed-lanes", "64"]
LARGE = ("balls-s4", "tree-s7")  # without the finest polygons: there are millions
LIMIT = 50_000_000  # cycles; what takes longer is not on the chart


def machines():
    """Name and options of every machine: the presets, then what differs from the default machine."""
    all_ = {preset: ["--preset", preset] + (["--cells", CELLS] if preset != "prototype" else []) for preset in PRESETS}
    for rung in ("depth", "interval", "plane", "mask", "edge"):
        for normals in ("voxel", "linear"):
            if (rung, normals) != ("edge", "linear"):
                all_[f"{rung}, {normals}"] = ["--cells", CELLS, "--hit", rung, "--normals", normals]
    for bits in (12, 14, 16):
        all_[f"{bits} bits"] = ["--cells", CELLS, "--word-bits", str(bits)]
    for error in ("0.4", "0.02"):
        all_[f"chord error {error}"] = ["--cells", CELLS, "--chord-error", error]
    all_["four units"] = ["--cells", CELLS, *FAST]
    all_["four units, 14 bits"] = ["--cells", CELLS, "--word-bits", "14", *FAST]
    all_["four units, chord error 0.4"] = ["--cells", CELLS, "--chord-error", "0.4", *FAST]
    return all_


MACHINES = machines()


def machines_of(scene):
    return [m for m in MACHINES if scene not in LARGE or m != "chord error 0.02"]


def run(root, scenes, cache, scene, machine):
    """The JSON of a run. A finished run of the same program is not repeated; one that locks has its verdict."""
    prefix = cache / f"{scene}.{machine}".replace(" ", "_").replace(",", "")
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        try:
            programs.run(root / "build" / "raycell", "render", scenes[scene], "-o", prefix, "--truth", "--max-cycles", str(LIMIT),
                         "--quiet", *MACHINES[machine])
        except programs.Failed:
            if not result.exists():
                raise
    return json.loads(result.read_text())


def point(report):
    """Cycles and dB; none if the run did not end."""
    if report["verdict"] not in ("completed", "capacity"):
        return None
    return report["cycles"]["total"], report["accuracy"]["scene"]["psnr_db"]


def front(points):
    """Names of the machines that no other one beats in cycles and dB."""
    names = []
    for name, (cycles, psnr) in points.items():
        if not any(c <= cycles and p >= psnr and (c, p) != (cycles, psnr) for c, p in points.values()):
            names.append(name)
    return sorted(names, key=lambda name: points[name])


def points_of(results, scene):
    found = {machine: point(results[scene, machine]) for machine in machines_of(scene)}
    return {machine: p for machine, p in found.items() if p}


def draw(out, results):
    from studies import charts  # needs Matplotlib
    marks = {"paper": "X", "prototype": "P", "default": "*"}
    figure, axes = charts.panels((len(SCENES) + 3) // 4, 4, 15, 7.4)
    for axis, scene in zip(axes.flat, SCENES):
        points = points_of(results, scene)
        names = front({m: p for m, p in points.items() if m != "prototype"})
        axis.plot([points[m][0] for m in names], [points[m][1] for m in names], color="#d62728", linewidth=1)
        for machine, (cycles, psnr) in points.items():
            preset = machine in marks
            axis.plot(cycles, psnr, marks.get(machine, "o"), markersize=11 if preset else 4, label=machine if preset else None,
                      color={"paper": "#9467bd", "prototype": "#8c564b", "default": "#2ca02c"}.get(machine, "#1f77b4"))
        charts.logarithmic_axis(axis)
        axis.set_title(scene)
        axis.set_xlabel("cycles of a frame")
        axis.set_ylabel("dB against the scene")
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    charts.finish(figure, "Whole frames, loading and trace, against the error to the scene; the Pareto front in red (without the 16x16 prototype)",
                  list(handles.values()), 80, out / "whole_frames.png", out / "whole_frames.svg")


def scene_table(results, scene):
    points = points_of(results, scene)
    best = front({m: p for m, p in points.items() if m != "prototype"})
    lines = []
    for machine in machines_of(scene):
        report = results[scene, machine]
        bits = report["storage_bits"]["total"] + report["load_queue"]["max_bits_per_cell"]
        if machine not in points:
            if machine in PRESETS:
                lines.append([machine, f"{report['verdict']} after {report['cycles']['total']:,} cycles", "", "", "", f"{bits:,}", ""])
            continue
        if machine not in best and machine not in PRESETS:
            continue
        cycles = report["cycles"]
        lines.append([machine, f"{cycles['load']:,}", f"{cycles['precast'] + cycles['trace']:,}", f"{cycles['total']:,}",
                      f"{report['accuracy']['scene']['psnr_db']:.1f}", f"{bits:,}", "yes" if machine in best else ""])
    lines.sort(key=lambda line: (line[3] == "", int(line[3].replace(",", "") or 0)))
    return tables.table(["machine", "load", "trace", "frame", "dB", "bits of a cell", "front"], lines)


def main(root, words):
    scenes, out, cache = programs.scene_study("whole_frames", root, words, __doc__, SCENES)
    jobs = [(s, m) for s in reversed(SCENES) for m in machines_of(s)]  # the longest first
    results = programs.on_all_cores(lambda *job: run(root, scenes, cache, *job), jobs)
    with open(out / "whole_frames.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "machine", "verdict", "load_cycles", "precast_cycles", "trace_cycles", "frame_cycles", "psnr_db",
                         "psnr_polygons_db", "bits_per_cell", "front", "options"])
        for scene in SCENES:
            best = front({m: p for m, p in points_of(results, scene).items() if m != "prototype"})
            for machine in machines_of(scene):
                r = results[scene, machine]
                writer.writerow([scene, machine, r["verdict"], r["cycles"]["load"], r["cycles"]["precast"], r["cycles"]["trace"],
                                 r["cycles"]["total"], f"{r['accuracy']['scene']['psnr_db']:.2f}",
                                 f"{r['accuracy']['tessellation']['psnr_db']:.2f}",
                                 r["storage_bits"]["total"] + r["load_queue"]["max_bits_per_cell"], machine in best, " ".join(MACHINES[machine])])
    draw(out, results)
    text = ["# Whole frames: cycles against the error to the scene\n\nMade by `scripts/study whole_frames`: loading and trace, "
            f"{CELLS} cells (the prototype has 16x16), against the scene itself. Shown are the machines of the Pareto front, which no other one beats "
            "in cycles and dB, and the presets; every run is in `whole_frames.csv`. `bits of a cell`: all that it stores, the fullest cell's "
            f"voxels included. A machine that needs more than {LIMIT:,} cycles is not on the chart.\n\n![Cycles of a frame against dB](whole_frames.png)\n"]
    for scene in SCENES:
        text += [f"## {scene}\n", scene_table(results, scene), ""]
    (out / "whole_frames.md").write_text("\n".join(text))
    print((out / "whole_frames.md").read_text())
