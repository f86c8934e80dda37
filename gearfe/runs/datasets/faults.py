"""Fault types of a data set, and the key of the scene that states the severity of each."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from ...scene.schema import LISTS, scene_schema

HEALTHY = "healthy"
CASE = "fault"  # name of the damage case in a generated scene


class FaultKind(NamedTuple):
    """Fault type, with the scene key that states its severity, and the unit.

    A key without a name after the point has no severity. Its table has the keys of ``KIND_fault`` in ``gearfe/runs/keys.toml``.
    """

    key: str
    unit: str

    @property
    def damage(self) -> bool:
        """Whether the fault is tooth damage (a case of the scene). Otherwise it is an error of the machine."""
        return not self.key.startswith("machine.")

    def enter(self, tables: dict[str, Any], severity: float, row: Mapping[str, Any]) -> None:
        """Enter the fault of a checked `row` into the tables of a scene."""
        kind, name = self.key.split(".")
        if not self.damage:
            tables[kind][name] = severity
            return
        given = {key: entry for key, entry in row.items() if entry is not None and key not in ("kind", "severity")}
        if name:
            given[name] = [severity] * 2 if scene_schema()[kind].keys[name].type in LISTS else severity
        tables.setdefault(kind, []).append({"case": CASE} | given)


FAULTS = {
    "crack": FaultKind("crack.level", "-"),
    "pits": FaultKind("pits.axes_mm", "mm"),
    "missing_tooth": FaultKind("missing_tooth.", "-"),
    "chip": FaultKind("chip.depth_mm", "mm"),
    "runout": FaultKind("machine.runout_um", "um"),
    "misplaced": FaultKind("machine.misplaced_um", "um"),
}
