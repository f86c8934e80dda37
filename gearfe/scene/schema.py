"""Schema of TOML files: what each key is (type, unit, range, default, description), and the check of tables against it.

The keys of a scene are defined in ``keys.toml``, those of sweeps and data sets in files of the same form. A value that the schema
does not permit is a ValueError that names file, table, key and value as typed, and what is permitted.
"""

import math
import operator
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

REQUIRED = object()
LARGEST, MOST = 1e30, 2**63  # no length, force or stiffness is larger, in any unit; whole numbers that arrays can hold
SHOWN = 60  # characters of a value in a message
PLAIN = {"boolean": bool, "values": dict}
LISTS = {"numbers": "number", "strings": "string", "tables": "values"}  # type of list: type of its entries
NAMES = ("gear", "pair", "material")  # types of keys that name a table
TYPES = {
    "number": "a number", "integer": "a whole number", "string": "a text", "boolean": "true or false",
    "numbers": "a list of numbers", "strings": "a list of texts", "tables": "a list of tables",
    "values": "a table of values by dotted key",
}  # fmt: skip
UNIT = re.compile(r"_([A-Za-z]+_per_\w+|mm|deg|um|N|MPa|Nm|rpm|s|Hz|kg|kgm2)$")
IN_PYTHON: dict[str, Callable[[float], float]] = {  # units of TOML in those of the library: mm, N, MPa, rad
    "deg": math.radians,
    "um": lambda value: value * 1e-3,
    "N/um": lambda value: value * 1e3,
    "Nm/mrad": lambda value: value * 1e6,
    "urad/kN": lambda value: value / 1e9,
}
SPELLED = {"deg": "degrees", "Nm": "N m", "kgm2": "kg m2"}  # units as messages write them
QUANTITY = r" = (?:[\[(][^\])]*[\])]|[-+\w.]+)(?: (?:N mm/rad|N/mm(?:\^3)?|rad/N|N m|mm|um|rad|MPa|N)\b)?"  # a value in a message


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a table; `keys.toml` describes its attributes."""

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
        """Unit at the end of its name, such as ``N/um``; empty if there is none."""
        found = UNIT.search(self.name)
        return found[1].replace("_per_", "/") if found and not self.of else ""

    @property
    def python_name(self) -> str:
        """Name of the argument that it is in Python."""
        return self.argument or UNIT.sub("", self.name)

    def heading(self, place: str = "") -> str:
        """Heading of the tables it holds, in the table at a `place`: ``[gear.NAME]``, ``[[crack]]``, ``[machine.impact]``."""
        name = f"{place}.{self.name}" if place else self.name
        return {"listed": f"[[{name}]]", "named": f"[{name}.NAME]"}.get(self.type, f"[{name}]")

    @property
    def expected(self) -> str:
        """Type and unit in words."""
        words = "two numbers" if self.count == 2 else TYPES.get(self.type, "a text")
        return f"{words} in {SPELLED.get(self.unit, self.unit)}" if self.unit else words

    @property
    def permitted(self) -> str:
        """Permitted range or choices in words: what a value must; empty if everything is permitted."""
        unit = f" {SPELLED.get(self.unit, self.unit)}" if self.unit else ""
        if self.choices:
            return f"be one of {', '.join(self.choices)}"
        if None not in (self.min, self.max):
            return f"lie between {self.min:g} and {self.max:g}{unit}"
        bounds = {"at least": self.min, "above": self.above, "at most": self.max, "below": self.below}
        stated = " and ".join(f"{word} {bound:g}" for word, bound in bounds.items() if bound is not None)
        return f"be {stated}{unit}" if stated else ""

    def permits(self, value: Any) -> bool:
        """Whether a value of its type lies in the permitted range."""
        if self.choices:
            return value in self.choices
        numbers = value if isinstance(value, (list, tuple)) else [value]
        rules = ((self.min, operator.ge), (self.above, operator.gt), (self.max, operator.le), (self.below, operator.lt))
        return all(compare(one, bound) for bound, compare in rules if bound is not None for one in numbers)

    def in_python(self, value: Any) -> Any:
        """The value in the units of the library; a list as a tuple."""
        convert = IN_PYTHON.get(self.unit, lambda one: one)
        return tuple(map(convert, value)) if isinstance(value, (list, tuple)) else convert(value)


@dataclass(frozen=True, slots=True)
class KeyTable:
    """A table of keys, with the rules on which of them go together."""

    name: str
    about: str
    keys: dict[str, Key]
    one_of: tuple[str, ...] = ()
    exclude: tuple[tuple[str, str], ...] = ()
    together: tuple[tuple[str, str], ...] = ()

    def as_typed(self, row: Mapping[str, Any], text: str) -> str:
        """A message of the library with the keys and values of a `row` as they are typed."""
        for key in self.keys.values():
            if (value := row.get(key.name)) is not None and key.python_name != key.name:
                typed = f"{key.name} = {shown(value)}".replace("\\", r"\\")
                text = re.sub(rf"\b{key.python_name}{QUANTITY}", typed, text)
            if "_" in key.python_name:
                text = re.sub(rf"\b{key.python_name}\b(?! =)", key.name, text)
        return re.sub(r"([-\d.]+) to ([-\d.]+) rad\b", _in_degrees, text)

    def _rules(self, row):
        """What a row breaks of the rules on which keys go together."""
        given = {name for name, value in row.items() if value is not None and value != self.keys[name].default}
        if self.one_of and len(given.intersection(self.one_of)) != 1:
            stated = (f"{name} ({re.split('[;,]', self.keys[name].text)[0]})" for name in self.one_of)
            yield f"give {' or '.join(stated)}, one of them"
        yield from (f"{one} and {two} exclude each other: give one" for one, two in self.exclude if {one, two} <= given)
        kind, of_kinds = row.get("kind"), [key for key in self.keys.values() if key.kinds]
        has = ", ".join(key.name for key in of_kinds if kind in key.kinds) or "no other key"
        missing = (key.name for key in of_kinds if key.needed and kind in key.kinds and key.name not in given)
        yield from (f"kind = {kind!r} needs {name}" for name in missing)
        wrong = (key.name for key in of_kinds if kind not in key.kinds and key.name in given)
        yield from (f"kind = {kind!r} has no {name}; expected {has}" for name in wrong)
        yield from (f"give {one} and {two} together" for one, two in self.together if (one in given) != (two in given))


@dataclass(slots=True)
class Reading:
    """The reading of one file by the `tables` of a schema; `references` are (place, key, name) of keys that name a table."""

    file: str
    tables: Mapping[str, KeyTable]
    references: list[tuple[str, Key, str]] = field(default_factory=list)

    def row(self, name: str, where: str, given: Any) -> dict[str, Any]:
        """Values of the table ``[where]``, that is `given`, with defaults filled in; nested tables too.

        Parameters
        ----------
        name : str
            Of the table in the schema.
        where : str
            Its place in the file, for messages; ``"top level"`` is not part of the places below it.
        given : dict

        Returns
        -------
        dict
            Values by key as typed; None where an optional key is left out.

        Raises
        ------
        ValueError
            If a key is unknown, missing, of another type or out of range, or keys contradict each other.
        """
        table = self.tables[name]
        if not isinstance(given, Mapping):
            raise ValueError(f"{self.file} [{where}]: expected a table of keys and values, got {shown(given)}")
        for key in given:
            if key not in table.keys:
                raise ValueError(f"{self.file} [{where}]: {unknown(key, table.keys)}")
        row = {key.name: self._value(key, where, given) for key in table.keys.values()}
        for broken in table._rules(row):
            raise ValueError(f"{self.file} [{where}]: {broken}")
        return row

    def _value(self, key, where, given):
        if key.of:
            return self._nested(key, "" if where == "top level" else where, given.get(key.name, key.default))
        if key.name not in given:
            if key.default is REQUIRED:
                raise ValueError(f"{self.file} [{where}]: missing key {key.name!r}; expected {key.expected}")
            return key.default
        value = given[key.name]
        stated = f"{self.file} [{where}] {key.name} = {shown(value)}"
        if not fits(value, key.type, key.count):
            raise ValueError(f"{stated}: expected {key.expected}{_limit(value)}")
        if key.distinct and not 0 < len(set(value)) == len(value):
            raise ValueError(f"{stated}: give different numbers, one or more")
        if not key.permits(value):
            raise ValueError(f"{stated}, but {'each number' if key.type in LISTS else 'it'} must {key.permitted}")
        if key.type in NAMES:
            self.references.append((where, key, value))
        return value

    def _nested(self, key, where, value):
        if value is None:
            return None
        place, heading = f"{where}.{key.name}" if where else key.name, key.heading(where)
        if value is REQUIRED or (key.default is REQUIRED and value in ({}, [])):
            raise ValueError(f"{self.file}: no table {heading}; give one at least: {key.text}")
        if key.type == "table":
            return self.row(key.of, place, value)
        if key.type == "listed":
            check_listed(self.file, place, value)
            return [self.row(key.of, f"{place} {i + 1}", one) for i, one in enumerate(value)]
        check_named(self.file, place, value)
        if key.names and value and set(value) != set(key.names):
            there = ", ".join(value)
            raise ValueError(f"{self.file} [{place}]: {there}, but give a table for each of {', '.join(key.names)}, or none")
        return {name: self.row(key.of, f"{place}.{name}", one) for name, one in value.items()}

    def check_references(self, rows: Mapping[str, Any]) -> None:
        """Raise ValueError if a key names a table of a scene that is not among its `rows`."""
        for where, key, name in self.references:
            check_known(self.file, where, key.name, name, rows[key.type], key.type)


def checked(package: str, name: str, file: str, where: str, given: Any) -> dict[str, Any]:
    """Row of one table of the schema of a package, as `Reading.row` gives it."""
    return Reading(file, schema_of(package)).row(name, where, given)


@cache
def schema_of(package: str, file: str = "keys.toml") -> dict[str, KeyTable]:
    """Tables by name of a schema, a file of a package."""
    data = tomllib.loads((resources.files(package) / file).read_text(encoding="utf-8"))
    return {name: _table(name, table) for name, table in data.items()}


def scene_schema() -> dict[str, KeyTable]:
    """Tables by name of the schema of scenes; ``"scene"`` is the top level of a file."""
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


def fits(value: Any, kind: str, count: int | None = None) -> bool:
    """Whether a value is of a type of keys, a list of so many."""
    if kind in LISTS:
        return isinstance(value, list) and count in (None, len(value)) and all(fits(one, LISTS[kind]) for one in value)
    if kind not in ("number", "integer"):
        return isinstance(value, PLAIN.get(kind, str))
    if isinstance(value, int):
        return not isinstance(value, bool) and abs(value) < MOST
    return kind == "number" and isinstance(value, float) and abs(value) < LARGEST


def _limit(value):
    """Part of the message on a value: the largest number allowed, if it is a number that is too large."""
    return f", below {LARGEST:g}" if isinstance(value, (int, float)) and abs(value) >= MOST else ""


def shown(value: Any) -> str:
    """A value for a message: no longer than a line, whatever was given."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no whole numbers of more than 4300 digits
        return "a number of thousands of digits"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def unknown(name: Any, names: Iterable[str]) -> str:
    """Message on an unknown key, with the nearest of the known `names`."""
    from difflib import get_close_matches

    near = get_close_matches(str(name), names := list(names), 1)
    return f"unknown key {shown(name)}{f' (nearest: {near[0]!r})' if near else ''}; expected {', '.join(names)}"


