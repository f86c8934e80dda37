"""CSV tables of the pages, and page rows with verdicts."""

import csv

from gearfe.core.files import written
from gearfe.scene.verdicts import COLUMNS, PrintedRow

from .places import TABLES


def write_table(table, header, rows):
    """Write a CSV table. Numbers that are not integers have six digits."""
    TABLES.mkdir(exist_ok=True)
    with written(table) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows([f"{x:.6g}" if isinstance(x, float) else x for x in row] for row in rows)


def rows_of(table):
    """Return the rows of a CSV table as dicts of texts. The list is empty if the table does not exist."""
    if not table.exists():
        return []
    with table.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write(name, rows):
    """Write the rows of a page with verdicts."""
    write_table(TABLES / f"{name}.csv", COLUMNS, rows)


def read(name):
    """Return the rows of a page with verdicts."""
    numbers = COLUMNS[3:7]
    return [PrintedRow(**{c: float(r[c]) if c in numbers else r[c] for c in COLUMNS}) for r in rows_of(TABLES / f"{name}.csv")]
