"""Flow of power through the shafts of a gearbox: speeds and static torques."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

NONE = 1e-9  # smaller powers, relative to the motor's, count as zero


class Link(NamedTuple):
    """Connection of two shafts: the second rotates `ratio` times as fast as the first."""

    name: str
    one: str
    two: str
    ratio: float


def speeds_of(file: str, links: Sequence[Link], shaft: str, speed: float) -> tuple[dict[str, float], tuple[Link, ...]]:
    """Return the speed of each connected shaft, and the links in the order of their distance from the driven shaft.

    ValueError if they close a loop.
    """
    out, left, ordered = {shaft: speed}, list(links), []
    while near := next((link for link in left if link.one in out or link.two in out), None):
        left.remove(near)
        ordered.append(near)
        if near.one in out and near.two in out:
            raise ValueError(
                f"{file} [{near.name}]: it closes a loop of shafts, in which the load sharing depends on stiffness; leave it out"
            )
        if near.one in out:
            out[near.two] = out[near.one] * near.ratio
        else:
            out[near.one] = out[near.two] / near.ratio
    return out, (*ordered, *left)


def torques_of(
    file: str, links: Sequence[Link], ends: dict[str, dict[str, Any]], speeds: dict[str, float], torque: float
) -> dict[str, float]:
    """Return torques [N m] from the torque balance of every shaft. The torque of a link refers to its second shaft.

    A load has its ``torque_Nm``. The one load without it takes the remaining torque. ValueError unless exactly one load has no
    torque and some torque remains.
    """
    place, out = {name: i for i, name in enumerate(speeds)}, {"motor": torque}
    free = [name for name, end in ends.items() if name != "motor" and end["torque_Nm"] is None]
    if len(free) != 1:
        raise ValueError(
            f"{file}: {len(free)} loads without torque_Nm: omit it for exactly one load, which takes the remaining torque"
        )
    for name, end in ends.items():
        if name not in ("motor", *free):
            out[name] = -math.copysign(end["torque_Nm"], speeds[end["shaft"]])
    known = np.zeros(len(place))
    for name, value in out.items():
        known[place[ends[name]["shaft"]]] += value
    matrix = np.zeros((len(place), len(links) + 1))
    for column, link in enumerate(links):
        matrix[place[link.two], column] += 1.0
        matrix[place[link.one], column] -= link.ratio
    matrix[place[ends[free[0]]["shaft"]], -1] = 1.0
    found = np.linalg.solve(matrix, -known).tolist()
    out |= dict(zip((*(link.name for link in links), free[0]), found, strict=True))
    left, power = (out[name] * speeds[ends[name]["shaft"]] for name in (free[0], "motor"))
    if not left < -NONE * power:
        raise ValueError(
            f"{file} [load.{free[0]}]: no torque remains for it; increase [machine] torque_Nm or reduce the other loads"
        )
    return out
