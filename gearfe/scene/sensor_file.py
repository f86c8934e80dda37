"""Measured frequency response functions of the sensors of a scene file, as lists in its tables."""

import csv
import math
from pathlib import Path
from typing import Any

from ..core.file_readers import read_text
from ..geometry.checks import shown


def with_frf(file: Any, tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scene's `file` with frequency response functions read from the files of ``[sensor.NAME] frf``."""
    sensors = tables.get("sensor")
    rows = sensors.items() if isinstance(sensors, dict) else ()
    named = {name: row for name, row in rows if isinstance(row, dict) and isinstance(row.get("frf"), str)}
    if not named:
        return tables
    read = {name: _read(file, name, row) for name, row in named.items()}
    return tables | {"sensor": dict(rows) | read}


def _read(file, name, row):
    path, where = Path(file).parent / row["frf"], f"{file.name} [sensor.{name}] frf = {shown(row['frf'])}"
    try:
        lines = list(csv.reader(read_text(path)))
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{where}: not readable as a table: {error}") from error
    columns = [line for line in map(_numbers, lines) if line]
    if len(columns) < 2 or any(len(line) != 3 for line in columns):
        raise ValueError(f"{where}: give rows of three numbers, frequency in Hz, real and imaginary part, with commas between")
    values = dict(zip(("frf_Hz", "frf_real", "frf_imag"), map(list, zip(*columns, strict=True)), strict=True))
    return {key: value for key, value in row.items() if key != "frf"} | values


def _numbers(line):
    """Return the finite numbers of a line. The result is empty for a line of other text."""
    try:
        numbers = [float(part) for part in line]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []
