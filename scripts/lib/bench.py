"""Runs raycell_bench case by case, a process each and all cases of an array in turn, and whole jobs; writes what each
costs."""
import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from bench_report import write_chart, write_table

CASES = ["sc_fifo", "cell_module", "cell_tile", "bare_cells", "bare_tokens"]
FIELDS = ["case", "side", "round", "hops", "hops_per_second", "cycles_per_second", "build_seconds", "bytes_per_cell"]
JOB_FIELDS = ["scene", "granularity", "side", "hops", "build", "load", "precast", "trace", "hops_per_second",
              "bytes_per_cell", "peak_memory_bytes"]
LARGE = 512  # cells a side; from there on modules take minutes to build: a third of the rounds
LARGEST_MODULE_JOB = 128  # cells a side; above it modules take minutes


def run_case(program, case, side):
    words = [program, f"--benchmark_filter=^{case}/side:{side}/", "--benchmark_format=json"]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
    try:
        result = json.loads(done.stdout)["benchmarks"][0]
    except (ValueError, LookupError, KeyError):
        sys.exit(f"bench: {' '.join(map(str, words))} ended with {done.returncode}: {done.stderr.strip()}")
    if result.get("error_occurred"):
        sys.exit(f"bench: {case} {side}: {result['error_message']}")
    return {field: result[field] for field in FIELDS[3:]}


def measure_cases(program, sides, rounds):
    rows = []
    for side in sides:
        for turn in range(rounds if side < LARGE else max(1, rounds // 3)):
            for case in CASES:
                rows.append({"case": case, "side": side, "round": turn, **run_case(program, case, side)})
                print(f"{case} {side}, round {turn + 1}: {rows[-1]['hops_per_second'] / 1e6:.2f} M hops/s", flush=True)
        hops = {row["hops"] for row in rows if row["side"] == side}
        if len(hops) != 1:
            sys.exit(f"bench: the cases of {side} x {side} cells made {sorted(hops)} hops; expected one number")
    return rows


def measure_job(program, scene, granularity, side):
    with tempfile.TemporaryDirectory() as folder:
        prefix = pathlib.Path(folder) / "job"
        subprocess.run([str(program), "render", str(scene), "--cells", f"{side}x{side}", "--granularity", granularity,
                        "--quiet", "-o", str(prefix)], check=True)
        report = json.loads(prefix.with_suffix(".json").read_text())
    model = report["model"]
    hops = sum(report["hops"][kind] for kind in ("load", "ray", "return"))
    return {"scene": scene.stem, "granularity": granularity, "side": side, "hops": hops, **model["wall_seconds"],
            "hops_per_second": model["hops_per_second"], "bytes_per_cell": model["bytes_per_cell"],
            "peak_memory_bytes": model["peak_memory_bytes"]}


def write_csv(path, fields, rows):
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def read_csv(path, words):
    with path.open(newline="") as file:
        return [{k: v if k in words else float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def numbers(text):
    return [int(word) for word in text.split(",") if word]


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench")
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path, nargs="?")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--sides", type=numbers, default=[32, 64, 128, 256, 512])
    parser.add_argument("--jobs", type=numbers, default=[64, 128, 256, 512])
    parser.add_argument("--program-folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="results and chart go there")
    parser.add_argument("--from-csv", action="store_true")
    options = parser.parse_args()
    programs = options.program_folder or options.root / "build"
    results = options.out or options.root / "results"
    results.mkdir(parents=True, exist_ok=True)
    cases, jobs = results / "bench.csv", results / "bench_jobs.csv"
    if not options.from_csv:
        write_csv(cases, FIELDS, measure_cases(programs / "raycell_bench", options.sides, options.rounds))
        scene = (options.scenes or options.root.parent / "shared/scenes/spd") / "teapot-s4.nff"
        rows = []
        for side in options.jobs if scene.is_file() else []:
            for granularity in ["tile"] + (["cell"] if side <= LARGEST_MODULE_JOB else []):
                rows.append(measure_job(programs / "raycell", scene, granularity, side))
                print(f"{scene.stem} {side}, {granularity}: {rows[-1]['trace']:.1f} s of tracing", flush=True)
        write_csv(jobs, JOB_FIELDS, rows)
    medians = {}
    rows = read_csv(cases, {"case"})
    for row in rows:
        medians.setdefault((row["case"], int(row["side"])), []).append(row)
    write_table(results / "bench.md", CASES, medians, read_csv(jobs, {"scene", "granularity"}))
    write_chart((options.out or options.root / "docs") / "bench.png", CASES, {
        key: statistics.median(row["hops_per_second"] for row in group) for key, group in medians.items()})


if __name__ == "__main__":
    main()
