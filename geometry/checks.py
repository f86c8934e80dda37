"""Checks of arguments of geometry: numbers, and dictionaries by gear."""

import math
import sys
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any, TypeGuard

LARGEST = sys.float_info.max
SHOWN = 60  # longest printed value [characters]


class WrongTypeError(TypeError, ValueError):
    """Error for an argument of a wrong Python type."""


def shown(value: Any) -> str:
    """Return a value for a message, at most a line long."""
    try:
        text = repr(value)
    except ValueError:  # Python does not convert integers of more than 4300 digits to text.
        return "a number of thousands of digits"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def is_number(value: object) -> TypeGuard[float]:
    """Return whether a value is a real number within the range of floats. Texts and truth values are not numbers."""
    return isinstance(value, Real) and not isinstance(value, bool) and not (is_whole(value) and abs(value) > LARGEST)


def is_finite(value: object) -> TypeGuard[float]:
    """Return whether a value is a finite real number."""
    return is_number(value) and math.isfinite(value)


def is_whole(value: object) -> TypeGuard[int]:
    """Return whether a value is a whole number of an integer type."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def by_gear(what: str, values: Any, example: str) -> tuple[Any, Any]:
    """Return the entries of pinion and wheel, or None for a missing entry.

    Raises ValueError, with an `example`, if it is not given by gear.
    """
    values = {} if values is None else values
    if not isinstance(values, Mapping):
        raise ValueError(f"{what} = {values!r}, but give {what} by gear: {example}")
    if unknown := set(values) - {"pinion", "wheel"}:
        raise ValueError(f"{what} of {unknown.pop()!r}, but give {what} for 'pinion' and 'wheel'")
    return values.get("pinion"), values.get("wheel")
