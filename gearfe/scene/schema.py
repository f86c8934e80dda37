"""Schema of TOML files: type, unit, range, default and description of each key.

The keys of a scene are defined in ``keys.toml``, those of sweeps and data sets in files of the same form. An invalid value raises
a ValueError with file, table, key and value as typed, and the permitted values.
"""

import math
import operator
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ..geometry.checks import shown

REQUIRED = object()
LISTS = {  # by type of list: type of its entries
    "numbers": "number", "strings": "string", "tables": "values", "gears": "gear", "bearings": "bearing",
}  # fmt: skip
NAMES = ("gear", "pair", "material", "shaft", "bearing")  # key types that name a table
TYPES = {
    "number": "a number", "integer": "a whole number", "string": "a text", "boolean": "true or false",
    "numbers": "a list of numbers", "strings": "a list of texts", "tables": "a list of tables",
    "values": "a table of values by dotted key", "gears": "a list of texts", "bearings": "a list of texts",
}  # fmt: skip
UNIT = re.compile(r"_([A-Za-z]+_per_\w+|mm|deg|um|N|MPa|Nm|rpm|s|Hz|kg|kgm2)$")
IN_PYTHON: dict[str, Callable[[float], float]] = {  # conversion from TOML units to those of the library: mm, N, MPa, rad
    "deg": math.radians,
    "um": lambda value: value * 1e-3,
    "N/um": lambda value: value * 1e3,
    "Nm/mrad": lambda value: value * 1e6,
    "urad/kN": lambda value: value / 1e9,
}
SPELLED = {"deg": "degrees", "Nm": "N m", "kgm2": "kg m2"}  # units in messages
# pattern of a value with its unit in a message
QUANTITY = r" = (?:[\[(][^\])]*[\])]|[-+\w.]+)(?: (?:N mm/rad|N/mm(?:\^3)?|rad/N|N m|mm|um|rad|MPa|N)\b)?"

