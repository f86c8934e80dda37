"""Conversion of flexibilities to arrays with a description for files, and back.

The conversion is exact to the last bit. The files do not contain the gear, so the reader must state it.
"""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..geometry.cubic import Bicubic, Cubic
from ..geometry.tooth.gear import Gear
from .plane import Flexibility, SeamFaces
from .solid import Faces, Flexibility3D


def described(value: Any, arrays: list[NDArray]) -> list[Any]:
    """Append the arrays of a flexibility to `arrays`.

    Return the rest of the flexibility, without its gear, as a description for JSON.
    """
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return ["array"]
    if isinstance(value, Gear):
        return ["gear"]
    parts: tuple[Any, ...]
    if is_dataclass(value):
        kind, parts = type(value).__name__, tuple(getattr(value, field.name) for field in fields(value) if field.init)
    elif isinstance(value, (dict, tuple)):
        kind, parts = type(value).__name__, tuple(value.items() if isinstance(value, dict) else value)
    else:
        return ["number", value.item() if isinstance(value, np.generic) else value]
    return [kind, *(described(part, arrays) for part in parts)]


def restored(description: list[Any], arrays: Iterator[NDArray], gear: Gear) -> Any:
    """Return the flexibility from a description of `described`, the arrays in their order, and the gear."""
    kind, *parts = description
    if kind == "array":
        return next(arrays)
    if kind in ("gear", "number"):
        return gear if kind == "gear" else parts[0]
    return MADE[kind](*(restored(part, arrays, gear) for part in parts))


MADE: dict[str, Any] = {record.__name__: record for record in (Flexibility, SeamFaces, Flexibility3D, Faces, Cubic, Bicubic)} | {
    "dict": lambda *items: dict(items),
    "tuple": lambda *parts: parts,
}
