"""Runs raycell_bench case by case, a process each and all cases of an array in turn, and whole jobs; writes what each
costs. A bench that was stopped goes on where it was."""
import argparse
import json
import pathlib
import statistics
import sys

from studies import programs
from studies.bench.growth import FIELDS as GROWTH_FIELDS
from studies.bench.growth import KEYS as GROWTH_KEYS
from studies.bench.growth import Design, measure_growth, scenes_of
from studies.bench.rows import Rows, made_by, read_numbers

CASES = ["sc_fifo", "cell_module", "cell_tile", "bare_cells", "bare_tokens"]
KEYS = ["case", "side", "round"]
FIELDS = ["hops", "hops_per_second", "cycles_per_second", "build_seconds", "bytes_per_cell"]
JOB_KEYS = ["scene", "granularity", "side"]
JOB_FIELDS = ["hops", "build", "load", "precast", "trace", "hops_per_second", "bytes_per_cell", "peak_memory_bytes"]
PARTS = ["cases", "jobs", "growth"]
LARGE = 512  # cells a side; from here on modules take minutes to build, so only a third of the rounds is made
LARGEST_MODULE_JOB = 128  # cells a side; above it modules take minutes


def run_case(program, case, side):
    try:
        done = programs.run(program, f"--benchmark_filter=^{case}/side:{side}/", "--benchmark_format=json")
        result = json.loads(done.output)["benchmarks"][0]
    except (programs.Failed, ValueError, LookupError) as error:
        sys.exit(f"study bench: {case} {side}: {error}")
    if result.get("error_occurred"):
        sys.exit(f"study bench: {case} {side}: {result['error_message']}")
    return {field: result[field] for field in FIELDS}


