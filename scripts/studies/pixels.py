"""Renders one picture with arrays of 16x16 to 256x256 cells, and pictures with more samples of a pixel and of a light source, and writes their
cycles, bits and errors."""
import json
import subprocess

from studies import programs, tables

SCENES = ["still_life", "teapot-s4", "balls-s2"]
PIXELS = "256x256"
CELLS = [16, 32, 64, 128, 256]
SMALL_PIXELS = "64x64"  # where the smallest M is looked for
SMALL_CELLS = [4, 8, 16, 32, 64]
# Of a picture of as many pixels as cells.
SAMPLED_CELLS = "128x128"
SAMPLES = {"1": [], "4": ["--samples", 4], "16": ["--samples", 16], "16, 4 where they agree within 1/64": ["--samples", 16, "--sample-until", 0.015625],
           "64": ["--samples", 64], "16, `tent`": ["--samples", 16, "--filter", "tent"]}
LAMP = "CornellBox-Original"
LAMP_CELLS = "64x64"
LIGHTS = [1, 2, 4, 8, 16, 32, 64]
SHADOWS = ["per-hit", "memo", "precast"]


def run(root, cache, name, scene, *words):
    """The JSON of a whole run. A finished run of the same program is not repeated."""
    prefix = cache / name
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        programs.run(root / "build" / "raycell", "render", scene, "-o", prefix, "--quiet", *words)
    return json.loads(result.read_text())


def picture(root, scenes, cache, scene, cells):
    return run(root, cache, f"{scene}.{cells}", scenes[scene], "--cells", f"{cells}x{cells}", "--pixels", PIXELS)


def exact(root, scenes, cache, scene, cells):
    """dB between the pictures of this array and of the largest one, in exact arithmetic without offsets."""
    how = ["--engine", "untimed", "--arithmetic", "exact", "--normal-offset", 0, "--pixels", PIXELS]
    for size in {cells, CELLS[-1]}:
        run(root, cache, f"{scene}.exact.{size}", scenes[scene], "--cells", f"{size}x{size}", *how)
    done = programs.run(root / "build" / "raycell", "compare", cache / f"{scene}.exact.{cells}.exr", cache / f"{scene}.exact.{CELLS[-1]}.exr", "--json")
    return json.loads(done.output)["psnr_db"]


def ends(root, scenes, cache, scene, cells, store):
    """Whether the machine with so many slots finishes, within 40 times the cycles of the default's."""
    size = ["--cells", f"{cells}x{cells}", "--pixels", SMALL_PIXELS]
    limit = 40 * run(root, cache, f"{scene}.small.{cells}", scenes[scene], *size)["cycles"]["trace"]
    prefix = cache / f"{scene}.small.{cells}.{store}"
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():  # a run that does not end has an exit code of its own
        subprocess.run([str(word) for word in [root / "build" / "raycell", "render", scenes[scene], "-o", prefix, "--quiet", "--ray-store", store,
                                               "--max-cycles", limit, *size]], check=False, capture_output=True)
    return json.loads(result.read_text())["verdict"] == "completed"


def sampled(root, scenes, cache, scene, samples):
    name = f"{scene}.samples.{list(SAMPLES).index(samples)}"
    # One sample is compared with the same converged pictures as four.
    report = run(root, cache, name, scenes[scene], "--cells", SAMPLED_CELLS, "--truth", *SAMPLES[samples])
    if samples != "1":
        return report, report["accuracy"]["scene"]["psnr_db"]
    run(root, cache, f"{scene}.samples.{list(SAMPLES).index('4')}", scenes[scene], "--cells", SAMPLED_CELLS, "--truth", *SAMPLES["4"])
    done = programs.run(root / "build" / "raycell", "compare", cache / f"{name}.exr",
                        cache / f"{scene}.samples.{list(SAMPLES).index('4')}.truth.exr", "--json")
    return report, json.loads(done.output)["psnr_db"]


