"""Variable speed: the speed profile of a run-up, and the angle of rotation at any time."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ...core.record import settle
from ...geometry.aliases import Floats
from .loads import rising


@dataclass(frozen=True, slots=True)
class Speed:
    """Speed of all shafts relative to the nominal speed of a machine, linear between `times`.

    It is constant before the first and after the last time. Mesh phases, damaged teeth, errors and the carrier depend on the
    angle of the gears. They are evaluated at the *turned* time, the integral of the relative speed.

    Parameters
    ----------
    times : sequence of float
        Rising [s].
    factors : sequence of float
        Speed over the nominal one, 0 or more.

    Attributes
    ----------
    knots : ndarray, shape (n, 3)
        Time [s], factor and turned time [s]; turned time and time are 0 together.

    Examples
    --------
    From standstill to full speed in two seconds half of the turns are made:

    >>> run_up = Speed((0.0, 2.0), (0.0, 1.0))
    >>> float(run_up.turned(2.0)), float(run_up.turned(3.0)), float(run_up(1.0))
    (1.0, 2.0, 0.5)
    """

    times: Sequence[float]
    factors: Sequence[float]
    knots: Floats = field(init=False)

    def __post_init__(self) -> None:
        """Integrate the speed. Raise ValueError if times do not rise, or factors are negative or all zero."""
        times, factors = rising("speed", self.times, self.factors, strict=True)
        if not ((factors >= 0).all() and factors.any()):
            raise ValueError("speed: the factors must be 0 or more and one of them above 0")
        turned = np.concatenate([[0.0], np.cumsum(np.diff(times) * (factors[1:] + factors[:-1]) / 2)])
        settle(self, knots=np.stack([times, factors, turned], axis=1))
        self.knots[:, 2] -= float(self.turned(0.0))

    def __call__(self, t: ArrayLike) -> Floats:
        """Return the speed factor at times `t`."""
        return np.interp(np.asarray(t, dtype=float), self.knots[:, 0], self.knots[:, 1])

    def turned(self, t: ArrayLike) -> Floats:
        """Return the time in which the gears rotate at nominal speed by the same angle as in the time `t` [s]."""
        return turned(self.knots, np.asarray(t, dtype=float))

    @property
    def fastest(self) -> float:
        """Return the largest speed factor."""
        return float(self.knots[:, 1].max())


def turned(knots, t):
    """Return `Speed.turned`, the exact integral of the piecewise linear speed."""
    place = np.clip(np.searchsorted(knots[:, 0], t, side="right") - 1, 0, len(knots) - 1)
    start, first, angle = (knots[place, i] for i in range(3))
    return angle + (t - start) * (first + np.interp(t, knots[:, 0], knots[:, 1])) / 2
