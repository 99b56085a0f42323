"""How a study runs one program to its end and measures its cost. Sweeps, which run many at a time and can be stopped,
have their own way in sweeps/runs.py."""
import argparse
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time


@dataclasses.dataclass
class Done:
    output: str  # standard output
    wall: float  # seconds
    processor: float  # seconds, over all cores
    peak_bytes: int


class Failed(Exception):
    """A program ended with an exit code other than 0: the command, the code and its last output."""


def add_out(parser, root):
    """Adds --out, the folder of the tables and charts; nothing is written over the project's own unless it is named."""
    parser.add_argument("--out", type=pathlib.Path, metavar="FOLDER", default=measured(root),
                        help="of the tables and charts; default: out/measured")


def measured(root):
    """The default folder of tables and charts."""
    return root / "out" / "measured"


def made(folder):
    """The folder, made if it is not there."""
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def run(*words):
    """Runs a program. Throws Failed."""
    words = list(map(str, words))
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        began = time.monotonic()
        child = subprocess.Popen(words, stdout=output, stderr=errors)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.monotonic() - began
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        if child.returncode:
            raise Failed(f"{' '.join(words)} ended with {child.returncode}: {errors.read().strip()}")
        return Done(output.read(), wall, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss)


def render(program, scene, *words):
    """Renders a scene into a temporary folder; returns its JSON and the process's cost."""
    with tempfile.TemporaryDirectory() as folder:
        prefix = pathlib.Path(folder) / "run"
        done = run(program, "render", scene, "--quiet", "-o", prefix, *words)
        return json.loads(prefix.with_suffix(".json").read_text()), done


def cache_of(root, out, study):
    """A folder for finished runs of a study: of this very program, so that a changed one repeats them."""
    program = hashlib.sha256((root / "build" / "raycell").read_bytes()).hexdigest()[:12]
    return made(out / "cache" / f"{study}-{program}")


def on_all_cores(run, jobs):
    """Calls run(*job) for all jobs, as many at a time as there are cores. Returns the results by job."""
    results = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        futures = {pool.submit(run, *job): job for job in jobs}
        for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
            results[futures[future]] = future.result()
            print(f"\r{done} of {len(jobs)} runs", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return results


def scene_study(study, root, words, description, scenes):
    """What the studies of whole scenes begin with: reads their options, and returns the scenes' files by name, the
    folder of the tables and the cache of runs."""
    parser = argparse.ArgumentParser(prog=f"scripts/study {study}", description=description)
    parser.add_argument("folder", nargs="?", metavar="SCENE_FOLDER", help="of the SPD scenes")
    add_out(parser, root)
    options = parser.parse_args(words)
    folder = spd_folder(study, root, options.folder)
    files = {s: folder / f"{s}.nff" if s != "still_life" else root / "scenes" / "still_life.nff" for s in scenes}
    out = made(options.out)
    return files, out, cache_of(root, out, study)


def spd_folder(study, root, folder):
    """The folder of the SPD scenes: `folder`, or the one beside the project. Ends the study if it is missing."""
    folder = pathlib.Path(folder or root.parent / "shared" / "scenes" / "spd")
    if not folder.is_dir():
        sys.exit(f"study {study}: {folder} is missing; expected the folder of the SPD scenes")
    return folder
