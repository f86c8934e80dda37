"""TOML files as tables, and what may be given instead of one: a dictionary of the same structure."""

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np


def read_toml(file: Any) -> dict[str, Any]:
    """Tables of a file (a path, or a resource of the package); ValueError that names it if it is not TOML."""
    try:
        return tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:  # ValueError: no UTF-8, no TOML, whole numbers of 4300 digits
        raise ValueError(f"{file.name}: not readable as TOML: {error}") from error


def given_tables(given: str | os.PathLike[str] | Mapping[str, Any], what: str) -> tuple[str, Path, dict[str, Any]]:
    """Name of a file, its folder and its tables; of a dictionary `what` it is, the present folder, and plain values.

    ValueError if there is no such file, or it is not TOML.
    """
    if isinstance(given, Mapping):
        return what, Path(), _plain(given)
    path = Path(given)
    if not path.is_file():
        raise ValueError(f"no {what} {str(given)!r}: give a .toml file")
    return path.name, path.parent, read_toml(path)


def _plain(value):
    """Numbers and arrays of numpy, and tuples, as TOML would give them."""
    if isinstance(value, Mapping):
        return {str(name): _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
