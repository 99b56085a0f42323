#!/usr/bin/python3
"""usage: documents_test.py commands|words ROOT BUILD

`commands`: runs every command of the documents' blocks, in their order, as on a fresh clone, but in small arrays, and
expects exit code 0 or the one that its comment names. `words`: expects every option, key of a report and column of a table
in the documents.
"""
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

# Run by other tests, or for other machines: their options are tried with --help alone, or not at all.
HELP_ONLY = ("scripts/render", "scripts/test", "scripts/study", "scripts/rtl_gates")
NOT_HERE = ("cmake", "gtkwave", "export", "snakemake")
SMALL = {"render": "32x32", "truth": "32x32", "size": "12x12"}
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def documents(root):
    found = [root / "README.md", root / "cells/deadlock/deadlock.md", *sorted((root / "docs").glob("*/*.md"))]
    found += sorted(root.glob("*/README.md"))
    return [path for path in found if path.parent.name != "measured"]


def commands_of(text):
    """(line, words, exit codes that are allowed) of each command in a block of the text."""
    for block in re.findall(r"^ *```\w*\n(.*?)^ *```", text, re.S | re.M):
        for line in block.splitlines():
            line = line.strip().removeprefix("$ ")
            command, _, comment = line.partition(" #")
            words = shlex.split(command)
            if not words or not re.match(r"(build|scripts)/|mpirun|" + "|".join(NOT_HERE), words[0]):
                continue
            named = re.search(r"exit code (\d)", comment)
            yield line, words, [int(named.group(1))] if named else [0]


def smaller(words):
    """The command in a small array, or None where it is not for this test."""
    if words[0] in NOT_HERE:
        return None
    if words[0] in HELP_ONLY:
        if words[:2] == ["scripts/study", "report"]:
            return words
        return words[:2] + ["--help"] if words[0] == "scripts/study" else [words[0], "--help"]
    if words[0] == "mpirun":
        return ["mpirun", "-q", "--oversubscribe", *words[1:], "--cells", "24x24"]
    if words[0] == "build/raycell" and words[1] in SMALL and "--config" not in words:
        return words + ["--cells", SMALL[words[1]]]
    if words[:2] == ["build/raycell", "sweep"] and "--dry-run" not in words:
        # A sweep of a few runs: of ranges and lists the first two values.
        few = [re.sub(r"^(\d+)\.\.\d+(:\d+)?$", r"\1", w) for w in words]
        return few + (["--max-cycles", "300000"] if "--config" not in words else ["--dry-run"])
    return words


def fresh_clone(root, build, folder):
    for entry in root.iterdir():
        if entry.name not in ("build", "out", ".git"):
            (folder / entry.name).symlink_to(entry)
    (folder / "build").symlink_to(build)


def run_commands(root, build):
    failures = 0
    for document in documents(root):
        with tempfile.TemporaryDirectory(prefix="raycell_documents_") as name:
            folder = pathlib.Path(name)
            fresh_clone(root, build, folder)
            for line, words, allowed in commands_of(document.read_text()):
                words = smaller(words)
                if not words:
                    continue
                done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False,
                                      env={**os.environ, **MPI}, timeout=600)
                # In a small array a picture may be further from the truth than asked for, or not lock.
                fine = done.returncode in allowed or ("size" in words and done.returncode == 2)
                print(f"{'ok' if fine else 'FAILED'}: {document.relative_to(root)}: {line}", flush=True)
                if not fine:
                    failures += 1
                    print(f"  {' '.join(words)}\n  exit code {done.returncode}\n{done.stderr[-800:]}", flush=True)
            left = [entry.name for entry in folder.iterdir() if not entry.is_symlink() and entry.name != "out"]
            if left:
                failures += 1
                print(f"FAILED: {document.relative_to(root)}: files outside out/: {left}")
    return failures


def keys_of(report, path=""):
    """Names of a report's keys, those excepted that are a machine's or a user's: formats, classes, options."""
    named_elsewhere = {"/config", "/formats", "/buffers/peak", "/buffers/mean", "/deadlock/report"}
    if path in named_elsewhere:
        return
    if isinstance(report, dict):
        for key, value in report.items():
            yield key, f"{path}/{key}"
            yield from keys_of(value, f"{path}/{key}")
    elif isinstance(report, list) and report:
        yield from keys_of(report[0], path)


def missing_words(root, build):
    text = "\n".join(path.read_text() for path in documents(root))
    words = set(re.findall(r"[A-Za-z_][A-Za-z0-9_]*", text))
    options = set(re.findall(r"--[a-z][a-z-]*", text))
    with tempfile.TemporaryDirectory(prefix="raycell_documents_") as name:
        def run(*command):
            return subprocess.run([str(w) for w in command], cwd=name, capture_output=True, text=True, check=False)
        for command in [("raycell", c) for c in ("render", "truth", "compare", "size", "sweep")] + [
                ("deadlock_tb",), ("cell_tb",), ("loading_tb",), ("microcode_tb",)]:
            help_text = run(build / command[0], *command[1:], "--help").stdout
            for option in re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", help_text, re.M):
                if option not in options | {"--help"}:
                    yield f"option {option} of {' '.join(command)}"
        runs = [("raycell", "render", root / "scenes/cornell.nff", "--cells", "16x16", "--truth", "--ray-store", "2",
                 "--film", "8", "--rays"),
                ("raycell", "render", root / "scenes/cornell.nff", "--cells", "8x8", "--truth", "--frames",
                 root / "scenes/cornell_walk.frames"),
                ("raycell", "render", root / "scenes/facing_mirrors.nff", "--cells", "32x32", "--networks", "split"),
                ("deadlock_tb", "--networks", "shared"), ("loading_tb", root / "scenes/cornell.nff", "--cells", "16x16")]
        for program, *rest in runs:
            run(build / program, *rest, "--quiet", "-o", "run")
            for report in sorted(pathlib.Path(name).glob("run*.json")):
                for key, path in keys_of(json.loads(report.read_text())):
                    if key not in words:
                        yield f"key {path} of {program}, {report.name}"
            for table in pathlib.Path(name).glob("run.*.csv"):
                for column in table.read_text().split("\n", 1)[0].split(","):
                    if column not in words:
                        yield f"column {column} of {table.name}"
            for old in pathlib.Path(name).glob("run.*"):
                old.unlink()


def main(what, root, build):
    root, build = pathlib.Path(root).resolve(), pathlib.Path(build).resolve()
    if what == "commands":
        return run_commands(root, build)
    missing = sorted(set(missing_words(root, build)))
    for word in missing:
        print(f"not in the documents: {word}")
    return len(missing)


sys.exit(1 if main(*sys.argv[1:]) else 0)
