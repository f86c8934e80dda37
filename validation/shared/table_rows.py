"""Rows of the pages with verdicts, as CSV."""

import csv

from gearfe.core.files import written
from gearfe.scene.verdicts import COLUMNS, Row

from .places import TABLES


def path_of(name):
    """CSV file of a page."""
    return TABLES / f"{name}.csv"


def write(name, rows):
    """Write the rows of a page with six digits."""
    TABLES.mkdir(exist_ok=True)
    with written(path_of(name)) as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        out.writerows([f"{x:.6g}" if isinstance(x, float) else x for x in row] for row in rows)


def read(name):
    """Rows of a committed page."""
    with open(path_of(name), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return [Row(**{c: float(r[c]) if c in COLUMNS[3:7] else r[c] for c in COLUMNS}) for r in rows]


def write_runs(name, runs):
    """Write what the simulations behind a page were made with, by their names."""
    with written(TABLES / f"{name}_runs.csv") as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("run", "made with"))
        out.writerows(runs.items())


def read_runs(name):
    """What `write_runs` wrote."""
    with open(TABLES / f"{name}_runs.csv", encoding="utf-8", newline="") as file:
        return {row["run"]: row["made with"] for row in csv.DictReader(file)}


def rows_of(table):
    """Rows of a CSV table; none if there is no table."""
    if not table.exists():
        return []
    with table.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def append(table, header, row):
    """Append a row to a CSV table, which begins with its header."""
    lines = [row] if table.exists() else [header, row]
    with table.open("a", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(lines)


def write_table(rows, table, columns):
    """Write a CSV table."""
    with written(table) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, columns, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