IN_MM = re.compile(r"[;:] amounts are in mm \(20 um are 0\.02\)")  # a hint for Python; keys of scenes state their unit


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a table. `keys.toml` describes its attributes."""

    name: str
    text: str
    type: str = "number"
    default: Any = REQUIRED
    optional: str = ""
    min: float | None = None
    max: float | None = None
    above: float | None = None
    below: float | None = None
    choices: tuple[str, ...] = ()
    count: int | None = None
    distinct: bool = False
    usual: tuple[float, ...] = ()
    example: str = ""
    other: bool = False
    argument: str = ""
    of: str = ""
    names: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()
    needed: bool = False

    @property
    def unit(self) -> str:
        """Unit at the end of its name, such as ``N/um``. The result is empty if there is none."""
        found = UNIT.search(self.name)
        return found[1].replace("_per_", "/") if found and not self.of else ""

    @property
    def label(self) -> str:
        """Name of the quantity: the beginning of its description."""
        return self.text.split(";")[0]

    @property
    def python_name(self) -> str:
        """Name of the Python argument that corresponds to the key."""
        return self.argument or UNIT.sub("", self.name)

    def heading(self, place: str = "") -> str:
        """Heading of the tables of this key at a `place`: ``[gear.NAME]``, ``[[crack]]``, ``[machine.impact]``."""
        name = f"{place}.{self.name}" if place else self.name
        return {"listed": f"[[{name}]]", "named": f"[{name}.NAME]"}.get(self.type, f"[{name}]")

    @property
    def expected(self) -> str:
        """Type and unit in words."""
        words = TYPES.get(self.type, "a text").replace("a list of", "two" if self.count == 2 else "a list of")
        return f"{words} in {SPELLED.get(self.unit, self.unit)}" if self.unit else words

    @property
    def permitted(self) -> str:
        """Permitted range or choices as words after "must". The text is empty if everything is permitted."""
        unit = f" {SPELLED.get(self.unit, self.unit)}" if self.unit else ""
        if self.choices:
            return f"be one of {', '.join(self.choices)}"
        if None not in (self.min, self.max):
            return f"lie between {self.min:g} and {self.max:g}{unit}"
        bounds = {"at least": self.min, "above": self.above, "at most": self.max, "below": self.below}
        stated = " and ".join(f"{word} {bound:g}" for word, bound in bounds.items() if bound is not None)
        return f"be {stated}{unit}" if stated else ""

    def permits(self, value: Any) -> bool:
        """Return whether a value of the right type is in the permitted range."""
        if self.choices:
            return value in self.choices
        numbers = value if isinstance(value, (list, tuple)) else [value]
        if (self.min, self.above, self.max, self.below) == (None, None, None, None):
            return True
        rules = ((self.min, operator.ge), (self.above, operator.gt), (self.max, operator.le), (self.below, operator.lt))
        return all(compare(one, bound) for bound, compare in rules if bound is not None for one in numbers)

    def in_python(self, value: Any) -> Any:
        """Return the value in the units of the library. A list becomes a tuple."""
        convert = IN_PYTHON.get(self.unit, lambda one: one)
        return tuple(map(convert, value)) if isinstance(value, (list, tuple)) else convert(value)


@dataclass(frozen=True, slots=True)
class KeyTable:
    """Table of keys, with rules for their combination."""

    name: str
    about: str
    keys: dict[str, Key]
    one_of: tuple[str, ...] = ()
    exclude: tuple[tuple[str, str], ...] = ()
    together: tuple[tuple[str, str], ...] = ()

    def as_typed(self, row: Mapping[str, Any], text: str) -> str:
        """Return a message of the library with the keys and values of a `row` as typed by the user."""
        for key in self.keys.values():
            if (value := row.get(key.name)) is not None and key.python_name != key.name:
                typed = f"{key.name} = {shown(value)}".replace("\\", r"\\")
                text = re.sub(rf"\b{key.python_name}{QUANTITY}", typed, text)
            text = re.sub(rf"\bgive {key.python_name}=None for\b", f"leave out {key.name} for", text)
            if "_" in key.python_name:
                text = re.sub(rf"\b{key.python_name}\b(?! =)", key.name, text)
        return re.sub(r"([-\d.]+) to ([-\d.]+) rad\b", _in_degrees, text)

    def explained(self, row: Mapping[str, Any], text: str) -> str:
        """Return a message `as_typed`. If it contains no number of the `row`, append those that differ from the defaults."""
        text = IN_MM.sub("", self.as_typed(row, text))
        numbers = {
            key.name: row[key.name]
            for key in self.keys.values()
            if key.type in ("number", "integer", "numbers") and row.get(key.name) not in (None, key.default)
        }
        if any(re.search(rf"\b{name}\b", text) for name in numbers if name not in ("z", "x")):
            return text
        return f"{text} (given: {', '.join(f'{name} = {shown(value)}' for name, value in numbers.items())})" if numbers else text

    def _rules(self, row):
        """Yield the rules on combinations of keys that a row violates."""
        given = {name for name, value in row.items() if value is not None and value != self.keys[name].default}
        if self.one_of and len(given.intersection(self.one_of)) != 1:
            stated = (f"{name} ({self.keys[name].label})" for name in self.one_of)
            yield f"give {' or '.join(stated)}, one of them"
        yield from (f"{one} and {two} exclude each other: give one" for one, two in self.exclude if {one, two} <= given)
        yield from self._of_kind(row.get("kind"), given)
        yield from (f"give {one} and {two} together" for one, two in self.together if (one in given) != (two in given))

    def _of_kind(self, kind, given):
        """Yield the missing and the forbidden keys of a row of a kind."""
        of_kinds = [key for key in self.keys.values() if key.kinds]
        own = [key for key in of_kinds if kind in key.kinds]
        has = ", ".join(key.name for key in own) or "no other key"
        yield from (f"kind = {kind!r} needs {key.name}" for key in own if key.needed and key.name not in given)
        yield from (
            f"kind = {kind!r} has no {key.name}; expected {has}" for key in of_kinds if key not in own and key.name in given
        )


@cache
def schema_of(package: str, file: str = "keys.toml") -> dict[str, KeyTable]:
    """Return the tables by name of a schema, which is a file of a package."""
    home = Path(__file__).parents[1].joinpath(*package.split(".")[1:])
    data = tomllib.loads((home / file).read_text(encoding="utf-8"))
    return {name: _table(name, table) for name, table in data.items()}


def scene_schema() -> dict[str, KeyTable]:
    """Return the tables by name of the scene schema. ``"scene"`` is the top level of a file."""
    return schema_of("gearfe.scene")


def _in_degrees(found):
    return " to ".join(f"{math.degrees(float(number)):.6g}" for number in found.groups()) + " degrees"


def _table(name, data):
    keys = {key: _key(key, stated) for key, stated in data.items() if isinstance(stated, dict)}
    rules = {key: _frozen(stated) for key, stated in data.items() if not isinstance(stated, dict)}
    return KeyTable(name, rules.pop("about").strip("\n"), keys, **rules)


def _key(name, stated):
    nested = {"of": name} if stated.get("type") in ("table", "named", "listed") else {}
    default = {"default": None} if "optional" in stated else {}
    frozen = {key: value if key == "default" else _frozen(value) for key, value in stated.items()}
    return Key(name, **nested | default | frozen)


def _frozen(value):
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def in_words(kind: str, thing: Any, *names: str) -> str:
    """Describe the finite nonzero numbers of a library object by keys of the scene table (default: all keys).

    >>> from gearfe import Support
    >>> in_words("support", Support(radial=2e5, torsion=4e8))
    'radial stiffness 200 N/um, torsional stiffness 400 Nm/mrad'
    """
    keys = scene_schema()[kind].keys
    values = {keys[name]: getattr(thing, keys[name].python_name, None) for name in names or keys}
    given = {key: value for key, value in values.items() if isinstance(value, float) and value and math.isfinite(value)}
    return ", ".join(f"{key.label} {value / key.in_python(1.0):.4g} {key.unit}" for key, value in given.items())


def arguments(kind: str, row: Mapping[str, Any], *names: str) -> dict[str, Any]:
    """Return Python arguments in units of the library from the given keys of a checked `row` of a scene table.

    They are those of `names`, by default all except keys that state the location of the row.
    """
    keys = scene_schema()[kind].keys
    wanted = names or [key.name for key in keys.values() if key.type not in NAMES and key.name not in ("case", "body")]
    return {keys[name].python_name: keys[name].in_python(row[name]) for name in wanted if row[name] is not None}
