"""Checks of arguments, before any work: numbers, truth values, lengths, resolution."""

import math
from collections.abc import Collection
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..geometry.checks import LARGEST, WrongTypeError, is_number, is_whole, shown

MOST = 2**63  # largest whole number that an array holds, plus 1
COARSEST = 0.2  # The error of a section is 0.2 % at 0.4, 0.5 % at 0.2, and irregular below (25 % at 1e-9).
SHORTEST = 1e-4  # shortest length of a meshed part [mm], below the roughness of flanks
FINEST = 64.0  # largest `refine`; finer meshes change k by less than the errors of rounding and contact


def number(name: str, value: Any) -> float:
    """Return the number as a float.

    Raises ValueError for nan, truth values and anything that is not a number. Arrays without axes are accepted.
    """
    value = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 and not np.ma.is_masked(value) else value
    if is_whole(value) and not is_number(value):
        raise ValueError(f"{name} = {shown(value)}, but the maximum is {LARGEST:.2g}")
    if not is_number(value) or math.isnan(value):
        raise (ValueError if isinstance(value, Real) else WrongTypeError)(f"{name} = {shown(value)}, but it needs a number")
    return float(value)


def whole(name: str, value: Any, least: float = -MOST, most: int = MOST) -> int:
    """Return a whole number from `least` to `most`.

    Raises
    ------
    ValueError
        If it is another kind of number, ``24.0``, smaller or larger.
    """
    if is_whole(value) and value > most:
        raise ValueError(f"{name} = {shown(value)}, but the maximum is {most}")
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        close = is_number(value) and math.isfinite(value) and value == int(value) and value >= least
        remedy = f": give {name.rpartition(': ')[2]} = {int(value)}" if close else "" if least == -MOST else f" from {least} on"
        kind = ValueError if is_number(value) else WrongTypeError
        raise kind(f"{name} = {shown(value)}, but it must be a whole number{remedy}")
    return int(value)


def one_of(name: str, value: Any, known: Collection[str]) -> None:
    """Raise ValueError unless the value is one of the `known` values."""
    if not isinstance(value, str) or value not in known:
        raise ValueError(f"{name} = {shown(value)}, but it must be one of {', '.join(known)}")


def truth(name: str, value: Any) -> bool:
    """Return `value` if it is a bool. Text and numbers are rejected, since ``bool("no")`` is true."""
    if not isinstance(value, (bool, np.bool_)):
        raise WrongTypeError(f"{name} = {shown(value)}, but give True or False")
    return bool(value)


def numbers(name: str, value: Any, unit: str) -> NDArray:
    """Return one number or several as an array of floats. Text, truth values and complex numbers are rejected."""
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} = {value!r}, but give one number or a list of numbers{unit}") from error
    if np.ma.is_masked(value):
        raise ValueError(f"{name} has masked values: give numbers without masked entries{unit}")
    plain = array.dtype.kind in "iuf" and not has_truth(value)
    if not plain and not (array.dtype.kind == "O" and array.size and all(is_number(element) for element in array.ravel())):
        raise ValueError(f"{name} = {value!r}, but give one number or a list of numbers{unit}, not {_kind(value)}")
    return array.astype(float)


def has_truth(value):
    """Return whether a list of numbers contains a truth value."""
    return isinstance(value, (list, tuple)) and any(isinstance(element, (bool, np.bool_)) for element in value)


def _kind(value):
    return "text" if isinstance(value, str) else type(value).__name__


def checked_refine(refine: Any) -> float:
    """Return the resolution if it is valid for meshes: from `COARSEST` to `FINEST`.

    Raises
    ------
    ValueError
        If it is not a number, or outside this range.
    """
    if not is_number(refine) or not math.isfinite(refine):
        raise ValueError(f"refine = {refine!r}, but give a finite number: it divides the edge lengths")
    if not COARSEST <= refine <= FINEST:
        why = (
            "coarser meshes give wrong results"
            if refine < COARSEST
            else "k changes by less than 1e-6 from 16 on, and the memory is full"
        )
        raise ValueError(f"refine = {refine}, but give {COARSEST:g} to {FINEST:g}: {why}")
    return float(refine)


def check_length(name, value):
    """Raise ValueError unless a length is None (the default) or a number of at least `SHORTEST` [mm]."""
    if value is not None and not (is_number(value) and math.isfinite(value) and value >= SHORTEST):
        raise ValueError(f"{name} = {value!r} mm, but it is a length: give {name} > 0, at least {SHORTEST:g} mm, or leave it out")
