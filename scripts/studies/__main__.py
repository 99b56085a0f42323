"""The entry point of scripts/study: calls the study that the user named with the words after the name."""
import importlib
import pathlib
import sys

STUDIES = {
    "accuracy": "studies.accuracy.sweep",
    "deadlock": "studies.deadlock.sweep",
    "time_outs": "studies.time_outs.sweep",
    "sweep": "studies.sweeps.snakemake",
    "datapaths": "studies.datapaths",
    "feed": "studies.feed",
    "trace": "studies.trace",
    "whole_frames": "studies.whole_frames",
    "pixels": "studies.pixels",
    "ladder": "studies.ladder",
    "figures": "studies.figures",
    "stability": "studies.stability",
    "speed": "studies.speed",
    "bench": "studies.bench.measure",
    "report": "studies.report.page",
}


def main(root, name, *words):
    return importlib.import_module(STUDIES[name]).main(pathlib.Path(root), list(words))


sys.exit(main(*sys.argv[1:]))
