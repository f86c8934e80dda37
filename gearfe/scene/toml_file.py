"""TOML files as tables and back, and dictionaries of the same structure."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..core.file_readers import check_path
from ..geometry.aliases import StrPath
from ..geometry.renamed import warn_renamed

FORMER = {  # former keys and their replacements
    "crowning_um": "profile_crowning_um", "slope_um": "profile_slope_um", "lead_crowning_um": "helix_crowning_um",
    "lead_slope_um": "helix_slope_um", "F_beta_um": "F_beta_x_um", "tip_radius": "rack_tip_radius",
    "angles_deg": "planet_angles_deg",
}  # fmt: skip


def read_toml(file: Any) -> dict[str, Any]:
    """Return the tables of a file (path or package resource). Raises ValueError with the name if it is not TOML."""
    try:
        return _renamed(file.name, tomllib.loads(file.read_text(encoding="utf-8-sig")))
    # A ValueError means invalid UTF-8 or TOML, or integers of more than 4300 digits.
    except (OSError, ValueError, RecursionError) as error:
        raise ValueError(f"{file.name}: not readable as TOML: {error}") from error


def given_tables(given: StrPath | Mapping[str, Any], what: str) -> tuple[str, Path, dict[str, Any]]:
    """Return name, folder and tables of a TOML file. For a dictionary: `what`, the current folder, and its values.

    ValueError if the file does not exist or is not TOML.
    """
    if isinstance(given, Mapping):
        return what, Path(), _renamed(what, _plain(given))
    check_path(what, given)
    path = Path(given)
    if not path.is_file():
        raise ValueError(f"no {what} {str(given)!r}: give a .toml file")
    return path.name, path.parent, read_toml(path)


def _renamed(file, value):
    """Return the tables with former key names (also in dotted keys) replaced. Each replacement causes a note."""
    if isinstance(value, list):
        return [_renamed(file, entry) for entry in value]
    if not isinstance(value, dict):
        return value
    out = {}
    for key, entry in value.items():
        place, dot, last = key.rpartition(".")
        if last in FORMER:
            warn_renamed(f"{file}: key {last}", FORMER[last], FutureWarning)
            key = f"{place}{dot}{FORMER[last]}"
        out[key] = _renamed(file, entry)
    return out


def _plain(value):
    """Convert numpy numbers, arrays and tuples to plain numbers and lists, as in TOML."""
    if isinstance(value, Mapping):
        return {str(name): _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def toml(tables: dict[str, Any]) -> str:
    """Return the tables of a scene as the text of a TOML file that all verbs of gearfe read.

    >>> print(toml({"title": "t", "pair": {"stage": {"force_N": 2000.0}}, "crack": [{"case": "a"}]}), end="")
    title = "t"
    <BLANKLINE>
    [pair.stage]
    force_N = 2000.0
    <BLANKLINE>
    [[crack]]
    case = "a"
    """
    return "\n\n".join(filter(None, _written(tables, ""))) + "\n"


def _written(table, head, mark="["):
    alone = mark == "["
    plain = {key: value for key, value in table.items() if not (_tables(value) or (alone and isinstance(value, dict)))}
    lines = [f"{mark}{head}{mark.replace('[', ']')}"] if head and (plain or not alone) else []
    yield "\n".join([*lines, *(f"{_key(key)} = {toml_value(value)}" for key, value in plain.items())])
    for key, value in table.items():
        if _tables(value):
            for row in value:
                yield from _written(row, key, "[[")
        elif key not in plain:
            yield from _written(value, f"{head}.{_key(key)}" if head else _key(key))


def _tables(value):
    return isinstance(value, list) and bool(value) and all(isinstance(entry, dict) for entry in value)


def toml_value(value: Any) -> str:
    """Return a value in the notation of TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {toml_value(entry)}" for key, entry in value.items()) + " }" if value else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml_value, value))}]"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f") if isinstance(value, (str, bool)) else repr(value)


def _key(key):
    return key if key.isascii() and key.replace("_", "").isalnum() else toml_value(key)
