"""`read_topography`: a measured flank from a table, for `gearfe.Flank`."""

import csv
import os
from pathlib import Path

from ..core.checks import one_of
from ..core.file_readers import check_regular

UNITS = {"um": 1e-3, "mm": 1.0}

Topography = tuple[tuple[float, ...], tuple[float, ...], tuple[tuple[float, ...], ...]]


def read_topography(path: str | os.PathLike[str], unit: str = "um") -> Topography:
    """Read a measured flank from a CSV table.

    The first row contains a text and the heights z [mm]. Each further row contains a roll length [mm] and the material removed at
    these heights. Heights and roll lengths must increase.

    Parameters
    ----------
    path : path
    unit : {"um", "mm"}
        Of the material removed.

    Returns
    -------
    tuple
        Roll lengths, heights and rows of amounts [mm], for ``Flank(topography=...)``.

    Raises
    ------
    ValueError
        If the file is not such a table; the message names the line.
    """
    one_of("unit", unit, UNITS)
    check_regular(path)
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: not readable as a table: {error}") from error
    if len(rows) < 3 or len(rows[0]) < 3:
        raise ValueError(
            f"{path}: a topography needs a row of two or more heights, and two or more rows of roll length and amounts"
        )
    heights = _numbers(path, 1, rows[0][1:], len(rows[0]) - 1)
    table = [_numbers(path, i, row, len(rows[0])) for i, row in enumerate(rows[1:], start=2)]
    return tuple(row[0] for row in table), heights, tuple(tuple(UNITS[unit] * value for value in row[1:]) for row in table)


def _numbers(path, line, texts, count):
    try:
        out = tuple(float(text) for text in texts)
    except ValueError as error:
        raise ValueError(f"{path}, row {line}: {error}; every cell must be a number, except the first") from error
    if len(out) != count:
        raise ValueError(f"{path}, row {line}: {len(out)} numbers, but the first row makes it {count}")
    return out
