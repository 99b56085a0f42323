"""Runs the jobs whose figures the README states, one at a time, and writes docs/measured/figures.md."""
import argparse
import sys

from studies import programs

SCENES = ["teapot-s4", "balls-s2", "mount-s4", "tetra-s4", "gears-s1"]


class Jobs:
    def __init__(self, root, folder):
        self.program, self.folder = root / "build" / "raycell", folder

    def render(self, scene, *words):
        """Renders a scene. Returns the run's JSON and its cost."""
        print("raycell render", scene, *words, file=sys.stderr, flush=True)
        return programs.render(self.program, self.folder / f"{scene}.nff", *words)

    def psnr(self, scene, *words):
        report, _ = self.render(scene, "--engine", "untimed", "--truth", "--arithmetic", "exact", *words)
        return report["accuracy"]["psnr_db"]

    def whole(self):
        lines = ["| job, timed, 20 bits | whole job | peak memory | load, trace cycles | hops |", "|---|---|---|---|---|"]
        for scene, size in [("teapot-s4", "128x128"), ("teapot-s4", "256x256"), ("balls-s4", "128x128")]:
            r, done = self.render(scene, "--cells", size)
            hops = sum(r["hops"].values())
            lines.append(f"| {scene}, {size} | {done.processor:.1f} s | {done.peak_bytes / 2**20:.0f} MB | {r['cycles']['load']}, "
                         f"{r['cycles']['trace']} | {hops} |")
        return lines

    def prices(self):
        variants = [("linear normals, per-hit shadows", []), ("`--normals voxel`", ["--normals", "voxel"]),
                    ("`--shadows precast` (`memo`: equal)", ["--shadows", "precast"]),
                    ("both", ["--normals", "voxel", "--shadows", "precast"])]
        lines = ["| rung `edge` | " + " | ".join(SCENES) + " |", "|---|" + "---|" * len(SCENES)]
        for name, words in variants:
            values = [self.psnr(scene, *words) for scene in SCENES]
            lines.append(f"| {name} | " + " | ".join(f"{v:.1f}" for v in values) + " |")
        return lines

    def offsets(self):
        values = ["0", "1e-8", "1e-6", "1e-4", "1e-3", "1e-2", "5e-2"]
        lines = ["| `--normal-offset` | " + " | ".join(SCENES) + " |", "|---|" + "---|" * len(SCENES)]
        for value in values:
            each = [self.psnr(scene, "--normal-offset", value) for scene in SCENES]
            lines.append(f"| {value} | " + " | ".join(f"{v:.1f}" for v in each) + " |")
        return lines

    def counts(self):
        published = {"balls-s4": {"eye hits": 263169, "reflected": 175095, "shadow rays": 954368},
                     "tetra-s6": {"eye hits": 49788, "shadow rays": 46112}}
        lines = ["| scene | rays | published | `raycell truth --count 513 --cells 512x512` | difference |",
                 "|---|---|---|---|---|"]
        for scene, expected in published.items():
            done = programs.run(self.program, "truth", self.folder / f"{scene}.nff", "--count", "513", "--cells",
                                "512x512", "--quiet")
            found = {line[:14].strip(): int(line[14:]) for line in done.output.splitlines()[1:]}
            for kind, number in expected.items():
                lines.append(f"| {scene} | {kind} | {number} | {found[kind]} | {100 * (found[kind] / number - 1):+.1f} % |")
        return lines


def main(root, words):
    parser = argparse.ArgumentParser(prog="scripts/study figures", description=__doc__)
    parser.add_argument("folder", nargs="?", metavar="SCENE_FOLDER", help="of the SPD scenes")
    programs.add_out(parser, root)
    options = parser.parse_args(words)
    jobs = Jobs(root, programs.spd_folder("figures", root, options.folder))
    out = programs.made(options.out)
    parts = ["# Figures\n\nMade by `scripts/study figures`.\n",
             "## Whole jobs\n\nAs `raycell render SCENE --cells SIZE`, processor seconds on one core of whatever machine this "
             "was; they vary from run to run and machine to machine.\n", "\n".join(jobs.whole()),
             "\n## One normal per voxel, one shadow bit per voxel and source\n\nPSNR in dB, 128x128 cells, "
             "`--exterior host`, `exact`, untimed.\n", "\n".join(jobs.prices()),
             "\n## How far off its polygon a secondary ray starts\n\nPSNR in dB, rung `edge`, 128x128 cells, `exact`, "
             "untimed; "
             "cells.\n", "\n".join(jobs.offsets()),
             "\n## The truth against the SPD's published counts\n\n513x513 rays, tree depth 5 with the eye ray as 1, no "
             "cut by weight.\n", "\n".join(jobs.counts())]
    (out / "figures.md").write_text("\n".join(parts) + "\n")
    table = programs.run(root / "build" / "operators_tb").output
    (out / "operators.md").write_text(
        "# The cell's operators\n\nMeasured over the whole range of arguments by `build/operators_tb`, written by "
        "`scripts/study figures`; `--word-bits N` for other words.\n\n" + table)
    print((out / "figures.md").read_text())
