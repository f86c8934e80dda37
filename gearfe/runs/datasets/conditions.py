"""Conditions of a data set, and the part of the split of each. A condition is one simulation of one machine.

Windows of one condition are more alike than windows of two machines of the same kind. If some of them were in the training part
and others in the test part, a classifier could recognise the machine instead of the fault. All windows, sensors and noise
levels of a condition are therefore in the same part.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...geometry.aliases import Floats
from ..sweeps.samples import quantiles
from .faults import HEALTHY
from .plan import SIDES, Plan, combinations, operations


@dataclass(frozen=True, slots=True)
class Condition:
    """One simulation: number, class, drawn operating condition, scattered values by key, and side of the split.

    `nominal` is the number of its combination of speed and torque, `fault` the number of its fault in the plan (None: healthy),
    `start` a number from 0 to 1 that sets the begin of the record.
    """

    number: int
    label: str
    fault: int | None
    severity: float
    nominal: int
    speed: float
    torque: float
    scatter: dict[str, Any]
    start: float
    side: str

    @property
    def name(self) -> str:
        """Name of its file."""
        return f"condition-{self.number:06d}"

    @property
    def values(self) -> dict[str, Any]:
        """Values that the condition sets in the scene, by key."""
        return self.scatter | {"machine.speed_rpm": self.speed, "machine.torque_Nm": self.torque}


def conditions(plan: Plan) -> list[Condition]:
    """Return all conditions (simulated machines) of a plan, which depend on its seed only.

    ValueError if there are too few for the parts of the split.
    """
    out, points = [], operations(plan)
    rows = [
        (fault, severity, nominal)
        for fault, severity, repeats in combinations(plan)
        for nominal in range(len(points))
        for _ in range(repeats)
    ]
    sides = _sides(plan, rows)
    for number, (fault, severity, nominal) in enumerate(rows):
        drawn = np.random.default_rng([plan.seed, number]).random(3 + len(plan.scatter))
        factors = 1 + plan.operation["spread"] * (2 * drawn[:2] - 1)
        speed, torque = (np.array(points[nominal]) * factors).tolist()
        values = {key: quantiles(spec, drawn[3 + j : 4 + j])[0] for j, (key, spec) in enumerate(plan.scatter.items())}
        label = HEALTHY if fault is None else fault["kind"]
        at = None if fault is None else plan.fault.index(fault)
        out.append(Condition(number, label, at, severity, nominal, speed, torque, values, float(drawn[2]), sides[number]))
    return out


def _sides(plan, rows):
    """Return the side of the split of each condition, assigned by shares within classes or to whole operating conditions."""
    shares = np.array([plan.split[side] for side in SIDES])
    rng = np.random.default_rng([plan.seed, 7])
    if plan.split["by"] == "operation":
        count = len(operations(plan))
        of = _dealt(count, shares, rng, f"{count} combinations of speed and torque")
        return [SIDES[of[nominal]] for *_, nominal in rows]
    out = np.zeros(len(rows), dtype=int)
    keys = [(None if fault is None else plan.fault.index(fault), severity) for fault, severity, _ in rows]
    for key in dict.fromkeys(keys):
        members = [i for i, other in enumerate(keys) if other == key]
        class_name = HEALTHY if key[0] is None else f"{plan.fault[key[0]]['kind']} {key[1]:g}"
        out[members] = _dealt(len(members), shares, rng, f"{len(members)} conditions of {class_name}")
    return [SIDES[i] for i in out]


def _dealt(count: int, shares: Floats, rng: np.random.Generator, told: str) -> NDArray[np.int64]:
    """Return random side numbers of `count` conditions. Shares are rounded, and each side with a share gets at least one."""
    has_share = shares > 0
    if count < has_share.sum():
        raise ValueError(
            f"[split] {told} for {has_share.sum()} parts of the split: give more repeats or operations, or fewer parts"
        )
    sizes = np.where(has_share, np.maximum(np.floor(shares * count), 1), 0).astype(int)
    while sizes.sum() > count:
        sizes[np.argmax(sizes)] -= 1
    for i in np.argsort(sizes - shares * count)[: count - sizes.sum()]:
        sizes[i] += 1
    return rng.permutation(np.repeat(np.arange(shares.size), sizes))
