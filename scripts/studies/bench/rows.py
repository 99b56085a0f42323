"""The rows of the benchmark's CSV files, saved one by one so that a stopped bench can go on."""
import csv
import hashlib
import os
import platform


def processor_name():
    try:
        with open("/proc/cpuinfo") as file:
            return next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), "")
    except OSError:
        return ""


def made_by(*files):
    """A hash of what a row depends on besides its key: the files (program, scene) and the machine that ran it."""
    digest = hashlib.sha256(f"{platform.node()} {processor_name()}".encode())
    for path in files:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def as_text(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def read_rows(path):
    if not path.is_file():
        return []
    with path.open(newline="") as file:
        return [row for row in csv.DictReader(file) if None not in row.values() and None not in row]


class Rows:
    """The rows of PATH. New rows are appended to PATH.part at once; finish() makes them PATH. Rows of an earlier call
    in either file are used again if the same program, scene and machine made them."""

    def __init__(self, path, keys, fields, again=False):
        self.path, self.part = path, path.with_name(path.name + ".part")
        self.keys, self.fields = keys, [*keys, *fields, "made_by"]
        self.rows = {}
        if not again:
            for row in [*read_rows(path), *read_rows(self.part)]:
                if row.keys() == set(self.fields):
                    self.rows[self.key_of(row)] = row
        # Written afresh, so that nothing is appended to a line that a signal cut off.
        self.write(self.part, self.rows.values() if self.part.is_file() and not again else [])

    def key_of(self, row):
        return tuple(as_text(row[key]) for key in self.keys)

    def have(self, key, maker):
        row = self.rows.get(tuple(map(as_text, key)))
        return row is not None and row["made_by"] == maker

    def add(self, row):
        row = {field: as_text(row[field]) for field in self.fields}
        self.rows[self.key_of(row)] = row
        with self.part.open("a", newline="") as file:
            csv.DictWriter(file, self.fields, lineterminator="\n").writerow(row)
            file.flush()
            os.fsync(file.fileno())

    def write(self, path, rows):
        with path.open("w", newline="") as file:
            writer = csv.DictWriter(file, self.fields, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def finish(self, keys):
        """Makes the rows of these keys, in their order, the file."""
        whole = self.path.with_name(self.path.name + ".new")
        self.write(whole, [self.rows[tuple(map(as_text, key))] for key in keys])
        os.replace(whole, self.path)
        self.part.unlink()


def read_numbers(path, words):
    """The rows for tables and charts; all columns but `words` and made_by as numbers."""
    return [{k: v if k in words or k == "made_by" else float(v) for k, v in row.items()} for row in read_rows(path)]
