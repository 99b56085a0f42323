"""Runs the ladder of hit tests over the scenes and writes its tables and its picture."""
import argparse
import csv
import json

from studies import programs

SCENES = ["teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]
RUNGS = ["edge", "mask", "plane", "interval", "depth"]
MODES = {"none": ["--arithmetic", "exact", "--exterior", "none", "--clip-truth"],
         "host": ["--arithmetic", "exact", "--exterior", "host"],
         "fixed": ["--arithmetic", "fixed", "--word-bits", "20", "--exterior", "host"]}
EXTERIOR = {"none": "none", "host": "host", "fixed": "host"}


def run(root, folder, cache, scene, rung, mode):
    """One timed render at 128x128; returns its JSON. A finished run of the same program is not repeated."""
    prefix = cache / f"{scene}.{rung}.{mode}"
    result = prefix.with_name(prefix.name + ".json")
    if not result.exists():
        programs.run(root / "build" / "raycell", "render", folder / f"{scene}.nff", "-o", prefix, "--cells", "128x128",
                     "--depth", "1024", "--shadows", "per-hit", "--normals", "linear", "--hit", rung, "--truth",
                     "--quiet", *MODES[mode])
    return json.loads(result.read_text())


def psnr(report, mode):
    """Of words, against the scene; of exact arithmetic, against its polygons: discretisation alone."""
    accuracy = report["accuracy"]
    return (accuracy["scene"] if mode == "fixed" else accuracy)["psnr_db"]


def table(results, mode):
    lines = ["| rung | " + " | ".join(SCENES) + " |", "|---|" + "---|" * len(SCENES)]
    for rung in RUNGS:
        cells = [f"{psnr(results[s, rung, mode], mode):.1f}" for s in SCENES]
        lines.append(f"| `{rung}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def bits_table(results):
    lines = ["| rung | bits per voxel | voxels | load cycles | trace cycles |", "|---|---|---|---|---|"]
    for rung in RUNGS:
        each = [results[s, rung, "fixed"] for s in SCENES]
        bits = [r["voxels"]["bits_each"] for r in each]
        voxels = [r["voxels"]["stored"] for r in each]
        load, trace = ([r["cycles"][phase] for r in each] for phase in ("load", "trace"))
        span = f"{min(bits):.0f}" if min(bits) == max(bits) else f"{min(bits):.0f} to {max(bits):.0f}"
        lines.append(f"| `{rung}` | {span} | {min(voxels)} to {max(voxels)} | {min(load)} to {max(load)} | "
                     f"{min(trace)} to {max(trace)} |")
    return "\n".join(lines)


def draw(out, cache, results, scene):
    from matplotlib import pyplot as plt  # needed only here
    figure, axes = plt.subplots(2, len(RUNGS), figsize=(3.1 * len(RUNGS), 6.6))
    for column, rung in enumerate(reversed(RUNGS)):
        prefix = cache / f"{scene}.{rung}.fixed"
        report = results[scene, rung, "fixed"]
        top, bottom = axes[0][column], axes[1][column]
        top.imshow(plt.imread(f"{prefix}.png"), interpolation="nearest")
        top.set_title(f"{rung}: {psnr(report, 'fixed'):.1f} dB\n{report['voxels']['bits_each']:.0f} bits per voxel")
        bottom.imshow(plt.imread(f"{prefix}.difference.png"), interpolation="nearest")
        for axis in (top, bottom):
            axis.set_xticks([])
            axis.set_yticks([])
    axes[0][0].set_ylabel(f"{scene}, 128x128 cells, words of 20 bits")
    axes[1][0].set_ylabel("difference from the truth, x8")
    figure.tight_layout()
    figure.savefig(out / "ladder.png", dpi=72)


def main(root, words):
    parser = argparse.ArgumentParser(prog="scripts/study ladder", description=__doc__)
    parser.add_argument("folder", nargs="?", metavar="SCENE_FOLDER", help="of the SPD scenes")
    programs.add_out(parser, root)
    options = parser.parse_args(words)
    folder = programs.spd_folder("ladder", root, options.folder)
    out = programs.made(options.out)
    cache = programs.cache_of(root, out, "ladder")
    jobs = [(s, r, m) for s in SCENES for r in RUNGS for m in MODES]
    results = programs.on_all_cores(lambda *job: run(root, folder, cache, *job), jobs)

    with open(out / "ladder.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "hit", "arithmetic", "exterior", "psnr_db", "wrong_hit_percent", "off_by_0_1_percent",
                         "bits_per_voxel", "voxels", "load_cycles", "trace_cycles"])
        for scene, rung, mode in jobs:
            r = results[scene, rung, mode]
            writer.writerow([scene, rung, "fixed" if mode == "fixed" else "exact", EXTERIOR[mode], f"{psnr(r, mode):.2f}",
                             f"{r['accuracy']['wrong_hit_percent']:.3f}", f"{r['accuracy']['off_by_0_1_percent']:.3f}",
                             f"{r['voxels']['bits_each']:.1f}", r["voxels"]["stored"], r["cycles"]["load"],
                             r["cycles"]["trace"]])
    text = f"""# The ladder of hit tests, measured

Timed engine, 128x128 cells, depth 1024, per-hit shadows, linear normals; PSNR in dB (200: equal). Made by
`scripts/study ladder`; every row is in `ladder.csv`.

Words of 20 bits, `--exterior host`, against the scene itself, what its polygons cost included:

{table(results, "fixed")}

`--arithmetic exact`, the same, against its polygons: what is lost is discretisation alone.

{table(results, "host")}

`--arithmetic exact --exterior none` against the truth clipped to the cube:

{table(results, "none")}

What a rung costs (20 bits, `--exterior host`, the range over the five scenes):

{bits_table(results)}
"""
    (out / "ladder.md").write_text(text)
    draw(out, cache, results, "teapot-s4")
    print(text)
