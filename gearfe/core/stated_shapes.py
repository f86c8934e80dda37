"""Comparison of the arrays of a record with its docstring, which states shapes and where nan or infinity may occur.

Without docstrings (``python -OO``) nothing is compared.
"""

import dataclasses
import functools
import inspect
import math
import re
from typing import NamedTuple

import numpy as np

ATTRIBUTE = re.compile(r"(\w+(?:, \w+)*) : (.*)")  # line of numpydoc: names and type
SHAPE = re.compile(r"(?:ndarray|tuple).*shape \((.*?)\)")
SIZE = re.compile(r"(\d*) ?([A-Za-z_]\w*)|(\d+)")  # size of an axis: n, 2n or 3
SPECIAL = re.compile(r"\b(nan|inf|infinite|infinity)\b")


class _Stated(NamedTuple):
    shape: str  # "n, m"; empty without one
    special: bool  # True if nan or infinity may occur


@functools.cache
def _attributes(kind):
    """Return the fields that the docstring of a record describes, by name."""
    defaults = {field.name: field.default for field in dataclasses.fields(kind) if field.init}
    stated, names = {}, []
    for line in ((kind.__doc__ and inspect.getdoc(kind)) or "").splitlines():
        if found := ATTRIBUTE.fullmatch(line):
            names = [name for name in found[1].split(", ") if name in defaults]
            shape = SHAPE.search(found[2])
            stated |= {name: _Stated(shape[1] if shape else "", defaults[name] == math.inf) for name in names}
        if line.startswith("---"):  # The next section begins.
            names = []
        if SPECIAL.search(line):
            stated |= {name: stated[name]._replace(special=True) for name in names}
    return stated


def check_stated(record):
    """Raise ValueError unless arrays have the stated shapes. They must be finite unless an exception is stated."""
    sizes = {}
    for name, (shape, special) in _attributes(type(record)).items():
        value = getattr(record, name)
        what = f"{type(record).__name__}: {name}"
        if shape and isinstance(value, (np.ndarray, tuple)):
            _check_shape(what, (len(value),) if isinstance(value, tuple) else value.shape, shape, sizes)
        number = isinstance(value, float) or (isinstance(value, np.ndarray) and value.dtype.kind == "f")
        if number and not special and not np.isfinite(value).all():
            stated = f"{what} = {value}" if isinstance(value, float) else f"{what} has nan or infinite values"
            raise ValueError(f"{stated}, but give finite numbers")


def _check_shape(what, given, shape, sizes):
    """Compare a shape with the stated one. `sizes` are the known axis lengths by letter, to which new ones are added."""
    axes = [one.strip() for one in shape.split(",") if one.strip()]
    fits = len(axes) == len(given)
    for axis, size in zip(axes, given, strict=False):
        if found := SIZE.fullmatch(axis):
            factor, letter = int(found[3] or found[1] or 1), found[2]
            fits &= size == factor * (sizes.setdefault(letter, size // factor) if letter else 1)
    if not fits:
        known = ", ".join(f"{letter} = {size}" for letter, size in sizes.items() if letter in shape)
        raise ValueError(f"{what} has the shape {given}, but give ({shape}){' with ' if known else ''}{known}")