def lamp(root, scene, cache, lights, shadows):
    report = run(root, cache, f"{LAMP}.{lights}.{shadows}", scene, "--cells", LAMP_CELLS, "--source-samples", lights, "--shadows", shadows, "--truth",
                 "--truth-samples", 1024)
    return report, report["accuracy"]["scene"]["psnr_db"]


def stored(report):
    """Bits of all cells: what each stores beside its voxels, and the voxels."""
    wide, high = map(int, report["config"]["cells"].split("x"))
    return wide * high * report["storage_bits"]["total"] + report["voxels"]["bits_total"]


def hops(report):
    return sum(report["hops"].values()) if isinstance(report["hops"], dict) else report["hops"]


def cells_table(results, alike, smallest):
    lines = []
    for scene in SCENES:
        for cells, small in zip(CELLS, SMALL_CELLS):
            r = results[scene, cells]
            lines.append([scene, f"{cells}x{cells}", f"{r['cycles']['load']:,}", f"{r['cycles']['trace']:,}", f"{r['storage_bits']['total']:,}",
                          f"{r['voxels']['max_per_cell']:,}", f"{stored(r) / 1e6:,.1f}", f"{hops(r) / 1e6:,.1f}", smallest[scene, small],
                          f"{r['losses']['sample']['psnr_db']:.1f}", f"{alike[scene, cells]:.0f}"])
    return tables.table(["scene", "cells", "load", "trace", "bits of a cell", "most voxels", "bits in all, millions", "hops, millions", "smallest M",
                         "words, dB", "exact, dB"], lines)


def samples_table(results):
    lines = []
    for samples in SAMPLES:
        line = [samples]
        for scene in SCENES:
            report, psnr = results[scene, samples]
            line += [f"{psnr:.1f}", f"{report['rays']['primary'] / 128 ** 2:.1f}", f"{report['cycles']['trace']:,}"]
        lines.append(line + [f"{results[SCENES[0], samples][0]['storage_bits']['total']:,}"])
    return tables.table(["samples"] + [f"{scene}: {what}" for scene in SCENES for what in ("dB", "sent", "trace")] + ["bits of a cell"], lines)


def lights_table(results):
    lines = []
    for lights in LIGHTS:
        for shadows in SHADOWS:
            report, psnr = results[lights, shadows]
            lines.append([lights, shadows, f"{psnr:.1f}", f"{report['cycles']['precast'] + report['cycles']['trace']:,}",
                          f"{report['storage_bits']['total']:,}", f"{report['voxels']['max_bits_per_cell']:,}"])
    return tables.table(["light samples", "shadows", "dB", "cycles", "bits of a cell", "fullest cell's voxels, bits"], lines)


def draw(out, pictures, samples, lights):
    from studies import charts  # needs Matplotlib
    figure, axes = charts.panels(1, 3, 15, 4.4)
    colours = dict(zip(SCENES + [LAMP], ["#1f77b4", "#d62728", "#2ca02c", "#9467bd"]))
    for scene in SCENES:
        points = [pictures[scene, cells] for cells in CELLS]
        axes[0][0].plot([stored(r) / 1e6 for r in points], [r["cycles"]["total"] for r in points], "o-", color=colours[scene], label=scene)
        for cells, r in zip(CELLS, points):
            axes[0][0].annotate(f"{cells}", (stored(r) / 1e6, r["cycles"]["total"]), textcoords="offset points", xytext=(4, 4), fontsize=7)
        plain = ["1", "4", "16", "64"]
        axes[0][1].plot([samples[scene, s][0]["cycles"]["trace"] for s in plain], [samples[scene, s][1] for s in plain], "o-", color=colours[scene])
        until = samples[scene, "16, 4 where they agree within 1/64"]
        axes[0][1].plot(until[0]["cycles"]["trace"], until[1], "*", markersize=11, color=colours[scene])
    for shadows, mark in zip(SHADOWS, ["o-", "s--", "^:"]):
        points = [lights[n, shadows] for n in LIGHTS]
        axes[0][2].plot([r["cycles"]["precast"] + r["cycles"]["trace"] for r, _ in points], [psnr for _, psnr in points], mark, color=colours[LAMP],
                        label=f"{LAMP}, {shadows}")
    titles = [f"{PIXELS} pixels from 16x16 to 256x256 cells", f"1, 4, 16, 64 samples a pixel (star: 16 or 4), {SAMPLED_CELLS}", f"1 to 64 samples of a lamp, {LAMP_CELLS}"]
    for axis, title in zip(axes[0], titles):
        axis.set_title(title)
        charts.logarithmic_axis(axis)
        axis.set_xlabel("cycles of the trace")
        axis.set_ylabel("dB against the converged scene")
    axes[0][0].set_yscale("log")
    axes[0][0].set_xlabel("bits of all cells, millions")
    axes[0][0].set_ylabel("cycles of a frame")
    handles = [handle for axis in axes[0] for handle in axis.get_legend_handles_labels()[0]]
    charts.finish(figure, "Fewer cells than pixels, more samples than pixels", handles, 80, out / "pixels.png", out / "pixels.svg")


