"""Assumptions of a scene that remain valid after a user has changed numbers. Each assumption belongs to values.

An ``[[assumption]]`` may list the values it concerns, and ``[given]`` those that the scene's source prints, both by dotted key::

    [given]
    "gear.sun.z" = 21

    [[assumption]]
    what = "face width b = 20 mm"
    why = "the article gives none"
    holds = { "gear.sun.b_mm" = 20.0 }

A copy with another face width does not list this assumption. If a value of the source is changed, the printed results of the
source are not compared.
"""

import re

from ..geometry.checks import is_finite, shown

OF_STIFFNESS = re.compile(r"\bk\b|stiffness|reduction|rows|loss")  # words that mark an assumption on stiffness


def split(file, assumptions, given, tables):
    """Return the valid assumptions, the changed values, and whether a value of the source was changed.

    The arguments are the checked ``[[assumption]]`` tables, the values `given` by the source by dotted key, and the scene's
    `tables` with defaults. The first result has ``what``, ``why`` and ``depends`` of each valid assumption. The second is a
    text for each value that differs from that of the source or from the assumed one. The third is True if a value of the
    source was changed, so that the scene is no longer the machine of the source. ValueError if a key names no value of the
    scene.
    """
    kept, changed = [], {}
    for i, assumption in enumerate(assumptions):
        away = _away(file, f"assumption {i + 1}", assumption["holds"], tables)
        changed |= {
            key: f"{key} = {present!r} (assumed in the original: {shown(value)})" for key, (present, value) in away.items()
        }
        if not away:
            kept.append({name: assumption[name] for name in ("what", "why", "depends")})
    away = _away(file, "given", given, tables)
    changed |= {key: f"{key} = {present!r} (its source: {shown(value)})" for key, (present, value) in away.items()}
    return tuple(kept), tuple(changed.values()), bool(away)


def _away(file, where, values, tables):
    """Return the values of the scene that differ from `values`, by key: (value of the scene, entry of `values`)."""
    present = {key: _present(file, where, key, tables) for key in values}
    for key, value in values.items():
        _check_alike(f"{file} [{where}] {key!r} = {shown(value)}", value, present[key])
    return {key: (present[key], value) for key, value in values.items() if present[key] != value}


def _present(file, where, key, tables):
    """Return the value of a dotted key such as ``gear.sun.b_mm`` in nested tables. A list gives all values, or the common one.

    ValueError if there is no such value, or it is a table; the message names what there is.
    """
    value = tables
    for part in key.split("."):
        rows = value if isinstance(value, list) else [value]
        if not rows or not all(isinstance(row, dict) and part in row for row in rows):
            there = ", ".join(value) if isinstance(value, dict) else "no table"
            raise ValueError(f"{file} [{where}]: no value {key!r} in this scene; at {part!r} there is {there}")
        first, *rest = values = [row[part] for row in rows]
        value = values if any(other != first for other in rest) else first
    if isinstance(value, dict) or (isinstance(value, list) and any(isinstance(entry, dict) for entry in value)):
        raise ValueError(f"{file} [{where}] {key!r} is a table, but give single values: {key}.KEY = VALUE")
    return value


def _check_alike(what, value, present):
    """Raise ValueError unless a stated value has the type of that of the scene. `what` is the place and the value in words."""
    entries = value if isinstance(value, list) else [value]
    types = {_type(one) for one in (present if isinstance(present, list) else [present]) if one is not None}
    listed = isinstance(value, list) and present is not None and not isinstance(present, list)
    if listed or not entries or None in map(_type, entries) or (types and not types & set(map(_type, entries))):
        raise ValueError(f"{what}, but the value of the scene is {shown(present)}: give a value of the same type")


def _type(value):
    """Return ``"number"``, ``"truth"`` or ``"text"``, or None for tables, dates and numbers that are not finite."""
    if isinstance(value, (bool, str)):
        return "truth" if isinstance(value, bool) else "text"
    return "number" if is_finite(value) else None


def of_stiffness(assumptions):
    """Return the assumptions on which the mesh stiffness depends, or that state no effects."""
    return [assumption for assumption in assumptions if not assumption["depends"] or OF_STIFFNESS.search(assumption["depends"])]
