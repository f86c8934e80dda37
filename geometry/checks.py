"""Checks of what geometry is given: numbers, and things given by gear."""

import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any, TypeGuard


def is_number(value: object) -> TypeGuard[float]:
    """Whether it is a real number: no text, no truth value."""
    return isinstance(value, Real) and not isinstance(value, bool)


def is_finite(value: object) -> TypeGuard[float]:
    """Whether it is a finite real number."""
    return is_number(value) and math.isfinite(value)


def is_whole(value: object) -> TypeGuard[int]:
    """Whether it is a whole number of an integer type."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def by_gear(what: str, values: Any, example: str) -> tuple[Any, Any]:
    """What is given for pinion and wheel, None where nothing is; ValueError, with an `example`, if it is not given by gear."""
    values = {} if values is None else values
    if not isinstance(values, Mapping):
        raise ValueError(f"{what} = {values!r}, but give {what} by gear: {example}")
    if unknown := set(values) - {"pinion", "wheel"}:
        raise ValueError(f"{what} of {unknown.pop()!r}, but give {what} for 'pinion' and 'wheel'")
    return values.get("pinion"), values.get("wheel")
