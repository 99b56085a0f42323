"""The one way in which a study runs a program to its end, and what the process took. (Sweeps, which run many at a time
and can be stopped, build on it in sweeps/runs.py.)"""
import dataclasses
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
    """A program that ended with another exit code than 0: the command, the code and its last words."""


def measured(root):
    """The folder of the measured tables and charts."""
    return root / "docs" / "measured"


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
    """Renders a scene into a folder that is gone afterwards; returns its JSON and what the process took."""
    with tempfile.TemporaryDirectory() as folder:
        prefix = pathlib.Path(folder) / "run"
        done = run(program, "render", scene, "--quiet", "-o", prefix, *words)
        return json.loads(prefix.with_suffix(".json").read_text()), done


def spd_folder(study, root, folder):
    """The folder of the SPD scenes: `folder`, or where it lies beside the project. Ends the study if there is none."""
    folder = pathlib.Path(folder or root.parent / "shared" / "scenes" / "spd")
    if not folder.is_dir():
        sys.exit(f"study {study}: {folder} is missing; expected the folder of the SPD scenes")
    return folder
