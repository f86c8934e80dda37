"""Kinds of fault a data set can hold: a row says how severity is measured and how it enters a scene."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ...scene.strict import NUMBER, REQUIRED, TEXT, WHOLE

HEALTHY = "healthy"
CASE = "fault"  # the case of damage that a fault is in its scene


class Fault(NamedTuple):
    """A kind of fault.

    `severity` says what its number is, in `unit`, and `bounds` between what; `keys` are further keys of its table. `enter` puts
    it into the tables of a scene. `damage`: it is damage of a tooth, a case of the scene, else an error of the machine.
    """

    severity: str
    unit: str
    bounds: tuple[float, float]
    keys: dict[str, Any]
    enter: Callable[[dict[str, Any], float, Mapping[str, Any]], None]
    damage: bool = True


def _crack(tables, severity, keys):
    row = {"case": CASE, "gear": keys["gear"], "level": severity, "angle_deg": keys["angle_deg"], "start": keys["start"]}
    tables.setdefault("crack", []).append(row)


def _pits(tables, severity, keys):
    names = ("gear", "count", "radius_mm", "first_mm", "last_mm", "depth_mm")
    row = {"case": CASE, "axes_mm": [severity, severity]} | {name: keys[name] for name in names if keys[name] is not None}
    tables.setdefault("pits", []).append(row)


def _error(key):
    def enter(tables, severity, keys):
        tables["machine"][key] = severity

    return enter


GEAR = {"gear": (TEXT, REQUIRED)}
ROW = {"radius_mm": (NUMBER, REQUIRED), "count": (WHOLE, 1), "first_mm": (NUMBER, REQUIRED), "last_mm": (NUMBER, None)}
FAULTS = {
    "crack": Fault(
        "level of a root crack through the whole width of one tooth; 0.5 reaches the tooth's centre-line", "-", (0.01, 0.9),
        GEAR | {"angle_deg": (NUMBER, 45.0), "start": (TEXT, "30deg")}, _crack,
    ),
    "pits": Fault(
        "radius of the pits in a row across one tooth's flank", "mm", (0.05, 10.0),
        GEAR | ROW | {"depth_mm": (NUMBER, 0.2)}, _pits,
    ),
    "runout": Fault("eccentricity of the driving gear", "um", (0.1, 1000.0), {}, _error("runout_um"), damage=False),
    "misplaced": Fault("shift of planet 1, or of the wheel", "um", (0.1, 1000.0), {}, _error("misplaced_um"), damage=False),
}  # fmt: skip
