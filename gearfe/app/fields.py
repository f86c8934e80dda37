"""The fields of the page: name, unit, bounds, and the place of each in a scene; the browser makes its form from them."""

import json
import math
from dataclasses import asdict, dataclass
from typing import Any

from ..scene.strict import shown

LONGEST = 200  # characters of a title


@dataclass(frozen=True, slots=True)
class Field:
    """One field of the page.

    Attributes
    ----------
    name : str
        In the state and in a link; ``_1`` is the pinion's, ``_2`` the wheel's.
    group, label, unit : str
        Heading it stands under, and what a reader calls it.
    start : object
        Value of the working example.
    places : tuple of str
        Dotted keys of the scene that hold it; none if `gearfe.app.state` writes it by a rule of its own.
    low, high, step : float
        Bounds of what this page solves, and a step of the slider.
    whole : bool
    choices : tuple of str
        Instead of bounds: what it may be.
    when : str
        ``name=value,value``: another field and the values with which this one is shown; empty: always.
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


SIDES, SPELLED = ("pinion", "wheel"), {"1": "pinion", "2": "wheel"}


def _both(name, group, label, unit, starts, place, **more):
    """A field of either gear."""
    return [
        Field(f"{name}_{i}", group, f"{label}, {side}", unit, start, (place.format(side),) if place else (), **more)
        for (i, side), start in zip(SPELLED.items(), starts, strict=True)
    ]


def _relief(end):
    return [
        *_both(f"{end}_relief", "Flanks", f"{end} relief", "µm", (0.0, 0.0), None, high=500, step=1),
        *_both(
            f"{end}_length", "Flanks", f"its length of roll from the {end}", "mm", (1.5, 1.5), None, low=0.01, high=50, step=0.05
        ),
        *_both(f"{end}_exponent", "Flanks", "its power (1 linear, 2 parabolic)", "", (1.0, 1.0), None, low=1, high=4, step=0.5),
    ]


def _gears(key):
    return tuple(f"gear.{side}.{key}" for side in SIDES)


RUNS = ("by the helix angle", "spur", "helical", "herringbone")
CRACKED, PITTED = "crack=length,level", "pits=yes"
FIELDS = (
    *_both("z", "Pair", "teeth", "", (21, 31), "gear.{}.z", low=6, high=160, step=1, whole=True),
    Field("wheel", "Pair", "wheel is", "", "external", choices=("external", "ring")),
    Field("m_n", "Pair", "normal module", "mm", 2.0, _gears("m_n_mm"), 0.2, 30, 0.1),
    Field("alpha_n", "Pair", "pressure angle", "°", 20.0, _gears("alpha_n_deg"), 12, 32, 0.5),
    Field("beta", "Pair", "helix angle", "°", 0.0, ("gear.pinion.beta_deg",), -40, 40, 0.5),
    *_both("x", "Pair", "profile shift", "", (0.0, 0.0), "gear.{}.x", low=-1, high=1.5, step=0.02),
    *_both("b", "Pair", "width", "mm", (20.0, 20.0), "gear.{}.b_mm", low=0.5, high=400, step=0.5),
    *_both("held", "Pair", "radius of bore, or of a ring's rim", "mm", (9.2, 14.2), None, low=0.1, high=3000, step=0.1),
    Field("a", "Pair", "centre distance (0: no backlash)", "mm", 0.0, (), 0, 4000, 0.05),
    Field("face", "Pair", "teeth run", "", "by the helix angle", choices=RUNS),
    Field("groove", "Pair", "relief groove", "mm", 0.0, ("pair.stage.groove_mm",), 0, 200, 0.5, when="face=herringbone"),
    *_both("addendum", "Rack", "addendum", "modules", (1.0, 1.0), "gear.{}.addendum", low=0.3, high=1.6, step=0.01),
    *_both("dedendum", "Rack", "dedendum", "modules", (1.25, 1.25), "gear.{}.dedendum", low=0.5, high=1.8, step=0.01),
    *_both("tip_radius", "Rack", "tip radius of the rack", "modules", (0.38, 0.38), "gear.{}.tip_radius", high=0.6, step=0.01),
    Field("force", "Load", "force along the line of action", "N", 2000.0, ("pair.stage.force_N",), 0.1, 1e6, 10),
    Field("speed", "Load", "speed of the pinion (0: no machine)", "rpm", 0.0, (), 0, 30000, 10),
    Field("drive", "Load", "torque that drives it (0: that of the force)", "N m", 0.0, (), 0, 1e6, 1),
    Field("crack", "Crack", "crack given by", "", "length", choices=("none", "length", "level")),
    Field("crack_gear", "Crack", "cracked gear", "", "pinion", choices=SIDES, when=CRACKED),
    Field("crack_length", "Crack", "length", "mm", 2.0, (), 0.01, 60, 0.05, when="crack=length"),
    Field("crack_level", "Crack", "level (0.5: centre-line)", "", 0.3, (), 0.01, 0.95, 0.01, when="crack=level"),
    Field("crack_angle", "Crack", "angle to the centre-line", "°", 60.0, (), 5, 90, 1, when=CRACKED),
    Field("crack_start", "Crack", "starts at", "", "30deg", choices=("30deg", "60deg", "root", "middle"), when=CRACKED),
    Field("turning", "Crack", "turns at the centre-line", "", "no", choices=("no", "yes"), when="crack=level"),
    Field("part", "Crack", "through the width", "", "all of it", choices=("all of it", "a part"), when=CRACKED),
    Field("part_first", "Crack", "from the height", "mm", 0.0, (), 0, 400, 0.5, when="part=a part"),
    Field("part_last", "Crack", "to the height", "mm", 10.0, (), 0, 400, 0.5, when="part=a part"),
    Field("part_rounded", "Crack", "its front", "", "straight", choices=("straight", "rounded"), when="part=a part"),
    Field("pits", "Pits", "pits", "", "no", choices=("no", "yes")),
    Field("pit_gear", "Pits", "pitted gear", "", "pinion", choices=SIDES, when=PITTED),
    Field("pit_count", "Pits", "pits in a row", "", 5, (), 1, 40, 1, whole=True, when=PITTED),
    Field("pit_radius", "Pits", "radius of the circle they lie on", "mm", 21.0, (), 0.5, 2500, 0.05, when=PITTED),
    Field("pit_first", "Pits", "height of the first centre", "mm", 4.0, (), 0, 400, 0.5, when=PITTED),
    Field("pit_last", "Pits", "height of the last centre", "mm", 16.0, (), 0, 400, 0.5, when=PITTED),
    Field("pit_along", "Pits", "semi-axis along the profile", "mm", 0.5, (), 0.01, 20, 0.05, when=PITTED),
    Field("pit_across", "Pits", "semi-axis along the width", "mm", 1.0, (), 0.01, 200, 0.05, when=PITTED),
    Field("pit_depth", "Pits", "depth", "mm", 0.2, (), 0.001, 10, 0.01, when=PITTED),
    *_relief("tip"),
    *_relief("root"),
    *_both("tip_rounding", "Flanks", "tip rounded by a radius", "mm", (0.0, 0.0), None, high=9, step=0.05),
    *_both("tip_chamfer", "Flanks", "tip chamfered from below it", "mm", (0.0, 0.0), None, high=9, step=0.05),
    *_both("crowning", "Flanks", "profile crowning", "µm", (0.0, 0.0), None, low=-200, high=200, step=0.5),
    *_both("lead", "Flanks", "crowning along the width", "µm", (0.0, 0.0), None, low=-200, high=200, step=0.5),
    Field("F_beta", "Flanks", "misalignment over the width", "µm", 0.0, ("pair.stage.F_beta_um",), -300, 300, 1),
    *_both("radial", "Supports", "radial stiffness (0: rigid)", "N/µm", (0.0, 0.0), None, high=1e5, step=10),
    *_both("tilt", "Supports", "tilting stiffness (0: rigid)", "N m/mrad", (0.0, 0.0), None, high=1e6, step=10),
    *_both("torsion", "Supports", "torsional stiffness (0: rigid)", "N m/mrad", (0.0, 0.0), None, high=1e6, step=10),
    *_both("E", "Material", "Young's modulus", "MPa", (206000.0, 206000.0), "material.{}.E_MPa", low=1000, high=1e6, step=500),
    *_both("nu", "Material", "Poisson's ratio", "", (0.3, 0.3), "material.{}.nu", low=0.05, high=0.48, step=0.01),
)  # fmt: skip
BY_NAME = {one.name: one for one in FIELDS}
TEXTS = {"title": "", "source": "own gear pair"}
NOTE = {"what", "why", "depends", "holds"}  # of an assumption
START = {one.name: one.start for one in FIELDS} | TEXTS | {"assumption": []}


def form() -> str:
    """The table of fields and the state of the working example as JSON, for the browser."""
    return json.dumps({"fields": [asdict(field) for field in FIELDS], "start": START})


def checked_state(given: Any) -> dict[str, Any]:
    """A state of the page with what was left out filled in.

    Values by name of a `Field`, ``title``, ``source`` and ``assumption``, a list of such tables of a scene. ValueError if
    something is unknown, of another kind, or beyond the bounds of its field.
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
    notes = out["assumption"]
    if not isinstance(notes, list) or not all(isinstance(note, dict) and set(note) <= NOTE for note in notes):
        raise ValueError(f"assumption = {shown(notes)}: expected a list of tables with {', '.join(sorted(NOTE))}")
    return out


def _value(field, value):
    stated = f"{field.label} ({field.name}) = {shown(value)}{field.unit and ' ' + field.unit}"
    if field.choices:
        if value not in field.choices:
            raise ValueError(f"{stated}, but it must be one of {', '.join(field.choices)}")
        return value
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or not abs(value) < math.inf or (field.whole and value != int(value)):
        raise ValueError(f"{stated}: expected a {'whole' if field.whole else 'finite'} number")
    if not field.low <= value <= field.high:
        raise ValueError(f"{stated}, but this page takes {field.low:g} to {field.high:g}: for others use gearfe in Python")
    return int(value) if field.whole else float(value)
