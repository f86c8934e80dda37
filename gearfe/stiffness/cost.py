"""Expected computing time and memory of a stiffness curve, before anything is solved.

The numbers of `COSTS` are measured on one thread of a processor of 2.5 GHz, on steel gears of 23 to 90 teeth, 10 to 30 modules
wide, at `refine` from 0.3 to 50. Times scatter by a factor of two.
"""

from typing import NamedTuple

import numpy as np

from ..core.cost import Cost, check_cost
from ..flexibility.energy.ritz.depth import axial_degree
from .limits import SECTION

REMEDY = "give a smaller refine, or fewer phases"
SECTION_TIME = 0.92, 1.2  # time of sections of finite elements of 60 teeth, whose bores are half as wide as they [s]; its power


class _Row(NamedTuple):
    """Times [s] of a gear by powers of `refine`, of a curve and of a phase; memory [bytes] by ``refine**2``; factors.

    `damaged` is the time of the sectors of a damaged gear relative to a healthy gear, `error` that of the error estimate
    relative to the curve.
    """

    gear: tuple[float, float, float]
    curve: float
    phase: float
    memory: float
    damaged: float
    error: float


COSTS = {
    "ritz": _Row((0.02, 0.0, 0.0022), 0.01, 2e-4, 2.2e5, 2.0, 1.7),
    "ritz3d": _Row((0.1, 0.33, 0.07), 0.8, 5e-3, 2.5e6, 2.0, 0.7),
    "fe": _Row((0.0, 0.0, 0.0), 0.05, 2e-4, 0.0, 1.0, 0.65),
    "fe3d": _Row((15.0, 0.0, 0.0), 0.8, 5e-3, 0.0, 1.0, 1.0),  # Its solver estimates each gear more closely by its unknowns.
}
SUM = 1e-2  # time of a curve by a closed form [s]


def curve_cost(case, how, name, phases: int = 64) -> Cost:
    """Return the expected `Cost` of the stiffness curve of a `Case` by the method `name` with the options of a `Solve`."""
    if name not in COSTS:
        return Cost(SUM, 0.0)
    row = COSTS[name]
    gears = 2 + row.damaged * sum(any((*case.cracks[i], *case.broken[i])) for i in (0, 1))
    seconds = contact_seconds(name, phases * len(case.forces)) + gears * gear_seconds(case, how.refine, name)
    return Cost(seconds * (1 + row.error * how.error), row.memory * (how.refine * _degrees(case, name)) ** 2)


def contact_seconds(name, phases: int = 64) -> float:
    """Return the expected time of the contact of a curve with solved gears [s]."""
    return COSTS[name].curve + COSTS[name].phase * phases


def gear_seconds(case, refine: float, name: str) -> float:
    """Return the expected time of one healthy gear of a pair by the method `name` [s]; the mean of both."""
    if name == "fe":
        unknowns, usual = (sum(factor * fine**power for power, factor in enumerate(SECTION)) for fine in (refine, 1.0))
        teeth = sum(gear.z * max(1.0, 0.5 * gear.r_f / gear.held) ** 0.9 for gear in case.pair.gears)
        return SECTION_TIME[0] / 2 * (unknowns / usual * teeth / 60) ** SECTION_TIME[1]
    row = COSTS[name]
    return sum(time * refine**power for power, time in enumerate(row.gear)) * _degrees(case, name) ** 1.6


def _degrees(case, name):
    """Axial degree of the energy model in three dimensions relative to that of a gear 10 modules wide; 1 for sections."""
    if name != "ritz3d":
        return 1.0
    gears = case.pair.gears
    width = (min(gear.b for gear in gears) - case.groove) / (2 if case.runs == "herringbone" else 1)
    return axial_degree(width, gears[0].m_n) / axial_degree(10.0, 1.0)


def announce(case, how, row) -> None:
    """Reject a curve above the limits of time and memory, and announce a slow one to ``how.tell``, by default as a warning.

    Finite elements of whole gears are left to their solver, which knows the number of unknowns.

    Raises
    ------
    ValueError
        If the expected time or memory exceeds the limit; the message has the numbers.

    Warns
    -----
    UserWarning
        If the expected time is above `gearfe.core.cost.SLOW` and there is no ``how.tell``.
    """
    if row.brute:
        return
    phases = how.phases if isinstance(how.phases, int) else np.size(how.phases)
    cost = curve_cost(case, how, row.name, phases)
    check_cost(f"refine = {how.refine:g}: a curve by {row.name}", cost, REMEDY, how.tell)
