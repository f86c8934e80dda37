"""`Secant`: secant stiffness of a force law in a table over phase and depth."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...geometry.aliases import Floats

TINY = 1e-30  # deflection of a mesh that just touches [m]


@dataclass(frozen=True, slots=True)
class Secant:
    """Secant stiffness, force over depth, in a table over phase and depth.

    It is linear between columns. Over the rows it is the quadratic B-spline with the rows as control points, so that it has no
    kinks over the phase. The difference from the rows is at most an eighth of their second difference.

    Attributes
    ----------
    start, width : float
        Phase of the first row and distance of the rows.
    deepest : float
        Depth of the last column [m]; column j of n + 1 is at ``deepest (j / n)**2``, so that columns are closer at light loads.
    k : ndarray, shape (rows, columns)
        Secant stiffness [N/m]. Beyond the last column the force continues with its slope.
    """

    start: float
    width: float
    deepest: float
    k: Floats

    @property
    def end(self) -> float:
        """Phase of the last row."""
        return self.start + self.width * (len(self.k) - 1)

    def __call__(self, phase: ArrayLike, depth: ArrayLike) -> tuple[Floats, Floats]:
        """Secant stiffness [N/m] at phases from `start` to `end` and depths [m], and its derivative by the depth [N/m2]."""
        row = np.clip((np.asarray(phase, dtype=float) - self.start) / self.width, 0.0, len(self.k) - 1)
        last, deep = self.k.shape[1] - 1, np.maximum(np.asarray(depth, dtype=float), 0.0)
        at = last * np.sqrt(deep / self.deepest)
        i = np.clip((row + 0.5).astype(np.int64), 1, len(self.k) - 2)
        j, u = np.minimum(at.astype(np.int64), last - 1), row + 0.5 - i
        weights = (1 - u) ** 2 / 2, 0.5 + u * (1 - u), u**2 / 2
        left, right = (
            sum(weight * self.k[i + near, column] for near, weight in zip((-1, 0, 1), weights, strict=True))
            for column in (j, j + 1)
        )
        before = (1 - 1 / last) ** 2  # deflection of the second last column over that of the last column
        slope = (right - left * before) / (1 - before)
        far, beyond = np.maximum(deep, self.deepest), at > last
        outside = slope + (right - slope) * self.deepest / far
        rise = np.where(beyond, (slope - right) * self.deepest / far**2, (right - left) * at / (2 * np.maximum(deep, TINY)))
        return np.where(beyond, outside, left + (at - j) * (right - left)), rise

    @property
    def mean(self) -> "Secant":
        """Mean over the rows of one cycle: average secant stiffness of the mesh at each depth."""
        return Secant(-1.0, 1.0, self.deepest, np.tile(self.k[1:-2].mean(axis=0), (3, 1)))

    @property
    def depths(self) -> Floats:
        """Depth of each column [m]."""
        return self.deepest * np.linspace(0.0, 1.0, self.k.shape[1]) ** 2

    def less(self, healthy: "Secant", others: Iterable[tuple[float, float, "Secant"]] = ()) -> "Secant":
        """Return the difference of this law from a `healthy` cycle, padded by two rows of zeros at each end.

        `others` are changes that it contains as well: the cycles after which each recurs, the position of its phase 0, and its
        table.
        """
        phase = self.start + self.width * np.arange(len(self.k))
        change = self.k - healthy((phase % 1.0)[:, None], self.depths)[0]
        for z, first, other in others:
            at = (phase - first - other.start) % z + other.start
            change = change - np.where((at < other.end)[:, None], other(at[:, None], self.depths)[0], 0.0)
        none = np.zeros((2, self.k.shape[1]))
        return Secant(self.start - 2 * self.width, self.width, self.deepest, np.concatenate([none, change, none]))
