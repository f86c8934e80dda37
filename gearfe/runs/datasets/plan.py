"""Definition of a data set: a strict TOML file, or a dictionary of the same structure.

::

    title = "cracks of the sun"
    scene = "planetary_pitting"          # or a file with a [machine]
    seed = 1
    repeats = 4                          # conditions per combination, with different start, scatter and noise
    healthy = 4                          # healthy conditions per combination of speed and torque; default: repeats

    [window]
    seconds = 0.2
    count = 4                            # one after the other, of each condition and sensor
    rate_Hz = 12800.0
    harmonics = 5                        # mesh harmonics that must lie below half the rate

    [operation]                          # every combination
    speed_rpm = [800.0, 1000.0]
    torque_Nm = [50.0, 100.0]
    spread = 0.01                        # relative half width of the uniform scatter of speed and torque per condition

    [[fault]]                            # kinds and their keys: ``gearfe/runs/keys.toml``
    kind = "crack"
    gear = "sun"
    severity = [0.1, 0.3, 0.5]

    [[sensor]]
    name = "sun"
    channel = "sun.x acceleration"       # of the response; or housing = "planet_ring", at a fixed sensor
    noise = [0.0, 1.0]                   # rms of white noise [unit of the channel], each a copy of every window

    [scatter]                            # parameters that vary between machines, per condition, also healthy ones
    "machine.profile_error_um" = { uniform = [0.2, 1.0] }

    [split]
    train = 0.5
    validation = 0.25
    test = 0.25
    by = "condition"                     # or "operation": sides share no combination of speed and torque
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

from ...dynamics.machine.of_scene import flat_machine
from ...geometry.aliases import StrPath
from ...scene.dotted_keys import check_key, set_values
from ...scene.load import Scene, scene_of
from ...scene.parts import DAMAGE
from ...scene.reading import check_no_scene, checked
from ...scene.study_tables import is_gearbox, tables_near
from ...scene.toml_file import given_tables
from ..sweeps.axes import RUNS
from ..sweeps.samples import check_shape
from .faults import CASE, FAULTS

SIDES = ("train", "validation", "test")
MOST = 1_000_000  # largest number of conditions


@dataclass(frozen=True, slots=True)
class Plan:
    """Checked definition of a data set: tables of its file with defaults, and tables of its scene."""

    title: str
    seed: int
    repeats: int
    healthy: int
    curves: str
    phases: int
    window: dict[str, Any]
    operation: dict[str, Any]
    fault: tuple[dict[str, Any], ...]
    sensor: tuple[dict[str, Any], ...]
    scatter: dict[str, Any]
    split: dict[str, Any]
    scene: str
    tables: dict[str, Any]

    def content(self) -> dict[str, Any]:
        """All values that determine the data, as JSON. Two data sets are equal if these values are equal."""
        return json.loads(json.dumps({name: getattr(self, name) for name in self.__slots__}))

    def scene_at(self, values: Mapping[str, Any], fault: Mapping[str, Any] | None = None, severity: float = 0.0) -> Scene:
        """Return the scene of one condition with its speed, torque, random values by key, and fault.

        The pair forces, at which the stiffness is computed, are scaled with the torque. For a gearbox they follow from the
        torque.
        """
        base = self.tables["machine"]["torque_Nm"]
        tables = set_values(self.tables, values)
        for pair in () if is_gearbox(tables) else tables["pair"].values():
            pair["force_N"] *= tables["machine"]["torque_Nm"] / base
        if fault is not None:
            FAULTS[fault["kind"]].enter(tables, severity, fault)
        return scene_of(f"{self.scene} of {self.title!r}", tables)


def read_plan(given: StrPath | Mapping[str, Any]) -> Plan:
    """Check a definition, and build the scene of every fault once to detect impossible gears and damage.

    Raises
    ------
    ValueError
        Naming file, table and key if anything is unknown, missing or impossible.
    """
    file, place, data = given_tables(given, "data set")
    check_no_scene(file, "data set", data)
    top = checked(RUNS, "dataset", file, "top level", data)
    top["fault"] = tuple(_fault(file, f"fault {i + 1}", entry) for i, entry in enumerate(top["fault"]))
    top["sensor"] = tuple(top["sensor"])
    scene, tables = tables_near(place, top.pop("scene"))
    tables = {kind: entry for kind, entry in tables.items() if kind not in DAMAGE}  # The damage of the scene is not used.
    top["healthy"] = top["repeats"] if top["healthy"] is None else top["healthy"]
    top["curves"] = top["curves"] or ("ritz3d" if any(entry["kind"] == "pits" for entry in top["fault"]) else "auto")
    plan = Plan(**top, scene=scene, tables=tables)
    try:
        _check(plan)
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from error
    return plan


def _fault(file, where, table):
    kind = table.get("kind")
    if kind not in FAULTS:
        raise ValueError(
            f"{file} [{where}] kind = {kind!r}, but it must be one of {', '.join(FAULTS)}; healthy windows are always made"
        )
    return checked(RUNS, f"{kind}_fault", file, where, table)


def _check(plan):
    """Raise ValueError for a plan that contradicts itself or its scene."""
    if "machine" not in plan.tables:
        raise ValueError(f"scene {plan.scene} has no [machine], so that it has no vibration model: add one, or use another scene")
    if not plan.fault:
        raise ValueError("no fault, so that the data set has no damaged class: give at least one [[fault]]")
    names = [sensor["name"] for sensor in plan.sensor]
    if not names or len(set(names)) < len(names):
        raise ValueError(f"[[sensor]] names {names!r}: give at least one sensor, each with a different name")
    _check_split(plan.split)
    _check_scatter(plan)
    _check_scenes(plan)
    if count_of(plan) > MOST:
        raise ValueError(f"{count_of(plan):.3g} conditions: give fewer than {MOST:g}, or several data sets")


def _check_split(split):
    shares = [split[side] for side in SIDES]
    if not math.isclose(sum(shares), 1.0, abs_tol=1e-6):
        stated = ", ".join(f"{side} = {share:g}" for side, share in zip(SIDES, shares, strict=True))
        raise ValueError(f"[split] {stated}: shares add up to 1")


def _check_scatter(plan):
    ours = {"machine.speed_rpm", "machine.torque_Nm"}
    ours |= {FAULTS[fault["kind"]].key for fault in plan.fault if not FAULTS[fault["kind"]].damage}
    for key, spec in plan.scatter.items():
        check_key(key, plan.tables, {})
        if key in ours or (key.startswith("pair.") and key.endswith(".force_N")):
            raise ValueError(f"[scatter] {key!r} is set by the operation or by a fault: leave it out")
        if not isinstance(spec, dict):
            raise ValueError(f"[scatter] {key!r} = {spec!r}: give a distribution, {{ uniform = [low, high] }}")
        check_shape(f"[scatter] {key!r}", spec)


def _check_scenes(plan):
    """Build the scene of every fault at every severity once, to check that its machine is valid."""
    if plan.tables["machine"].get("contact", "linear") != "linear":
        raise ValueError("[machine] contact = 'impact': a data set has linear contact; give a scene with contact = 'linear'")
    plan.scene_at({})
    for fault in plan.fault:
        for severity in fault["severity"]:
            flat_machine(plan.scene_at({}, fault, severity), CASE if FAULTS[fault["kind"]].damage else None)


def combinations(plan: Plan) -> list[tuple[dict[str, Any] | None, float, int]]:
    """Return fault (None: healthy), severity and repeats of each class."""
    faults = [(fault, severity, plan.repeats) for fault in plan.fault for severity in fault["severity"]]
    return [(None, 0.0, plan.healthy), *faults]


def operations(plan: Plan) -> list[tuple[float, float]]:
    """Return speed and torque of each combination."""
    return list(product(plan.operation["speed_rpm"], plan.operation["torque_Nm"]))


def count_of(plan: Plan) -> int:
    """Return the number of conditions."""
    return len(operations(plan)) * sum(repeats for *_, repeats in combinations(plan))
