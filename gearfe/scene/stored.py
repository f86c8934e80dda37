"""Stored stiffness curves of scenes with long computing time. A file is valid only for the exact numbers of its scene."""

import csv
import hashlib
from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from importlib import resources

import numpy as np

COLUMNS = ("pair", "case", "print", "phase", "k [N/m]", "own tooth [N/m]", "estimate", "seconds")


def fingerprint(case):
    """Return eight letters that depend on every number of a `Case`. Fields with default values are ignored."""
    run = case.as_dict()
    text = ";".join(f"{name}={_plain(run[name])}" for name in sorted(run))
    return hashlib.sha256(text.encode()).hexdigest()[:8]


def _plain(value):
    if is_dataclass(value):
        stated = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        defaults = {f.name: f.default for f in fields(value) if f.default is not MISSING}
        return f"{type(value).__name__}({_plain({n: v for n, v in stated.items() if n not in defaults or v != defaults[n]})})"
    if isinstance(value, Mapping):
        return "{" + ",".join(f"{name}:{_plain(value[name])}" for name in sorted(value)) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ",".join(_plain(item) for item in value) + "]"
    return f"{value:.9g}" if isinstance(value, float) else repr(value)


def stored_file(scene):
    """Return the file of the stored curves of a built-in scene. It may not exist."""
    return resources.files("gearfe.scene.scenes") / f"{scene.name}_fe3d.csv"


def read_curves(scene, file=None):
    """Read stored curves by (pair, case): phases, k [N/m], k of the damaged tooth [N/m], relative error, seconds.

    Only curves for exactly these gears, loads and damages are returned. The result is empty without a file.
    """
    file = stored_file(scene) if file is None else file
    if not file.is_file():
        return {}
    rows = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    out = {}
    for pair, case in dict.fromkeys((row["pair"], row["case"]) for row in rows):
        name = case if case != "healthy" else None
        known = pair in scene.pairs and (name is None or name in scene.pairs[pair].damage)
        case_rows = [row for row in rows if (row["pair"], row["case"]) == (pair, case)]
        if known and case_rows[0]["print"] == fingerprint(scene.case(pair, name)):
            numbers = np.array([[float(row[column]) for column in COLUMNS[3:]] for row in case_rows])
            out[pair, name] = (*numbers[:, :3].T, *numbers[0, 3:].tolist())
    return out


def write_curves(scene, curves, file):
    """Write stiffness curves in the form that `read_curves` returns."""
    with file.open("w", encoding="utf-8", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(COLUMNS)
        for (pair, case), (phase, k, tooth, *rest) in curves.items():
            mark = fingerprint(scene.case(pair, case))
            for row in zip(phase, k, tooth, strict=True):
                table.writerow([pair, case or "healthy", mark, *(f"{value:.8g}" for value in row), *(f"{v:.3g}" for v in rest)])
