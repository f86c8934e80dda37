"""Fields of frozen records. They are checked once, when the record is created."""

import math
from collections.abc import Collection
from difflib import get_close_matches
from typing import Any

import numpy as np

from .checks import number, numbers


def settle(record: Any, **values: Any) -> None:
    """Set fields of a frozen record during its initialisation."""
    for name, value in values.items():
        object.__setattr__(record, name, value)


def ranged(
    name: str,
    value: Any,
    unit: str = "",
    *,
    least: float = -math.inf,
    above: float = -math.inf,
    finite: bool = True,
    remedy: str = "",
) -> float:
    """Return the number as a float.

    Parameters
    ----------
    name, value, unit
        As the message states them.
    least, above : float
        The number is `least` or more, and larger than `above`.
    finite : bool
        Whether it must be finite.
    remedy : str
        End of the message.

    Raises
    ------
    ValueError
        If the value is no such number.
    """
    try:
        out = number(name, value)
    except OverflowError:
        out = math.inf
    if (finite and not math.isfinite(out)) or out < least or (above > -math.inf and out <= above):
        limit = f" >= {least:g}" if least > -math.inf else f" > {above:g}" if above > -math.inf else ""
        raise ValueError(f"{name} = {out:g}{unit}, but give a {'finite ' if finite else ''}number{limit}{remedy}")
    return out


def settle_numbers(record: Any, what: str, names: str, unit: str = "", **limits: Any) -> None:
    """Convert the fields in `names` (separated by blanks) to floats within the `limits` of `ranged`.

    `what` is the beginning of the error message.
    """
    for name in names.split():
        settle(record, **{name: ranged(f"{what}: {name}", getattr(record, name), unit, **limits)})


def check_rows(record: Any, names: str) -> None:
    """Raise ValueError unless these fields have equally many rows. Fields that are None are ignored."""
    rows = {name: np.shape(getattr(record, name))[:1] for name in names.split() if getattr(record, name) is not None}
    first = next(iter(rows.values()))
    if not first or first == (0,) or set(rows.values()) != {first}:
        stated = ", ".join(f"{name} {shape[0] if shape else 'none'}" for name, shape in rows.items())
        raise ValueError(f"{type(record).__name__}: give arrays with the same number of rows, at least one; here: {stated}")


def check_named(what: str, name: Any, known: Collection[Any]) -> None:
    """Raise ValueError with the nearest known name if a name is not in `known`."""
    if name not in known:
        near = get_close_matches(str(name), list(map(str, known)), 1, 0.0)
        raise ValueError(f"{what} {name!r}, but there is {', '.join(map(str, known))}; nearest: {', '.join(map(repr, near))}")


def check_keys(what: str, given: Collection[Any], keys: Collection[str], *, only: bool = False) -> None:
    """Raise ValueError if one of the `keys` is missing. With `only`, other keys are rejected too."""
    if missing := [key for key in keys if key not in given]:
        raise ValueError(f"{what} of {missing[0]!r} is missing: give it for {', '.join(keys)}")
    if only and (other := [key for key in given if key not in keys]):
        raise ValueError(f"{what} of {other[0]!r}, but give it for {', '.join(keys)} only")


def check_text(what: str, name: Any) -> None:
    """Raise ValueError unless a name is a non-empty text."""
    if not isinstance(name, str) or not name:
        raise ValueError(f"{what}: name = {name!r}, but give a text that is not empty")


def settle_row(record: Any, what: str) -> None:
    """Check the name of an element of a machine, and convert its row to an array ``(n,)`` of finite numbers."""
    check_text(what, record.name)
    row = numbers(f"{what} {record.name}: row", record.row, "")
    if row.ndim != 1 or not np.isfinite(row).all():
        raise ValueError(f"{what} {record.name}: its row needs finite numbers, one per degree of freedom")
    settle(record, row=row)
