"""Kinds of fault a data set can hold: a row says how severity is measured and how it enters a scene."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

HEALTHY = "healthy"
CASE = "fault"  # the case of damage that a fault is in its scene


class Fault(NamedTuple):
    """A kind of fault.

    Its table has the keys of ``KIND_fault`` in ``gearfe/runs/keys.toml``; `unit` is that of its severity. `enter` puts it into
    the tables of a scene. `damage`: it is damage of a tooth, a case of the scene, else an error of the machine.
    """

    unit: str
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


FAULTS = {
    "crack": Fault("-", _crack),
    "pits": Fault("mm", _pits),
    "runout": Fault("um", _error("runout_um"), damage=False),
    "misplaced": Fault("um", _error("misplaced_um"), damage=False),
}
