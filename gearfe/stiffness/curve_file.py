"""Curves to and from files. Every file is written beside its target and moved into place when it is complete."""

import contextlib
import json
import os
import tempfile
from pathlib import Path

import numpy as np

from .curve import StiffnessCurve

COLUMNS = {"phase": "-", "k": "N/m", "k_tangent": "N/m", "lte": "m"}
PER_PAIR = {"force": "N", "pressure": "Pa"}
FIRST_LINE = "# gearfe stiffness curve, version 1"


@contextlib.contextmanager
def written(path):
    """Path of a temporary file beside `path` that replaces it when the block ends without an error.

    Raises
    ------
    ValueError
        If the folder does not exist or cannot be written.
    """
    path = Path(path)
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    except OSError as error:
        raise ValueError(f"cannot write {path}: {error.strerror or error}; give an existing, writable folder") from error
    os.close(handle)
    try:
        yield name
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, path)
    except OSError as error:
        raise ValueError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name)


def save(curve, path):
    """Write `curve` in the format of the suffix of `path`."""
    writers = {".csv": write_csv, ".npz": write_npz, ".mat": write_mat, ".json": write_json}
    suffix = Path(path).suffix.lower()
    if suffix not in writers:
        raise ValueError(f"{path}: no format for {suffix or 'a file without a suffix'!r}; use one of {', '.join(writers)}")
    writers[suffix](curve, path)


def arrays(curve):
    """All arrays of `curve` by name (``error`` only if there is one)."""
    names = [*COLUMNS, "order", *PER_PAIR, *(["error"] if curve.error is not None else [])]
    return {name: np.asarray(getattr(curve, name)) for name in names}


def write_csv(curve, path):
    """Write a table of repr-exact numbers under comment lines with units and meta data (JSON)."""
    columns = {f"{name} [{unit}]": getattr(curve, name) for name, unit in COLUMNS.items()}
    if curve.error is not None:
        columns["error [N/m]"] = curve.error
    for name, unit in PER_PAIR.items():
        for j, order in enumerate(curve.order):
            columns[f"{name} {order} [{unit}]"] = getattr(curve, name)[:, j]
    with written(path) as name, open(name, "w", encoding="utf-8") as file:
        file.write(f"{FIRST_LINE}\n# meta: {json.dumps(curve.meta)}\n{','.join(columns)}\n")
        for row in zip(*columns.values(), strict=True):
            file.write(",".join(repr(float(value)) for value in row) + "\n")


def read_csv(path):
    """Read what `write_csv` wrote; see `StiffnessCurve.from_csv`."""
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"cannot read {path}: {error}") from error
    if len(lines) < 4 or lines[0] != FIRST_LINE or not lines[1].startswith("# meta: "):
        raise ValueError(f"{path} is not a curve written by gearfe: its first line must be {FIRST_LINE!r}")
    try:
        meta = json.loads(lines[1].removeprefix("# meta: "))
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines[3:]])
    except ValueError as error:
        raise ValueError(f"{path}: damaged table: {error}") from error
    header = lines[2].split(",")
    data = _columns(path, header, table)
    order = np.array([int(name.split()[1]) for name in header if name.startswith("force ")])
    wanted = [f"{name} {k} [{unit}]" for k in order for name, unit in PER_PAIR.items()]
    missing = [name for name in wanted if name not in data]
    if missing or not isinstance(meta, dict) or order.size == 0:
        raise ValueError(f"{path}: damaged table: {'no column ' + repr(missing[0]) if missing else 'no pairs or no meta data'}")
    per_pair = {name: np.array([data[f"{name} {k} [{unit}]"] for k in order]).T for name, unit in PER_PAIR.items()}
    plain = {name: data[f"{name} [{unit}]"] for name, unit in COLUMNS.items()}
    return StiffnessCurve(**plain, order=order, **per_pair, error=data.get("error [N/m]"), meta=meta)


def _columns(path, header, table):
    if table.ndim != 2 or table.shape[1] != len(header):
        raise ValueError(f"{path}: rows must have {len(header)} numbers, like the header")
    data = dict(zip(header, table.T, strict=True))
    missing = [f"{name} [{unit}]" for name, unit in COLUMNS.items() if f"{name} [{unit}]" not in data]
    if missing:
        raise ValueError(f"{path}: no column {missing[0]!r}; it has {', '.join(header)}")
    phase = data["phase [-]"]
    rises = np.flatnonzero(~(np.diff(phase) > 0))
    if rises.size:
        raise ValueError(f"{path}: phase must rise, but line {rises[0] + 5} has {phase[rises[0] + 1]} after {phase[rises[0]]}")
    if not np.isfinite(data["k [N/m]"]).all() or not (data["k [N/m]"] > 0).all():
        raise ValueError(f"{path}: k must be positive and finite in every row")
    return data


def write_npz(curve, path):
    """Write a numpy archive; ``meta`` is a JSON string."""
    with written(path) as name, open(name, "wb") as file:
        np.savez(file, **arrays(curve), meta=json.dumps(curve.meta))


def write_mat(curve, path):
    """Write a MATLAB 5 file; ``meta`` is a JSON string (``jsondecode`` reads it)."""
    from scipy.io import savemat

    with written(path) as name:
        savemat(name, arrays(curve) | {"meta": json.dumps(curve.meta)}, appendmat=False, oned_as="column")


def write_json(curve, path):
    """Write JSON: arrays as lists (nan as null), units beside them."""
    data = {name: json.loads(json.dumps(values.tolist()).replace("NaN", "null")) for name, values in arrays(curve).items()}
    units = COLUMNS | PER_PAIR | {"error": "N/m", "order": "-"}
    with written(path) as name, open(name, "w", encoding="utf-8") as file:
        json.dump({"units": {key: units[key] for key in data}, **data, "meta": curve.meta}, file)