def measure_cases(program, sides, rounds, rows):
    """Measures all cases. An unfinished round is repeated as a whole: ratios need runs that follow each other."""
    maker = made_by(program)
    keys = []
    for side in sides:
        for turn in range(rounds if side < LARGE else max(1, rounds // 3)):
            group = [(case, side, turn) for case in CASES]
            keys += group
            if all(rows.have(key, maker) for key in group):
                continue
            for case in CASES:
                row = {"case": case, "side": side, "round": turn, **run_case(program, case, side), "made_by": maker}
                rows.add(row)
                print(f"{case} {side}, round {turn + 1}: {row['hops_per_second'] / 1e6:.2f} M hops/s", flush=True)
        hops = {float(rows.rows[tuple(map(str, key))]["hops"]) for key in keys if key[1] == side}
        if len(hops) != 1:
            sys.exit(f"study bench: the cases of {side} x {side} cells made {sorted(hops)} hops; expected one number")
    rows.finish(keys)


def measure_job(program, scene, granularity, side):
    try:
        report, _ = programs.render(program, scene, "--cells", f"{side}x{side}", "--granularity", granularity)
    except programs.Failed as error:
        sys.exit(f"study bench: {error}")
    model = report["model"]
    hops = sum(report["hops"][kind] for kind in ("load", "ray", "return"))
    return {"scene": scene.stem, "granularity": granularity, "side": side, "hops": hops, **model["wall_seconds"],
            "hops_per_second": model["hops_per_second"], "bytes_per_cell": model["bytes_per_cell"],
            "peak_memory_bytes": model["peak_memory_bytes"]}


def measure_jobs(program, scene, sides, rows):
    if not scene.is_file():
        return rows.finish([])
    maker = made_by(program, scene)
    keys = [(scene.stem, granularity, side) for side in sides
            for granularity in ["tile"] + (["cell"] if side <= LARGEST_MODULE_JOB else [])]
    for _, granularity, side in keys:
        if rows.have((scene.stem, granularity, side), maker):
            continue
        row = measure_job(program, scene, granularity, side)
        rows.add({**row, "made_by": maker})
        print(f"{scene.stem} {side}, {granularity}: {row['trace']:.1f} s of tracing", flush=True)
    return rows.finish(keys)


def numbers(text):
    return [int(word) for word in text.split(",") if word]


def parts(text):
    chosen = text.split(",")
    for part in chosen:
        if part not in PARTS:
            raise argparse.ArgumentTypeError(f"expected some of {', '.join(PARTS)}, not '{part}'")
    return chosen


def parse(words):
    parser = argparse.ArgumentParser(prog="scripts/study bench", description=__doc__)
    parser.add_argument("scenes", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", type=parts, default=PARTS, help=f"some of {','.join(PARTS)}")
    parser.add_argument("--rounds", type=int, help="of the cases (5) and of the growth (1)")
    parser.add_argument("--sides", type=numbers, default=[32, 64, 128, 256, 512], help="arrays of the cases")
    parser.add_argument("--jobs", type=numbers, default=[64, 128, 256, 512], help="arrays of the jobs")
    parser.add_argument("--growth-sides", type=numbers, default=[32, 64, 128, 256, 512],
                        help="arrays that a job grows by")
    parser.add_argument("--growth-side", type=int, default=128, help="array of the other series")
    parser.add_argument("--precast-side", type=int, default=128, help="largest array with precast shadows")
    parser.add_argument("--depths", type=numbers, default=[64, 128, 256, 512, 1024, 2048, 4096])
    parser.add_argument("--max-depths", type=numbers, default=[0, 1, 2, 3, 4])
    parser.add_argument("--again", action="store_true", help="make every run again")
    parser.add_argument("--program-folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="results and charts go there")
    parser.add_argument("--from-csv", action="store_true")
    return parser.parse_intermixed_args(words)  # the scenes may come last


def measure(root, options, results):
    folder_of_programs = options.program_folder or root / "build"
    folder = options.scenes or root.parent / "shared/scenes/spd"
    if "cases" in options.only:
        measure_cases(folder_of_programs / "raycell_bench", options.sides, options.rounds or 5,
                      Rows(results / "bench.csv", KEYS, FIELDS, options.again))
    if "jobs" in options.only:
        measure_jobs(folder_of_programs / "raycell", folder / "teapot-s4.nff", options.jobs,
                     Rows(results / "bench_jobs.csv", JOB_KEYS, JOB_FIELDS, options.again))
    if "growth" in options.only:
        design = Design(options.growth_sides, options.growth_side, options.depths, options.max_depths,
                        options.precast_side)
        measure_growth(folder_of_programs / "raycell", design.jobs(*scenes_of(folder, root)), options.rounds or 1,
                       Rows(results / "bench_growth.csv", GROWTH_KEYS, GROWTH_FIELDS, options.again))


def main(root, words):
    options = parse(words)
    results = charts = options.out or programs.measured(root)
    results.mkdir(parents=True, exist_ok=True)
    if not options.from_csv:
        measure(root, options, results)
    # Imported here, since only this needs matplotlib.
    from studies.bench.growth_tables import line_rows, write_growth_chart, write_growth_table, write_line_chart
    from studies.bench.tables import write_chart, write_table
    rows = read_numbers(results / "bench.csv", {"case"})
    if rows:
        medians = {}
        for row in rows:
            medians.setdefault((row["case"], int(row["side"])), []).append(row)
        write_table(results / "bench.md", CASES, medians,
                    read_numbers(results / "bench_jobs.csv", {"scene", "granularity"}))
        write_chart(charts / "bench.png", CASES, {
            key: statistics.median(row["hops_per_second"] for row in group) for key, group in medians.items()})
    growth = read_numbers(results / "bench_growth.csv", {"scene", "shadows"})
    if growth:
        lines = write_growth_table(results / "bench_growth.md", growth, options.growth_side)
        write_growth_chart(charts / "bench_growth.png", growth, options.growth_side)
        if lines:
            write_line_chart(charts / "bench_line.png", lines)
            for scene, sides, slope, *each in line_rows(lines):
                print(f"{scene}, {sides}: slope {slope}, ns per hop {each[0]} to {each[1]}, most / least {each[2]}")
