"""Check of the tables of a file against a schema. Messages state file, table, key and value as typed."""

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from ..geometry.checks import shown
from .schema import LISTS, NAMES, REQUIRED, KeyTable, scene_schema, schema_of

LARGEST, MOST = 1e30, 2**63  # limits of lengths, forces and stiffnesses in any unit, and of integers
PLAIN = {"boolean": bool, "values": dict}  # key types other than numbers and texts


@dataclass(slots=True)
class Reading:
    """Reader of one file by the `tables` of a schema.

    `references` (place, type, key, name) are keys that name a table.
    """

    file: str
    tables: Mapping[str, KeyTable]
    references: list[tuple[str, str, str, str]] = field(default_factory=list)

    def row(self, name: str, where: str, given: Any) -> dict[str, Any]:
        """Return the checked values of the `given` table ``[where]`` and its nested tables, including defaults.

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
        if wrong := _wrong(key, value):
            raise ValueError(f"{self.file} [{where}] {key.name} = {shown(value)}{wrong}")
        if (kind := LISTS.get(key.type, key.type)) in NAMES:
            self.references += [(where, kind, key.name, name) for name in (value if kind != key.type else [value])]
        return value

    def _nested(self, key, where, value):
        if value is None:
            return None
        place, heading = f"{where}.{key.name}" if where else key.name, key.heading(where)
        if value is REQUIRED or (key.default is REQUIRED and value in ({}, [])):
            raise ValueError(f"{self.file}: no table {heading}; give at least one: {key.text}")
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
        """Raise ValueError if a key names a table (gear, pair, shaft, ...) that the `rows` of the scene do not have."""
        for where, kind, key, name in self.references:
            check_known(self.file, where, key, name, rows[kind], kind)


def checked(package: str, name: str, file: str, where: str, given: Any) -> dict[str, Any]:
    """Return the row of one table of a package's schema, as `Reading.row` does."""
    return Reading(file, schema_of(package)).row(name, where, given)


def fits(value: Any, kind: str, count: int | None = None) -> bool:
    """Return whether a value has the type of a key, or is a list of `count` such values."""
    if kind in LISTS:
        return isinstance(value, list) and count in (None, len(value)) and all(fits(one, LISTS[kind]) for one in value)
    if kind not in ("number", "integer"):
        return isinstance(value, PLAIN.get(kind, str))
    if isinstance(value, int):
        return not isinstance(value, bool) and abs(value) < MOST
    return kind == "number" and isinstance(value, float) and abs(value) < LARGEST


def _wrong(key, value):
    """Return the message on a value that the schema does not permit. The result is empty if it is permitted."""
    if not fits(value, key.type, key.count):
        return f": expected {key.expected}{_limit(value)}"
    if key.distinct and not 0 < len(set(value)) == len(value):
        return ": give different numbers, one or more"
    return "" if key.permits(value) else f", but {'each number' if key.type in LISTS else 'it'} must {key.permitted}"


def _limit(value):
    """Return the part of a message that states the largest permitted number, if the number is too large."""
    return f", below {LARGEST:g}" if isinstance(value, (int, float)) and abs(value) >= MOST else ""


def check_no_scene(file: str, kind: str, data: Mapping[str, Any]) -> None:
    """Raise ValueError for a scene in place of a file of a `kind`."""
    if "scene" not in data and "gear" in data:
        raise ValueError(f"{file} is a scene, but give a {kind}: a TOML file that names the scene, scene = {file!r}")


def unknown(name: Any, names: Iterable[str]) -> str:
    """Return the message on an unknown key, with the nearest of the known `names`."""
    from difflib import get_close_matches

    near = get_close_matches(str(name), names := list(names), 1)
    hint = f" (nearest: {near[0]!r})" if near else ""
    if name in ("damaged_planet", "planet") and {"floating", "tangential_um"} & set(names):
        hint = ' (former key, counted from 0: give body = "planet1", the first, in the table of the damage or pin)'
    return f"unknown key {shown(name)}{hint}; expected {', '.join(names)}"


def check_known(file: str, where: str, key: str, name: Any, names: Iterable[str], kind: str) -> None:
    """Raise ValueError for a `name` that is not among `names`."""
    if name not in names:
        raise ValueError(f"{file} [{where}] {key} = {shown(name)}: no such {kind}; there is {', '.join(names)}")


def check_named(file: str, kind: str, tables: Any) -> None:
    """Raise ValueError unless the value is a table of named tables, written as ``[flank.NAME]``."""
    if isinstance(tables, list) and all(isinstance(table, dict) for table in tables):
        raise ValueError(f"{file}: [[{kind}]] is a list of tables, but they have names: write [{kind}.NAME]")
    if not isinstance(tables, Mapping):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give tables with names: [{kind}.NAME]")


def check_listed(file: str, kind: str, tables: Any) -> None:
    """Raise ValueError unless the value is a list of tables, written as ``[[crack]]``."""
    if isinstance(tables, dict):
        raise ValueError(f"{file}: [{kind}] is one table, but there may be several: write [[{kind}]]")
    if not isinstance(tables, list):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give a list of tables: [[{kind}]]")


@contextmanager
def located(file: str, where: str, row: Mapping[str, Any] | None = None) -> Iterator[None]:
    """Context that prefixes ValueErrors with file and table of a scene, and writes the keys of a `row` as typed."""
    try:
        yield
    except ValueError as error:
        table = scene_schema()[re.split("[. ]", where)[0]]
        raise ValueError(f"{file} [{where}]: {table.explained(row, str(error)) if row else error}") from error