def check_known(file: str, where: str, key: str, name: Any, names: Iterable[str], kind: str) -> None:
    """Raise ValueError for a `name` that is not among `names`."""
    if name not in names:
        raise ValueError(f"{file} [{where}] {key} = {shown(name)}: no such {kind}; there is {', '.join(names)}")


def check_named(file: str, kind: str, tables: Any) -> None:
    """Raise ValueError for anything but a table of named tables, as ``[flank.NAME]`` writes them."""
    if isinstance(tables, list) and all(isinstance(table, dict) for table in tables):
        raise ValueError(f"{file}: [[{kind}]] is a list of tables, but they have names: write [{kind}.NAME]")
    if not isinstance(tables, Mapping):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give tables with names: [{kind}.NAME]")


def check_listed(file: str, kind: str, tables: Any) -> None:
    """Raise ValueError for anything but a list of tables, as ``[[crack]]`` writes them."""
    if isinstance(tables, dict):
        raise ValueError(f"{file}: [{kind}] is one table, but there may be several: write [[{kind}]]")
    if not isinstance(tables, list):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give a list of tables: [[{kind}]]")


@contextmanager
def located(file: str, where: str, row: Mapping[str, Any] | None = None) -> Iterator[None]:
    """Context in which ValueErrors begin with file and table of a scene, and have the keys of a `row` as typed."""
    try:
        yield
    except ValueError as error:
        text = scene_schema()[re.split("[. ]", where)[0]].as_typed(row, str(error)) if row else str(error)
        raise ValueError(f"{file} [{where}]: {text}") from error


def arguments(kind: str, row: Mapping[str, Any], *names: str) -> dict[str, Any]:
    """Arguments in Python, in units of the library, of the keys of a checked `row` of a scene's table that are given.

    Those of these `names`, by default of all but the keys that say where it is.
    """
    keys = scene_schema()[kind].keys
    wanted = names or [key.name for key in keys.values() if key.type not in NAMES and key.name != "case"]
    return {keys[name].python_name: keys[name].in_python(row[name]) for name in wanted if row[name] is not None}
