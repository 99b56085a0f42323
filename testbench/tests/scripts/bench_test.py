#!/usr/bin/python3
"""Tests of scripts/study bench's growing jobs: bench_test.py CASE STUDY_SCRIPT PROGRAM FOLDER. Empties FOLDER first."""
import csv
import pathlib
import shutil
import subprocess
import sys

from expectation import expect

# A stand-in for the program: records each run, and fails after LIMIT runs.
PROGRAM = """#!/bin/bash
echo "$*" >> '{folder}/calls'
if [ $(wc -l < '{folder}/calls') -gt {limit} ]; then
    echo 'stopped' >&2
    exit 2
fi
exec '{program}' "$@"
"""
QUICK = ["--only", "growth", "--growth-side", "8", "--depths", "16,1024", "--max-depths", "0,4", "--precast-side", "8"]
SIDES = [8, 64, 80]
RUNS = 4 + 2 + 2  # arrays, the smallest also with precast; then depth and max-depth, each also with precast


class Test:
    def __init__(self, script, program, folder):
        self.script, self.program, self.folder = script, program, pathlib.Path(folder)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.scenes, self.programs = self.folder / "scenes", self.folder / "programs"
        for path in (self.scenes, self.programs):
            path.mkdir(parents=True)
        own = pathlib.Path(script).resolve().parents[1] / "scenes" / "cornell.nff"
        shutil.copy(own, self.scenes / "teapot-s4.nff")  # the bench looks for a scene of this name
        self.out = self.folder / "out"
        self.stand_in(10 ** 6)

    def stand_in(self, limit, comment=""):
        path = self.programs / "raycell"
        path.write_text(PROGRAM.replace("{folder}", str(self.folder)).replace("{program}", self.program)
                        .replace("{limit}", str(limit)) + comment)
        path.chmod(0o755)

    def bench(self, *words):
        sides = ",".join(map(str, SIDES))
        return subprocess.run([self.script, "bench", *QUICK, "--growth-sides", sides, "--program-folder", str(self.programs),
                               "--out", str(self.out), *words, str(self.scenes)], capture_output=True, text=True,
                              check=False)

    def calls(self):
        """Number of runs since the last call."""
        path = self.folder / "calls"
        number = len(path.read_text().splitlines()) if path.exists() else 0
        path.unlink(missing_ok=True)
        return number

    def rows(self, name="bench_growth.csv"):
        with (self.out / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def growth(self):
        done = self.bench()
        expect(done.returncode == 0, f"tables and charts, not {done.stderr}")
        expect(self.calls() == RUNS, f"{RUNS} runs")
        files = ["bench_growth.csv", "bench_growth.md", "bench_growth.png", "bench_line.png"]
        expect(sorted(path.name for path in self.out.iterdir()) == files, "a table, a CSV, two charts")
        rows = self.rows()
        expect(len(rows) == RUNS, f"{RUNS} rows")
        for row in rows:
            expect(float(row["hops_load"]) > 0 and float(row["hops_trace"]) > 0, "hops of loading and tracing")
            expect((float(row["hops_precast"]) > 0) == (row["shadows"] == "precast"), "hops of precast where it is")
            phases = sum(float(row[f"processor_{phase}"]) for phase in ("load", "precast", "trace"))
            expect(0 < phases <= float(row["processor_job"]) + 0.01, "phases are parts of the job")
            expect(float(row["primitives"]) > 0, "primitives are counted")
        usual = {"side": "8", "depth": "1024", "shadows": "per-hit"}
        traced = {row["max_depth"]: float(row["rays"]) for row in rows if usual.items() <= row.items()}
        expect(traced["4"] > traced["0"], "more rays with more generations")
        text = (self.out / "bench_growth.md").read_text()
        for part in ("array's side", "depth, 8x8", "generations of rays", "Wall time against hops"):
            expect(part in text, f"'{part}' in the table")
        expect("64² to 80²: slope" in done.stdout, "the slope is printed")
        before = self.rows()
        expect("8 runs, 0 to make" in self.bench().stdout and self.calls() == 0 and self.rows() == before,
               "nothing is measured twice")
        expect(self.bench("--again").returncode == 0 and self.calls() == RUNS, "--again makes all of it again")
        (self.out / "bench_growth.md").unlink()
        expect(self.bench("--from-csv").returncode == 0 and self.calls() == 0, "tables are made from the CSV")
        expect((self.out / "bench_growth.md").read_text().startswith("# How"), "the table is there again")

    def stopped(self):
        self.stand_in(3)
        done = self.bench()
        expect(done.returncode == 1 and "ended with 2: stopped" in done.stderr, f"its failure, not {done.stderr}")
        expect(not (self.out / "bench_growth.csv").exists(), "no table of half a bench")
        kept = self.rows("bench_growth.csv.part")
        expect(len(kept) == 3, "three rows are kept")
        self.calls()
        # Makes the kept rows look as if made by the full program, which differs in nothing that counts here.
        for row in kept:
            row["made_by"] = self.made_by(10 ** 6)
        self.rewrite("bench_growth.csv.part", kept)
        self.stand_in(10 ** 6)
        expect(self.bench().returncode == 0 and self.calls() == RUNS - 3, "it goes on with the other runs")
        rows = self.rows()
        expect(len(rows) == RUNS and all(row in rows for row in kept), "the rows that were there stay as they were")
        expect(not (self.out / "bench_growth.csv.part").exists(), "nothing half is left")

    def made_by(self, limit):
        self.stand_in(limit)
        sys.path.insert(0, str(pathlib.Path(self.script).resolve().parent))
        from studies.bench.rows import made_by
        return made_by(self.programs / "raycell", self.scenes / "teapot-s4.nff")

    def rewrite(self, name, rows):
        with (self.out / name).open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
            file.write("teapot-s4,8,10")  # an incomplete line

    def others(self):
        expect(self.bench().returncode == 0 and self.calls() == RUNS, "a first bench")
        self.stand_in(10 ** 6, "# another build")
        expect(self.bench().returncode == 0 and self.calls() == RUNS, "another program: all of it again")
        with (self.scenes / "teapot-s4.nff").open("a") as file:
            file.write("# another scene\n")
        expect(self.bench().returncode == 0 and self.calls() == RUNS, "another scene: all of it again")


if __name__ == "__main__":
    case = sys.argv[1]
    getattr(Test(*sys.argv[2:]), case)()