def smallest_stores(root, scenes, cache):
    found = {}
    for store in range(1, 9):
        jobs = [(s, c, store) for s in SCENES for c in SMALL_CELLS if (s, c) not in found]
        for (scene, cells, _), ended in programs.on_all_cores(lambda *job: ends(root, scenes, cache, *job), jobs).items():
            if ended:
                found[scene, cells] = store
    return found


def main(root, words):
    scenes, out, cache = programs.scene_study("pixels", root, words, __doc__, SCENES)
    box = scenes[SCENES[-1]].parent.parent / "obj" / f"{LAMP}.obj"
    small = [(s, c) for s in SCENES for c in SMALL_CELLS]
    programs.on_all_cores(lambda s, c: run(root, cache, f"{s}.small.{c}", scenes[s], "--cells", f"{c}x{c}", "--pixels", SMALL_PIXELS), small)
    smallest = smallest_stores(root, scenes, cache)
    jobs = [(s, c) for c in CELLS for s in SCENES]
    pictures = programs.on_all_cores(lambda *job: picture(root, scenes, cache, *job), jobs)
    for scene in SCENES:  # first, so that no two make them at once
        exact(root, scenes, cache, scene, CELLS[-1])
    alike = programs.on_all_cores(lambda *job: exact(root, scenes, cache, *job), jobs)
    for scene in SCENES:
        sampled(root, scenes, cache, scene, "4")
    samples = programs.on_all_cores(lambda *job: sampled(root, scenes, cache, *job), [(s, n) for s in SCENES for n in SAMPLES])
    lights = programs.on_all_cores(lambda *job: lamp(root, box, cache, *job), [(n, s) for n in LIGHTS for s in SHADOWS])
    draw(out, pictures, samples, lights)
    text = ["# Pixels, samples, light samples\n\nMade by `scripts/study pixels`, on the default machine.\n\n![Cycles, bits and errors](pixels.png)\n",
            f"## The same picture by other arrays\n\n{PIXELS} pixels. `bits of a cell`: without its voxels; `in all`: of all cells, with their voxels. `smallest M`: with "
            f"which a picture of {SMALL_PIXELS} pixels from as many pixels a cell ends (the argument asks for 5). `words`: a sample of "
            "pixels in words of 20 bits against the exact truth of the polygons. `exact`: the whole picture, in exact arithmetic with "
            f"`--normal-offset 0`, against that of {CELLS[-1]}x{CELLS[-1]} cells.\n", cells_table(pictures, alike, smallest),
            f"\n## Samples of a pixel\n\n{SAMPLED_CELLS} cells, against the scene's converged truth (256 samples, by the same filter); `sent`: samples of a pixel, mean.\n",
            samples_table(samples), f"\n## Samples of a light source\n\n{LAMP} by its own lamp, {LAMP_CELLS} cells, against the scene with 1024 samples.\n",
            lights_table(lights)]
    (out / "pixels.md").write_text("\n".join(text) + "\n")
    print((out / "pixels.md").read_text())
