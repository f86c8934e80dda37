"""Variables of a study: ``[vary]`` and ``[[along]]`` are the axes of a grid, ``[sample]`` are random variables."""

import math

import numpy as np

from ...geometry.checks import shown
from ...scene.reading import LARGEST, checked
from ...scene.schema import schema_of
from . import samples

RUNS = "gearfe.runs"
MOST = 10**7  # limit of cases; their values alone require gigabytes
SPEC = {*schema_of(RUNS)["steps"].keys, *samples.SHAPES, "choice", "within"}


def flat(tables, path=()):
    """Return the values of nested tables by dotted key. A table with `SPEC` keys counts as one value."""
    out = {}
    for name, value in tables.items():
        if isinstance(value, dict) and not _says_values(value):
            out |= flat(value, (*path, name))
        else:
            out[".".join((*path, name))] = value
    return out


def _says_values(table):
    """Return True if a table defines the values of one key, that is, has `SPEC` keys only.

    ``count`` may also be a varied key of a scene.
    """
    return bool(table) and set(table) <= SPEC and not isinstance(table.get("count"), (list, dict))


def axes(file, vary, along):
    """Return the axes of the grid in file order. Each axis contains lists of equal length by key."""
    for key, value in flat(vary).items():
        values = _listed(file, key, value)
        yield {one: values for one in (key, *also(file, f"vary {key}", value))}
    for i, table in enumerate(along):
        lists = {key: _listed(file, key, value) for key, value in flat(table).items()}
        if len({len(one) for one in lists.values()}) != 1:
            lengths = ", ".join(f"{key} has {len(one)}" for key, one in lists.items())
            raise ValueError(
                f"{file} [along {i + 1}]: lists that vary together must have equal lengths, but {lengths or 'there is none'}"
            )
        yield lists


def also(file, where, value):
    """Return the keys that share the values of a key, from ``also`` in the table of that key."""
    if not isinstance(value, dict) or "also" not in value:
        return []
    return checked(RUNS, "also", file, where, {"also": value["also"]})["also"]


def _whole(values, steps):
    """Return values as integers if both ends and all values are whole, as for numbers of teeth."""
    near = [round(value) for value in values]
    ends = isinstance(steps["from"], int) and isinstance(steps["to"], int)
    return near if ends and all(abs(a - b) < 1e-9 * max(1, abs(a)) for a, b in zip(values, near, strict=True)) else values


def _listed(file, key, value):
    """Return the values of one key of the grid."""
    where = f"vary {key}"
    if isinstance(value, dict):
        steps = checked(RUNS, "steps", file, where, value)
        if steps["spacing"] == "even":
            return _whole(np.linspace(steps["from"], steps["to"], steps["count"]).tolist(), steps)
        if not min(steps["from"], steps["to"]) > 0:
            raise ValueError(f"{file} [{where}]: logarithmic steps need from > 0 and to > 0")
        return _whole(np.geomspace(steps["from"], steps["to"], steps["count"]).tolist(), steps)
    if not isinstance(value, (list, tuple)) or not value:
        raise ValueError(f"{file} [{where}] = {shown(value)}: give a list of values, or from, to and count")
    check_values(f"{file} [{where}]", value)
    if len({repr(entry) for entry in value}) < len(value):
        raise ValueError(f"{file} [{where}]: the list contains a value twice")
    return list(value)


def check_values(where, values):
    """Raise ValueError for a value that no scene key accepts: a table, a date, or a number beyond all limits."""
    for value in values:
        parts = value if isinstance(value, (list, tuple)) else [value]
        for part in parts:
            if not isinstance(part, (bool, str)) and not (isinstance(part, (int, float)) and abs(part) < LARGEST):
                raise ValueError(
                    f"{where}: {shown(value)} is no value of a scene: give numbers, texts, true or false, or lists of them"
                )


def checked_sample(file, given):
    """Return the checked table ``[sample]``. The result is empty if none is given."""
    if not given:
        return {}
    out = checked(RUNS, "sample", file, "sample", given)
    out["of"] = flat(out["of"])
    method, count = out["method"], out["count"]
    if not out["of"]:
        raise ValueError(f"{file} [sample]: give [sample.of] with at least one key")
    if method in ("sobol", "saltelli") and count & (count - 1):
        low = 2 ** math.floor(math.log2(count))
        raise ValueError(f"{file} [sample] count = {count}: a {method} sample has a power of two, such as {low} or {2 * low}")
    for key, spec in out["of"].items():
        if not isinstance(spec, dict):
            raise ValueError(f"{file} [sample.of] {key} = {shown(spec)}: give a distribution, such as {{ uniform = [1, 2] }}")
        also(file, f"sample.of {key}", spec)
        samples.check_shape(f"{file} [sample.of] {key}", spec)
        check_values(f"{file} [sample.of] {key}", spec.get("choice", []))
    if method == "saltelli" and out["correlated"]:
        raise ValueError(f"{file} [sample]: Sobol indices require independent values; leave out [[sample.correlated]]")
    _check_correlated(file, out)
    return out


def _check_correlated(file, sample):
    """Raise ValueError unless each correlation is between two keys that have a distribution, and is given only once."""
    known, seen = [key for key, spec in sample["of"].items() if "choice" not in spec], set()
    for entry in sample["correlated"]:
        pair = frozenset(entry["between"])
        if len(entry["between"]) != 2 or len(pair) != 2 or not pair <= set(known):
            raise ValueError(f"{file} [[sample.correlated]] {entry!r}: give two different keys of {', '.join(known)}")
        if pair in seen:
            raise ValueError(
                f"{file} [[sample.correlated]]: {' and '.join(entry['between'])} are correlated twice; leave one out"
            )
        seen.add(pair)
