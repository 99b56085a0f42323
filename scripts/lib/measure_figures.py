"""Runs the jobs whose figures the README states, one at a time, and writes results/figures.md."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT, FOLDER = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SCENES = ["teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]


def raycell(*words):
    """Runs the program; returns standard output, processor seconds (one core) and peak memory in MB."""
    print("raycell", *words, file=sys.stderr, flush=True)
    with tempfile.TemporaryFile("w+") as output:
        child = subprocess.Popen([str(ROOT / "build" / "raycell"), *map(str, words)], stdout=output)
        _, status, usage = os.wait4(child.pid, 0)
        if status != 0:
            sys.exit(f"measure_figures: raycell {' '.join(map(str, words))} failed")
        output.seek(0)
        return output.read(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def render(scene, *words):
    with tempfile.TemporaryDirectory() as folder:
        _, seconds, memory = raycell("render", scene, "-o", f"{folder}/a", "--quiet", *words)
        return json.loads(pathlib.Path(f"{folder}/a.json").read_text()), seconds, memory


def jobs():
    lines = ["| job, timed, 20 bits | whole job | peak memory | load, trace cycles | hops |", "|---|---|---|---|---|"]
    for scene, size in [("teapot-s4", "128x128"), ("teapot-s4", "256x256"), ("balls-s4", "128x128")]:
        r, seconds, memory = render(FOLDER / f"{scene}.nff", "--cells", size)
        hops = sum(r["hops"].values())
        lines.append(f"| {scene}, {size} | {seconds:.1f} s | {memory:.0f} MB | {r['cycles']['load']}, "
                     f"{r['cycles']['trace']} | {hops} |")
    return lines


def prices():
    variants = [("linear normals, per-hit shadows", []), ("`--normals voxel`", ["--normals", "voxel"]),
                ("`--shadows precast` (`memo`: equal)", ["--shadows", "precast"]),
                ("both", ["--normals", "voxel", "--shadows", "precast"])]
    lines = ["| rung `edge` | " + " | ".join(SCENES) + " |", "|---|" + "---|" * len(SCENES)]
    for name, words in variants:
        values = [render(FOLDER / f"{s}.nff", "--engine", "untimed", "--truth", "--arithmetic", "exact",
                         *words)[0]["accuracy"]["psnr_db"]
                  for s in SCENES]
        lines.append(f"| {name} | " + " | ".join(f"{v:.1f}" for v in values) + " |")
    return lines


def offsets():
    values = ["0", "1e-8", "1e-6", "1e-4", "1e-3", "1e-2", "5e-2"]
    lines = ["| `--normal-offset` | " + " | ".join(SCENES) + " |", "|---|" + "---|" * len(SCENES)]
    for value in values:
        each = [render(FOLDER / f"{s}.nff", "--engine", "untimed", "--truth", "--arithmetic", "exact",
                       "--normal-offset", value)[0]
                for s in SCENES]
        lines.append(f"| {value} | " + " | ".join(f"{r['accuracy']['psnr_db']:.1f}" for r in each) + " |")
    return lines


def counts():
    published = {"balls-s4": {"eye hits": 263169, "reflected": 175095, "shadow rays": 954368},
                 "tetra-s6": {"eye hits": 49788, "shadow rays": 46112}}
    lines = ["| scene | rays | published | `raycell truth --count 513 --cells 512x512` | difference |",
             "|---|---|---|---|---|"]
    for scene, expected in published.items():
        text, _, _ = raycell("truth", FOLDER / f"{scene}.nff", "--count", "513", "--cells", "512x512", "--quiet")
        found = {line[:14].strip(): int(line[14:]) for line in text.splitlines()[1:]}
        for kind, number in expected.items():
            lines.append(f"| {scene} | {kind} | {number} | {found[kind]} | {100 * (found[kind] / number - 1):+.1f} % |")
    return lines


def main():
    if not FOLDER.is_dir():
        sys.exit(f"measure_figures: {FOLDER} is missing; expected the folder of the SPD scenes")
    parts = ["# Figures\n\nMade by `scripts/measure_figures`.\n",
             "## Whole jobs\n\nAs `raycell render SCENE --cells SIZE`, processor seconds on one core of whatever machine this "
             "was; they vary from run to run and machine to machine.\n", "\n".join(jobs()),
             "\n## One normal per voxel, one shadow bit per voxel and source\n\nPSNR in dB, 128x128 cells, "
             "`--exterior host`, `exact`, untimed.\n", "\n".join(prices()),
             "\n## How far off its polygon a secondary ray starts\n\nPSNR in dB, rung `edge`, 128x128 cells, `exact`, "
             "untimed; "
             "cells.\n", "\n".join(offsets()),
             "\n## The truth against the SPD's published counts\n\n513x513 rays, tree depth 5 with the eye ray as 1, no "
             "cut by weight.\n", "\n".join(counts())]
    (ROOT / "results" / "figures.md").write_text("\n".join(parts) + "\n")
    table = subprocess.run([ROOT / "build" / "operators_tb"], check=True, capture_output=True, text=True).stdout
    (ROOT / "results" / "operators.md").write_text(
        "# The cell's operators\n\nMeasured over the whole range of arguments by `build/operators_tb`, written by "
        "`scripts/measure_figures`; `--word-bits N` for other words.\n\n" + table)
    print((ROOT / "results" / "figures.md").read_text())


main()
