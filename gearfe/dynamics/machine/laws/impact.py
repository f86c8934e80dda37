"""The impact function of multibody programs: a power of the depth, and damping that grows with the depth."""

from dataclasses import dataclass, field

import numpy as np

from ....core.record import settle


@dataclass(frozen=True, slots=True)
class Impact:
    """``F = k depth**power + c step(depth / full) rate``.

    Attributes
    ----------
    power : float
    full : float
        Depth from which the full damping acts [m]. 0: at any depth.
    """

    power: float
    full: float = 0.0
    straight: bool = field(default=False, init=False)
    per_full: float = field(init=False)  # reciprocal of `full`, or 0

    def __post_init__(self) -> None:
        """Compute 1 / `full` once, for all steps."""
        settle(self, per_full=1 / self.full if self.full > 0 else 0.0)

    @staticmethod
    def force(depth, rate, k, c, law):
        """Force [N]."""
        u = np.minimum(depth * law.per_full, 1.0)
        return k * depth**law.power + c * (u * u * (3 - 2 * u) + (law.per_full == 0)) * rate

    @staticmethod
    def slopes(depth, rate, k, c, law):
        """Return the derivatives of the force by depth and rate."""
        u = np.minimum(depth * law.per_full, 1.0)
        share, rise = u * u * (3 - 2 * u) + (law.per_full == 0), 6 * u * (1 - u) * law.per_full
        return k * law.power * depth ** (law.power - 1) + c * rise * rate, c * share


@dataclass(frozen=True, slots=True)
class Hertz:
    """`Impact` with the exponent 3/2 of Hertz's theory, evaluated by a square root because a power is ten times slower."""

    full: float = 0.0
    power: float = field(default=1.5, init=False)
    straight: bool = field(default=False, init=False)
    per_full: float = field(init=False)

    def __post_init__(self) -> None:
        """Compute 1 / `full`, as `Impact` does."""
        settle(self, per_full=Impact(self.power, self.full).per_full)

    @staticmethod
    def force(depth, rate, k, c, law):
        """Force [N]."""
        u = np.minimum(depth * law.per_full, 1.0)
        return k * (depth * np.sqrt(depth)) + c * (u * u * (3 - 2 * u) + (law.per_full == 0)) * rate

    @staticmethod
    def slopes(depth, rate, k, c, law):
        """Return the derivatives of the force by depth and rate."""
        return Impact.slopes(depth, rate, k, c, law)
