"""What the sweeps' rows share: writing the CSV and reading its lines back."""
import csv
import dataclasses


def write_csv(path, lines):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, lines[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)


def read_csv(path, row):
    with open(path, newline="") as file:
        return [row(line) for line in csv.DictReader(file)]


class SweepRow:
    """A line of the CSV: .configuration, and the measured columns as numbers, None where empty."""

    Configuration = None  # the sweep's factors
    TEXTS = []  # measured columns that are not numbers

    def __init__(self, line):
        fields = dataclasses.fields(self.Configuration)
        self.configuration = self.Configuration(**{field.name: field.type(line[field.name]) for field in fields})
        for name in line.keys() - {field.name for field in fields}:
            value = line[name]
            if name not in self.TEXTS:
                value = float(value) if value != "" else None
            setattr(self, name, value)
