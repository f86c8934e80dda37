"""Input fields of the live page, from ``fields.toml`` and the schema of scenes. The browser builds its form from them."""

import json
import math
import tomllib
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from importlib import resources
from typing import Any

from ..geometry.checks import shown
from ..scene.parts import SIDES
from ..scene.schema import SPELLED, Key, scene_schema
from .damage import checked_damage, kinds

LONGEST = 200  # longest title [characters]


@dataclass(frozen=True, slots=True)
class PageField:
    """Field of the page.

    Attributes
    ----------
    name : str
        Name in the state and in a link; ``_1`` is the pinion's, ``_2`` the wheel's.
    group, label, unit : str
        Its heading, its label and its unit.
    start : object
        Value of the working example.
    places : tuple of str
        Dotted keys of the scene that hold it.
    low, high, step : float
        Bounds of the page's solver, and a step of the slider.
    whole : bool
    choices : tuple of str
        Permitted values instead of bounds.
    when : str
        ``name=value,value``: another field and the values with which this one is visible; empty: always.
    beside : str
        Another field. If it is 0, this field is ignored.
    absent : object
        Value of the field for an omitted key. None: no such value.
    by : dict
        Dotted keys by choice, which set the choice for a given key.
    """

    name: str
    group: str
    label: str
    unit: str
    start: Any
    places: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 0.0
    step: float = 0.1
    whole: bool = False
    choices: tuple[str, ...] = ()
    when: str = ""
    beside: str = ""
    absent: Any = None
    by: Any = None

    def counts(self, state: dict[str, Any]) -> bool:
        """Return whether the field is part of the scene of a state."""
        name, _, values = self.when.partition("=")
        shown = not name or (state[name] in values.split(",") and BY_NAME[name].counts(state))
        return shown and not (self.beside and not state[self.beside]) and (self.absent is None or state[self.name] != self.absent)

    def typed(self, value: Any) -> Any:
        """Return a value of the page in the form that a scene requires."""
        return value == self.choices[1] if key_at(self.places[0]).type == "boolean" else value

    def from_typed(self, value: Any) -> Any:
        """Return the value of the field on the page from the value in the scene, or None if the key is absent."""
        if value is None:
            return self.start if self.absent is None else self.absent
        if isinstance(value, bool):
            return self.choices[value]
        return float(value) if isinstance(value, int) and not self.whole else value


SPELLED_SIDES = dict(zip("12", SIDES, strict=True))


def key_at(place: str) -> Key:
    """Return the key of the schema for a dotted key of a scene of one pair."""
    kind, *rest = (part for part in place.split(".") if not part.isdigit())
    return scene_schema()[kind].keys[rest[-1]]


def _fields() -> Iterator[PageField]:
    text = (resources.files("gearfe.app") / "fields.toml").read_text(encoding="utf-8")
    for group, fields in tomllib.loads(text).items():
        for name, stated in fields.items():
            field = _field(name, group, **stated)
            if not any("{}" in place for place in field.places):
                yield field
                continue
            for (i, side), start in zip(SPELLED_SIDES.items(), field.start, strict=True):
                label, beside = f"{field.label}, {side}", field.beside and f"{field.beside}_{i}"
                places = tuple(place.format(side) for place in field.places)
                yield replace(field, name=f"{name}_{i}", label=label, start=start, beside=beside, places=places)


def _field(name, group, *, start, at=(), label="", unit="", choices=(), absent=None, **more):
    """Return the field of a row of ``fields.toml``."""
    places = (at,) if isinstance(at, str) else tuple(at)
    if not places:
        return PageField(name, group, label, unit, start, choices=tuple(choices), **more)
    key = key_at(places[0])
    label = label or key.label
    label += f" (0: {key.optional})" if absent == 0 and key.optional else ""
    unit = {"um": "µm", "deg": "°"}.get(key.unit, SPELLED.get(key.unit, key.unit.replace("Nm/", "N m/").replace("um", "µm")))
    if key.type in ("string", "gear", "boolean"):
        given = tuple(choices) or key.choices
        return PageField(
            name, group, label, "", start, places, choices=given if absent is None else (absent, *given), absent=absent, **more
        )
    return PageField(name, group, label, unit, start, places, *key.usual, whole=key.type == "integer", absent=absent, **more)


FIELDS = tuple(_fields())
BY_NAME = {one.name: one for one in FIELDS}
TEXTS = {"title": "", "source": "own gear pair"}
NOTE = {"what", "why", "depends", "holds"}  # keys of an assumption
CRACK = {"kind": "crack", "gear": "pinion", "length_mm": 2.0, "angle_deg": 60.0}
START = {one.name: one.start for one in FIELDS} | TEXTS | {"damage": [CRACK], "assumption": []}


def form() -> str:
    """Return the fields, those of each kind of damage, and the state of the working example as JSON, for the browser."""
    return json.dumps({"fields": [asdict(field) for field in FIELDS], "kinds": kinds(), "start": START})


def checked_state(given: Any) -> dict[str, Any]:
    """Return a state of the page with defaults for missing fields.

    The keys are the names of the `PageField` records, ``title``, ``source``, ``damage`` (a list of rows, see `gearfe.app.damage`)
    and ``assumption`` (a list of such tables of a scene). ValueError if a key is unknown, or a value has another type or is
    outside the bounds of its field.
    """
    if not isinstance(given, dict):
        raise ValueError(f"state = {shown(given)}, but give a table of values by field")
    for name in given:
        if name not in START:
            raise ValueError(f"no field {shown(name)}; the page has {', '.join(START)}")
    out = START | given
    for field in FIELDS:
        out[field.name] = _value(field, out[field.name])
    for name in TEXTS:
        if not isinstance(out[name], str) or len(out[name]) > 4 * LONGEST:
            raise ValueError(f"{name} = {shown(out[name])}: expected a text of at most {4 * LONGEST} characters")
    out["damage"] = checked_damage(out["damage"])
    notes = out["assumption"]
    if not isinstance(notes, list) or not all(isinstance(note, dict) and set(note) <= NOTE for note in notes):
        raise ValueError(f"assumption = {shown(notes)}: expected a list of tables with {', '.join(sorted(NOTE))}")
    return out


def _value(field, value):
    if value is None:
        raise ValueError(f"{field.label}: the field is empty; enter a {'whole ' * field.whole}number")
    stated = f"{field.label} ({field.name}) = {shown(value)}{field.unit and ' ' + field.unit}"
    if field.choices:
        if value not in field.choices:
            raise ValueError(f"{stated}, but it must be one of {', '.join(field.choices)}")
        return value
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or not abs(value) < math.inf or (field.whole and value != int(value)):
        raise ValueError(f"{stated}: expected a {'whole' if field.whole else 'finite'} number")
    if not field.low <= value <= field.high:
        raise ValueError(
            f"{stated}, but this page accepts {field.low:g} to {field.high:g}: for other values use gearfe in Python"
        )
    return int(value) if field.whole else float(value)
