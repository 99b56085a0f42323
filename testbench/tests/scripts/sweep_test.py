#!/usr/bin/python3
"""Tests of scripts/study sweep: sweep_test.py CASE STUDY_SCRIPT PROGRAM FOLDER [OTHER_FOLDER]. Empties FOLDER first."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

from expectation import expect

# A stand-in for the program: records each run. While FOLDER/broken exists, the runs that it names fail. While
# FOLDER/held exists, all runs after the fourth wait.
PROGRAM = """#!/bin/bash
echo "$*" >> '{folder}/calls'
if [ -e '{folder}/broken' ] && [[ " $* " == *"$(cat '{folder}/broken')"* ]]; then
    echo 'no luck today' >&2
    exit 2
fi
while [ -e '{folder}/held' ] && [ $(wc -l < '{folder}/calls') -gt 4 ]; do sleep 0.1; done
exec '{program}' "$@"
"""
# Stand-ins for Slurm's commands: jobs are processes, and each job's state is a file.
SBATCH = """#!/bin/bash
script=${!#}
number=$(($(cat '{folder}/jobs' 2>/dev/null || echo 0) + 1))
echo $number > '{folder}/jobs'
echo "$*" >> '{folder}/submitted'
echo RUNNING > '{folder}/state'$number
(sh "$script" > '{folder}/output'$number 2>&1 && echo COMPLETED > '{folder}/state'$number ||
    echo FAILED > '{folder}/state'$number) > /dev/null 2>&1 &
echo $number
"""
SACCT = """#!/bin/bash
cat '{folder}/state'${!#}
"""
RUNS = 12  # of time_outs --quick
SHARED = "default.16x16.shared.M8.none.seed2", "branching.16x16.shared.M8.none.seed2"


class Test:
    def __init__(self, script, program, folder):
        self.script, self.program, self.folder = script, program, pathlib.Path(folder)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.out = self.folder / "out"
        self.environment = dict(os.environ)

    def stand_in(self, name, text):
        path = self.folder / name
        path.write_text(text.replace("{folder}", str(self.folder)).replace("{program}", self.program))
        path.chmod(0o755)
        return path

    def words(self, sweep, program, options):
        return [self.script, "sweep", sweep, "--quick", "--jobs", "2", "--program", str(program), "--out", str(self.out),
                *options]

    def sweep(self, sweep, program, code, *options):
        """Runs a sweep, expects this exit code and returns the output."""
        result = subprocess.run(self.words(sweep, program, options), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, env=self.environment)
        print(result.stdout)
        expect(result.returncode == code, f"exit code {code}, not {result.returncode}")
        return result.stdout

    def calls(self):
        path = self.folder / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def records(self):
        """The cached runs that have a result: {file: time of its last change, in ns}."""
        return {path: path.stat().st_mtime_ns for path in self.out.glob("cache/*/*.json")
                if '"report"' in path.read_text()}

    def expect_tables(self, there):
        made = sorted(path.name for path in self.out.glob("time_outs.*"))
        expect(made == (["time_outs.csv", "time_outs.md", "time_outs.png"] if there else []),
               f"{'all' if there else 'no'} tables and charts, not {made}")

    def break_shared(self):
        (self.folder / "broken").write_text("--networks shared --ray-store 8 --recovery none --slots reserved --buffer 1 "
                                            "--seed 2 ")

    def same(self, other):
        """A whole sweep whose runs share pictures: its CSV equals the one that its own script wrote to OTHER_FOLDER."""
        self.sweep("accuracy", self.program, 0)
        mine, its = ((folder / "accuracy.csv").read_text() for folder in (self.out, pathlib.Path(other)))
        expect(mine == its, "the same CSV as without Snakemake")
        expect(not list(self.out.glob("cache/*/work")), "no pictures left")
        self.expect_code_of_tables()
        listed = subprocess.run([self.script, "accuracy", *self.words("", self.program, [])[3:], "--list"], capture_output=True, text=True).stdout
        expect("26 distinct runs, 8 timed, 26 finished" in listed, "without Snakemake the runs count as finished")

    def expect_code_of_tables(self):
        """Tables depend on all code that makes them: every module of the project that their modules import."""
        plan, = self.out.glob("**/plan.json")
        code = {pathlib.Path(path) for path in json.loads(plan.read_text())["code"]}
        makers = [path for path in code if path.stem in ("tables", "pictures", "rows")]
        expect(len(makers) == 5, "the sweep's own three and two that all sweeps share")
        for path in makers:
            for package, name in re.findall(r"^from (studies[\w.]*) import (\w+)", path.read_text(), re.MULTILINE):
                folder = pathlib.Path(self.script).resolve().parent.joinpath(*package.split("."))
                module = folder / f"{name}.py" if folder.is_dir() else folder.with_suffix(".py")
                expect(module in code, f"{module}, which {path} imports, among what makes the tables")

    def failure(self):
        """A failed run is named, stops no other run and is the only one made again; until then there are no tables."""
        program = self.stand_in("program", PROGRAM)
        self.break_shared()
        said = self.sweep("time_outs", program, 1)
        for name in SHARED:
            expect(f"sweep time_outs: {name} failed: exit code 2: no luck today" in said, f"that {name} failed")
        expect(f"2 of {RUNS} runs are missing, no tables" in said, "2 missing runs")
        self.expect_tables(False)
        expect(len(self.records()) == RUNS - 2 and len(self.calls()) == RUNS, "all others made, each once")
        finished = self.records()
        (self.folder / "broken").unlink()
        self.sweep("time_outs", program, 0)
        expect(len(self.calls()) == RUNS + 2, "only the two that failed made again")
        expect(finished.items() <= self.records().items(), "finished records untouched")
        self.expect_tables(True)

    def stop(self, number):
        """A sweep is stopped half way by a signal, and started again."""
        program = self.stand_in("program", PROGRAM)
        held = self.folder / "held"
        held.touch()
        sweep = subprocess.Popen(self.words("time_outs", program, []))
        while len(self.records()) < 2:
            expect(sweep.poll() is None, "two runs, and then the sweep still there")
            time.sleep(0.05)
        sweep.send_signal(number)
        expect(sweep.wait() == 130, f"exit code 130, not {sweep.returncode}")
        held.unlink()
        finished = self.records()
        expect(2 <= len(finished) < RUNS, f"the sweep stopped half way, not after {len(finished)} runs")
        self.expect_tables(False)
        (self.folder / "calls").unlink()
        self.sweep("time_outs", program, 0)
        expect(len(self.calls()) == RUNS - len(finished), "none of the finished runs made again")
        expect(finished.items() <= self.records().items(), "finished records untouched")
        self.expect_tables(True)

    def slurm(self):
        """The profile for Slurm with processes as jobs: groups of runs, of which some fail."""
        program = self.stand_in("program", PROGRAM)
        self.break_shared()
        for name, text in {"sbatch": SBATCH, "sacct": SACCT}.items():
            self.stand_in(name, text)
        # Snakemake asks for the state of jobs every ten seconds unless CI is set.
        self.environment.update(PATH=f"{self.folder}:{os.environ['PATH']}", CI="true")
        profile = pathlib.Path(self.script).parent / "studies" / "sweeps" / "slurm"
        options = ["--", "--profile", str(profile), "--cores", "2", "--latency-wait", "5", "--group-components", "runs=4"]
        said = self.sweep("time_outs", program, 1, *options)
        expect(len(self.records()) == RUNS - 2 and len(self.calls()) == RUNS, "all others made, each once")
        for name in SHARED:
            expect(f"{name} failed: exit code 2: no luck today" in said, f"that {name} failed")
        jobs = (self.folder / "submitted").read_text().splitlines()
        expect(len(jobs) == RUNS // 4, f"{RUNS // 4} jobs, not {len(jobs)}")
        expect(all("--cpus-per-task=2 " in job and "--time=" in job for job in jobs), "two cores and a time for each")
        (self.folder / "broken").unlink()
        self.sweep("time_outs", program, 0, *options)
        expect(len(self.calls()) == RUNS + 2, "only the two that failed made again")
        self.expect_tables(True)


def main(case, script, program, folder, *more):
    test = Test(script, program, folder)
    cases = {"same": test.same, "failure": test.failure, "slurm": test.slurm,
             "terminate": lambda: test.stop(signal.SIGTERM), "interrupt": lambda: test.stop(signal.SIGINT)}
    cases[case](*more)


main(*sys.argv[1:])
