"""File contents for a stiffness curve, and the reader. The formats are those of `gearfe.core.files`."""

import json

import numpy as np

from ..core.file_readers import read_text
from ..core.files import Content

COLUMNS = {"phase": "-", "k": "N/m", "k_tangent": "N/m", "deflection": "m"}
OPTIONAL = {"error": "N/m", "unloaded": "m", "support_deflection": "m"}
PER_PAIR = {"force": "N", "pressure": "Pa"}
TITLE = "gearfe stiffness curve, version 1"
FIRST_LINE = f"# {TITLE}"


def content(curve):
    """Return the `Content` of a `StiffnessCurve` (``error``, ``unloaded``, ``support_deflection`` only if present)."""
    columns = {f"{name} [{unit}]": getattr(curve, name) for name, unit in COLUMNS.items()}
    extra = {name: unit for name, unit in OPTIONAL.items() if getattr(curve, name) is not None}
    for name, unit in extra.items():
        columns[f"{name} [{unit}]"] = getattr(curve, name)
    for name, unit in PER_PAIR.items():
        for j, order in enumerate(curve.order):
            columns[f"{name} {order} [{unit}]"] = getattr(curve, name)[:, j]
    names = [*COLUMNS, "order", *PER_PAIR, *extra]
    arrays = {name: np.asarray(getattr(curve, name)) for name in names}
    return Content(TITLE, columns, arrays, curve.meta, COLUMNS | PER_PAIR | OPTIONAL | {"order": "-"})


def read_fields(path):
    """Return the fields of the `StiffnessCurve` in a CSV table, by name. See `StiffnessCurve.from_csv`."""
    lines = read_text(path)
    if len(lines) < 4 or lines[0] != FIRST_LINE or not lines[1].startswith("# meta: "):
        raise ValueError(f"{path} is not a curve written by gearfe: its first line must be {FIRST_LINE!r}")
    try:
        meta = json.loads(lines[1].removeprefix("# meta: "))
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines[3:]])
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path}: damaged table: {error}") from error
    header = lines[2].split(",")
    order = np.array([int(name.split()[1]) for name in header if name.startswith("force ")])
    data = _columns(path, header, table, order)
    if not isinstance(meta, dict) or order.size == 0:
        raise ValueError(f"{path}: damaged table: no pairs or no meta data")
    per_pair = {name: np.array([data[f"{name} {k} [{unit}]"] for k in order]).T for name, unit in PER_PAIR.items()}
    plain = {name: data.get(f"{name} [{unit}]") for name, unit in (COLUMNS | OPTIONAL).items()}
    return plain | per_pair | {"order": order, "meta": meta}


def _columns(path, header, table, order):
    if table.ndim != 2 or table.shape[1] != len(header):
        raise ValueError(f"{path}: rows must have {len(header)} numbers, like the header")
    data = dict(zip(header, table.T, strict=True))
    needed = [f"{name} [{unit}]" for name, unit in COLUMNS.items()]
    needed += [f"{name} {k} [{unit}]" for k in order for name, unit in PER_PAIR.items()]
    missing = [name for name in needed if name not in data]
    if missing:
        raise ValueError(f"{path}: no column {missing[0]!r}; it has {', '.join(header)}")
    phase = data["phase [-]"]
    rises = np.flatnonzero(~(np.diff(phase) > 0))
    if rises.size:
        raise ValueError(f"{path}: phase must rise, but line {rises[0] + 5} has {phase[rises[0] + 1]} after {phase[rises[0]]}")
    if not np.isfinite(data["k [N/m]"]).all() or not (data["k [N/m]"] > 0).all():
        raise ValueError(f"{path}: k must be positive and finite in every row")
    return data
