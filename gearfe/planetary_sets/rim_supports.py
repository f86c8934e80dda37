"""Supports of the rim of a ring: an elastic foundation, or pads of some width."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.checks import truth, whole
from ..core.record import settle, settle_numbers
from ..geometry.aliases import Floats
from ..geometry.tooth.gear import Gear

MANY, FURTHEST = 200, 1e4  # largest number of pads; largest angle of the first pad [rad]


@dataclass(frozen=True, slots=True)
class RimBed:
    """Elastic foundation around the whole outer edge of a ring, for example a press fit or a soft sleeve.

    Parameters
    ----------
    radial, tangential : float
        Stress on the edge per displacement [N/mm^3], both finite and > 0.

    Raises
    ------
    ValueError
        If one of them is not.
    """

    radial: float
    tangential: float

    def __post_init__(self) -> None:
        """Raise ValueError for a foundation on which a ring can rotate freely."""
        remedy = "; for a rim that is held give ring = 'held'"
        settle_numbers(self, "rim bed", "radial tangential", " N/mm^3", above=0.0, remedy=remedy)


@dataclass(frozen=True, slots=True)
class RimSupports:
    """Equal, equally spaced pads on the outer edge (rim) of a ring: bolts, lands, pins. Between them the rim is free.

    Parameters
    ----------
    count : int
        Number of pads.
    width : float
        Arc of the rim that each pad holds [mm]. It matters: from 5 to 15 mm the stiffness of the mesh of planet and ring changes
        by a fifth.
    first : float
        Angle from the centre-line of the ring's tooth 0 to the middle of the first pad, clockwise [rad]. Tooth 0 of the ring is
        the one in mesh with planet 1 at position 0, in the newest pair of teeth there.
    radial, tangential : float
        Stiffness of each pad over the whole face width [N/mm]; default: rigid; 0: the pad does not hold in that direction. The
        rim on a pad stays an arc that moves as a whole, without tilting.
    pushes : bool
        Whether the pads are the flanks of lugs or splines, which only push against the torque of the ring and never pull. Needs
        ``radial=0``.

    Raises
    ------
    ValueError
        If a number is out of range, or the pads would not hold the ring.
    """

    count: int
    width: float
    first: float = 0.0
    radial: float = math.inf
    tangential: float = math.inf
    pushes: bool = False

    def __post_init__(self) -> None:
        """Raise ValueError for pads of impossible sizes, and for pads that do not hold the ring."""
        if not 1 <= whole("rim supports: count", self.count) <= MANY:
            raise ValueError(
                f"rim supports: count = {self.count}, but give 1 to {MANY}: a ring needs a support, and more pads "
                "are an elastic bed"
            )
        settle_numbers(self, "rim supports", "width", " mm", above=0.0, remedy=": give the arc of the rim that a pad holds")
        settle_numbers(self, "rim supports", "first", " rad")
        settle_numbers(self, "rim supports", "radial tangential", " N/mm", least=0.0, finite=False)
        if abs(self.first) > FURTHEST:
            raise ValueError(f"rim supports: first = {self.first:g} rad, but give an angle within {FURTHEST:g} rad")
        if not self.tangential > 0:
            raise ValueError("rim supports: tangential = 0 N/mm, but then nothing supports the ring's torque: give more than 0")
        settle(self, pushes=truth("rim supports: pushes", self.pushes))
        if self.pushes and self.radial:
            raise ValueError("rim supports: pads that only push have no radial force: give radial = 0")
        if self.count < (1 if self.radial and math.isinf(self.radial) else 2 if self.radial else 3):
            raise ValueError(f"rim supports: count = {self.count}, but these do not support the ring: give 3 or more")

    @property
    def middles(self) -> Floats:
        """Angles of the pads' middles, clockwise from the ring's tooth 0 [rad]."""
        return self.first + np.linspace(0, 2 * math.pi, self.count, endpoint=False)

    def ends(self, gear: Gear) -> Floats:
        """Angles of both ends of all pads on the rim of a ring [rad]."""
        reach = self.width / (2 * gear.held)
        return np.concatenate([self.middles - reach, self.middles + reach])

    def covers(self, gear: Gear, places: Floats) -> NDArray[np.bool_]:
        """Return which `places` ``(2, n)`` on the rim lie on a pad or on its ends."""
        away = np.arctan2(*places)[:, None] - self.middles + math.pi
        return np.abs(away % (2 * math.pi) - math.pi).min(axis=1) < self.width / (2 * gear.held) + 1e-9


def check_support(support: Any, gear: Gear) -> None:
    """Raise ValueError unless the support is ``"held"``, `RimBed`, or `RimSupports` whose pads fit on the rim of `gear`."""
    if not (isinstance(support, (RimBed, RimSupports)) or (isinstance(support, str) and support == "held")):
        raise ValueError(f"ring = {support!r}, but give 'held', RimBed(...) or RimSupports(...): a ring needs a support")
    rim = 2 * math.pi * gear.held
    if isinstance(support, RimSupports) and support.count * support.width > rim * (1 - 1e-9):
        raise ValueError(
            f"ring: {support.count} pads of {support.width:g} mm are longer than its rim, {rim:.5g} mm: give ring = 'held', or "
            f"less than {rim / support.count:.4g} mm"
        )
