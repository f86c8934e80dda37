"""What may hold the rim of a ring: an elastic bed, or pads of some width."""

import math
from dataclasses import dataclass
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.checks import number, truth
from ..geometry.tooth.gear import Gear


@dataclass(frozen=True, slots=True)
class RimBed:
    """An elastic bed around the whole outer edge of a ring, for example a press fit or a soft sleeve.

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
        """Refuse a bed on which a ring turns freely."""
        for name in self.__slots__:
            value = number(f"rim bed: {name}", getattr(self, name))
            if not 0 < value < math.inf:
                raise ValueError(
                    f"rim bed: {name} = {value:g} N/mm^3, but give a stiffness > 0; for a rim that is held give ring = 'held'"
                )
            object.__setattr__(self, name, value)


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
        the one in mesh with planet 0 at position 0, in the newest pair of teeth there.
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
        """Refuse pads of impossible sizes, and pads that do not hold the ring."""
        if isinstance(self.count, bool) or not isinstance(self.count, Integral) or self.count < 1:
            raise ValueError(f"rim supports: count = {self.count!r}, but a ring that nothing holds moves away: give at least 1")
        for name in ("width", "first", "radial", "tangential"):
            object.__setattr__(self, name, number(f"rim supports: {name}", getattr(self, name)))
        if not 0 < self.width < math.inf:
            raise ValueError(f"rim supports: width = {self.width:g} mm, but a pad needs one: give the arc of the rim it holds")
        if not math.isfinite(self.first):
            raise ValueError(f"rim supports: first = {self.first:g} rad, but give a finite angle")
        for name in ("radial", "tangential"):
            if not getattr(self, name) >= 0:
                raise ValueError(f"rim supports: {name} = {getattr(self, name):g} N/mm, but give 0 or more")
        if not self.tangential > 0:
            raise ValueError("rim supports: tangential = 0 N/mm, but then nothing takes the ring's torque: give more than 0")
        object.__setattr__(self, "pushes", truth("rim supports: pushes", self.pushes))
        if self.pushes and self.radial:
            raise ValueError("rim supports: pads that only push have no radial force: give radial = 0")
        if self.count < (1 if self.radial and math.isinf(self.radial) else 2 if self.radial else 3):
            raise ValueError(f"rim supports: count = {self.count}, but so few of these do not hold the ring: give 3 or more")

    @property
    def middles(self) -> NDArray:
        """Angles of the pads' middles, clockwise from the ring's tooth 0 [rad]."""
        return self.first + np.linspace(0, 2 * math.pi, self.count, endpoint=False)

    def ends(self, gear: Gear) -> NDArray:
        """Angles of both ends of all pads on the rim of a ring [rad]."""
        reach = self.width / (2 * gear.held)
        return np.concatenate([self.middles - reach, self.middles + reach])

    def covers(self, gear: Gear, places: NDArray) -> NDArray[np.bool_]:
        """Whether `places` ``(2, n)`` on the rim lie on a pad, its ends included."""
        away = np.arctan2(*places)[:, None] - self.middles + math.pi
        return np.abs(away % (2 * math.pi) - math.pi).min(axis=1) < self.width / (2 * gear.held) + 1e-9


def check_support(support: Any, gear: Gear) -> None:
    """ValueError unless it is ``"held"``, `RimBed` or `RimSupports` whose pads find room on the rim of `gear`."""
    if not (isinstance(support, (RimBed, RimSupports)) or (isinstance(support, str) and support == "held")):
        raise ValueError(
            f"ring = {support!r}, but give 'held', RimBed(...) or RimSupports(...): a ring that nothing holds moves away"
        )
    rim = 2 * math.pi * gear.held
    if isinstance(support, RimSupports) and support.count * support.width > rim * (1 - 1e-9):
        raise ValueError(
            f"ring: {support.count} pads of {support.width:g} mm are longer than its rim, {rim:.5g} mm: give ring = 'held', or "
            f"less than {rim / support.count:.4g} mm"
        )
