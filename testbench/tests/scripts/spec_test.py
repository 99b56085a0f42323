#!/usr/bin/python3
"""Replays runs with the cell that is written from its specification: spec_test.py RUN PROGRAM SCENES FOLDER [SEED].

RUN is a name of RUNS. 36 cells of it are recorded in FOLDER, which is emptied first, and have to be replayed without a
difference. Then a word of an expected line, drawn from SEED, is altered, and the replay has to name this line."""
import pathlib
import random
import re
import shutil
import subprocess
import sys

from expectation import expect

SPEC = pathlib.Path(__file__).resolve().parents[2] / "spec"
sys.path.insert(0, str(SPEC))
sys.dont_write_bytecode = True

from record import Record  # noqa: E402
from wire import TYPES     # noqa: E402

# Scene, cells that are recorded (the corners, the load links and the middle are among them), options; messages that the
# cells must have sent, so that the run shows what it is here for.
RUNS = {
    "edge": ("still_life.nff", "0..5,6..11", "", "span reflected shadow lit blocked"),
    "depth": ("cornell.nff", "0..5,6..11",
              "--hit depth --normals voxel --word-bits 12 --reciprocal table --root table --networks quadrant",
              "span reflected shadow lit blocked"),
    "interval": ("facing_mirrors.nff", "6..11,0..5",
                 "--hit interval --shadows memo --networks quadrant --word-bits 16 --rounding truncate",
                 "span reflected memo lit"),
    "plane": ("facing_mirrors.nff", "0..5,0..5", "--hit plane --shadows precast --networks split --buffer 2 --word-bits 24",
              "span reflected precast blocked"),
    "mask": ("facing_mirrors.nff", "0..5,6..11", "--hit mask --shadows memo --exterior none --normals voxel --link-bits 64",
             "span reflected memo lit"),
    "exact_words": ("facing_mirrors.nff", "0..5,0..5", "--word-bits 32 --reciprocal rounded --root rounded --max-depth 8 "
                    "--ray-store 12", "span reflected shadow lit"),
    "shared": ("cornell.nff", "3..8,3..8", "--networks shared --slots free --ray-store 64 --buffer 64 --power schlick",
               "reflected shadow lit"),
    "postponed": ("cornell.nff", "3..8,3..8", "--slots nested --ray-store 5", "reflected shadow lit postponed"),
    "infinity": ("cornell.nff", "3..8,3..8", "--viewer infinity --word-bits 24 --rounding truncate --shadows precast",
                 "span precast blocked"),
    "gouraud": ("cornell.nff", "6..11,6..11", "--display gouraud --hit mask --word-bits 16 --reciprocal table --depth 64",
                "span reflected shadow lit"),
    "sources": ("cornell.nff", "0..5,0..5", "--sources {scenes}/sources.toml --word-bits 18", "span reflected shadow lit blocked"),
    "memo_sources": ("cornell.nff", "3..8,3..8", "--sources {scenes}/sources.toml --shadows memo --power schlick",
                     "span reflected memo lit blocked"),
    "areas": ("cornell.nff", "4..9,0..5", "--sources {scenes}/lamp.toml --source-samples 5 --rounding truncate",
              "span reflected shadow lit blocked"),
    "precast_areas": ("cornell.nff", "4..9,2..7", "--sources {scenes}/lamp.toml --source-samples 8 --shadows precast --word-bits 28",
                      "span reflected precast blocked"),
}
CELLS = "12x12"


class Test:
    def __init__(self, run, program, scenes, folder, seed):
        self.scene, self.cells, self.options, self.sent = RUNS[run]
        self.program, self.scenes, self.folder, self.seed = program, pathlib.Path(scenes), pathlib.Path(folder), seed
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def record(self):
        result = subprocess.run([self.program, "render", self.scenes / self.scene, "--cells", CELLS, "-o", self.folder / "run",
                                 "--golden", self.cells, *self.options.format(scenes=self.scenes).split()],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        print(result.stdout)
        expect(result.returncode == 0, f"a run that completes, not exit code {result.returncode}")
        files = sorted(self.folder.glob("run.golden_*.txt"))
        expect(len(files) == 36, f"36 recorded cells, not {len(files)}")
        return files

    def replay(self, files, code):
        """The output of a replay that ends with `code`."""
        result = subprocess.run([sys.executable, SPEC / "replay.py", *files],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        print(result.stdout)
        expect(result.returncode == code, f"the replay ends with {code}, not {result.returncode}")
        return result.stdout

    def expect_agreement(self, files):
        output = self.replay(files, 0)
        expect("36 files, 0 with differences" in output, "36 files without a difference")
        expect("36 pixel" in output, "36 pixels compared")
        text = "".join(path.read_text() for path in files)
        for kind in self.sent.split():
            pattern = f" out .* kind {kind}$" if kind not in ("span", *TYPES) else f" out .* {kind} "
            expect(re.search(pattern, text, re.MULTILINE), f"a cell sends '{kind}'")

    def expect_found(self, files):
        """One bit of one word that a cell is expected to send."""
        draw = random.Random(self.seed)
        path = draw.choice(files)
        record = Record(path)
        event = draw.choice([event for event in record.events if event.what == "out" and event.name in TYPES])
        field, _ = draw.choice(record.wire.layout(event.name)[1:])
        print(f"seed {self.seed}: {path.name}, line {event.line}: field '{field}' is altered")
        word = event.fields[field]
        event.fields[field] = (word[0] ^ 1, word[1]) if isinstance(word, tuple) else word ^ 1
        lines = path.read_text().splitlines()
        words = lines[event.line - 1].split()
        words[5:7 + len(event.words)] = [record.wire.pack(event.name, event.fields), event.name,
                                         *record.wire.field_texts(event.name, event.fields)]
        lines[event.line - 1] = " ".join(words)
        altered = self.folder / "altered.txt"
        altered.write_text("\n".join(lines) + "\n")
        output = self.replay([altered], 2)
        expect(f"(line {event.line}): field '{field}'" in output, f"line {event.line} and field '{field}' are named")

    def expect_refusal(self, files):
        """A word without its bit on the wires: the file itself is wrong."""
        texts = [path.read_text().splitlines() for path in files]
        lines, at = next((lines, i) for lines in texts for i, line in enumerate(lines) if " out " in line and " kind " in line)
        words = lines[at].split()
        words[5] = words[5][:-2] + format(int(words[5][-2], 16) ^ 1, "x") + words[5][-1]
        lines[at] = " ".join(words)
        wrong = self.folder / "wrong.txt"
        wrong.write_text("\n".join(lines) + "\n")
        expect(f"line {at + 1}:" in self.replay([wrong], 1), f"line {at + 1} is refused")


def main():
    run, program, scenes, folder, *seed = sys.argv[1:]
    seed = int(seed[0]) if seed else random.SystemRandom().randrange(1 << 32)
    test = Test(run, program, scenes, folder, seed)
    files = test.record()
    test.expect_agreement(files)
    test.expect_found(files)
    test.expect_refusal(files)


main()
