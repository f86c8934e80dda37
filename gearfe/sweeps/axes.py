"""Tables of a study that say what varies: ``[vary]`` and ``[[along]]`` the axes of a grid, ``[sample]`` what is drawn."""

import json
import math

import numpy as np

from ..scene.strict import NUMBER, REQUIRED, TABLES, TEXT, TEXTS, VALUES, WHOLE, checked
from . import samples

SAMPLE = {"method": (TEXT, "random"), "count": (WHOLE, REQUIRED), "of": (VALUES, REQUIRED), "correlated": (TABLES, [])}
BETWEEN = {"between": (TEXTS, REQUIRED), "value": (NUMBER, REQUIRED)}
STEPS = {"from": (NUMBER, REQUIRED), "to": (NUMBER, REQUIRED), "count": (WHOLE, REQUIRED), "spacing": (TEXT, "even")}
SPEC = {*STEPS, *samples.SHAPES, "within", "also"}


def flat(tables, path=()):
    """Values of nested tables by dotted key; a table of `SPEC` keys is a value."""
    out = {}
    for name, value in tables.items():
        if isinstance(value, dict) and not (value and set(value) <= SPEC):
            out |= flat(value, (*path, name))
        else:
            out[".".join((*path, name))] = value
    return out


def axes(file, vary, along):
    """Axes of the grid, in the order of the file: each holds lists of one length by key."""
    for key, value in flat(vary).items():
        values = _listed(file, key, value)
        also = value.get("also", []) if isinstance(value, dict) else []
        yield {one: values for one in (key, *also)}
    for i, table in enumerate(along):
        lists = {key: _listed(file, key, value) for key, value in flat(table).items()}
        if len({len(one) for one in lists.values()}) != 1:
            told = ", ".join(f"{key} has {len(one)}" for key, one in lists.items())
            raise ValueError(f"{file} [along {i + 1}]: lists that go together are of one length, but {told or 'there is none'}")
        yield lists


def _listed(file, key, value):
    """Values of one key of the grid."""
    where = f"vary {key}"
    if isinstance(value, dict):
        steps = checked(file, where, {name: one for name, one in value.items() if name != "also"}, STEPS)
        if steps["count"] < 2 or steps["spacing"] not in ("even", "log"):
            raise ValueError(f'{file} [{where}]: give count >= 2 and spacing = "even" or "log"')
        if steps["spacing"] == "even":
            return np.linspace(steps["from"], steps["to"], steps["count"]).tolist()
        if not min(steps["from"], steps["to"]) > 0:
            raise ValueError(f"{file} [{where}]: logarithmic steps need from > 0 and to > 0")
        return np.geomspace(steps["from"], steps["to"], steps["count"]).tolist()
    if not isinstance(value, (list, tuple)) or not value:
        raise ValueError(f"{file} [{where}] = {value!r}: give a list of values, or from, to and count")
    if len({json.dumps(one) for one in value}) < len(value):
        raise ValueError(f"{file} [{where}]: a value stands in the list twice")
    return list(value)


def checked_sample(file, given):
    """Checked ``[sample]``; empty if none is given."""
    if not given:
        return {}
    out = checked(file, "sample", given, SAMPLE)
    out["of"] = flat(out["of"])
    out["correlated"] = [checked(file, f"sample.correlated {i + 1}", one, BETWEEN) for i, one in enumerate(out["correlated"])]
    method, count = out["method"], out["count"]
    if method not in samples.METHODS:
        raise ValueError(f"{file} [sample] method = {method!r}, but it must be one of {', '.join(samples.METHODS)}")
    if count < 1 or not out["of"]:
        raise ValueError(f"{file} [sample]: give count >= 1 and [sample.of] with at least one key")
    if method in ("sobol", "saltelli") and count & (count - 1):
        low = 2 ** math.floor(math.log2(count))
        raise ValueError(f"{file} [sample] count = {count}: a {method} sample has a power of two, such as {low} or {2 * low}")
    for key, spec in out["of"].items():
        if not isinstance(spec, dict):
            raise ValueError(f"{file} [sample.of] {key} = {spec!r}: give a distribution, such as {{ uniform = [1, 2] }}")
        samples.check_shape(f"{file} [sample.of] {key}", spec)
    if method == "saltelli" and out["correlated"]:
        raise ValueError(f"{file} [sample]: Sobol indices part the variance among independent values; leave [[correlated]] out")
    for one in out["correlated"]:
        known = [key for key in out["of"] if "choice" not in out["of"][key]]
        if len(one["between"]) != 2 or not set(one["between"]) <= set(known) or not -1 < one["value"] < 1:
            raise ValueError(f"{file} [[sample.correlated]] {one!r}: give two of {', '.join(known)} and a value in (-1, 1)")
    return out
