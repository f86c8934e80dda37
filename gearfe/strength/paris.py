"""Paris's law of crack growth, and the number of cycles along a path."""

import math
from dataclasses import dataclass

import numpy as np

from ..core.checks import number
from ..geometry.aliases import Floats

SMOOTH = 40  # number of parts of a step over which cycles are summed


@dataclass(frozen=True, slots=True)
class ParisLaw:
    """Growth of a crack in each cycle, ``da/dN = C dK_eff^m``.

    ``dK_eff = K_max (1 - R)^gamma`` with ``R = max(K_min, 0) / K_max`` (K. Walker, ASTM STP 462 (1970) 1-14): a crack that is
    pressed shut is closed at K = 0. One revolution of the gear is one cycle.

    Parameters
    ----------
    C : float
        [mm / (MPa sqrt(mm))^m].
    m : float
    threshold : float
        Least dK_eff that grows a crack [MPa sqrt(mm)].
    K_Ic : float
        Fracture toughness [MPa sqrt(mm)].
    gamma : float
        Walker's exponent; 1: no effect of the load ratio beyond closure.
    source : str
        Where the constants come from.

    Raises
    ------
    ValueError
        If C or m is not positive, the threshold is negative, K_Ic is not above it, or gamma is not between 0 and 1.
    """

    C: float
    m: float
    threshold: float = 0.0
    K_Ic: float = math.inf
    gamma: float = 1.0
    source: str = ""

    def __post_init__(self) -> None:
        """Check the constants."""
        for name in ("C", "m", "threshold", "K_Ic", "gamma"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
        if not (self.C > 0 and self.m > 0):
            raise ValueError(f"C = {self.C}, m = {self.m}, but both must be positive")
        if not 0 <= self.threshold < self.K_Ic:
            raise ValueError(f"threshold = {self.threshold}, K_Ic = {self.K_Ic} MPa sqrt(mm), but give 0 <= threshold < K_Ic")
        if not 0 <= self.gamma <= 1:
            raise ValueError(f"gamma = {self.gamma}, but it must lie between 0 and 1")

    def range(self, largest: Floats, least: Floats) -> Floats:
        """Return the effective range of K [MPa sqrt(mm)] of cycles between `least` and `largest`."""
        top = np.maximum(largest, 0.0)
        ratio = np.clip(np.maximum(least, 0.0) / np.where(top > 0, top, 1.0), 0.0, 1.0)
        return top * (1 - ratio) ** self.gamma


def cycles_along(law: ParisLaw, length: Floats, largest: Floats, least: Floats) -> Floats:
    """Return the revolutions until each length, with linear K between two steps."""
    out = [0.0]
    for i in range(length.size - 1):
        part = np.linspace(0.0, 1.0, SMOOTH + 1)
        swing = law.range(*(values[i] + part * (values[i + 1] - values[i]) for values in (largest, least)))
        slow = 1 / (law.C * np.maximum(swing, 1e-300) ** law.m)
        out.append(out[-1] + float(np.trapezoid(slow, dx=(length[i + 1] - length[i]) / SMOOTH)))
    return np.array(out)
