"""Functions of the mesh phase as cubics between equally spaced samples, either monotone or smooth."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...geometry.aliases import Floats

SMOOTH = 5  # minimum number of samples of a period for slopes of fourth order


@dataclass(frozen=True, slots=True)
class PhaseTable:
    """Function of the phase, interpolated by monotone cubics over equal cells without overshoot.

    Attributes
    ----------
    start, width : float
        Phase of the first sample and width of a cell.
    cells : ndarray, shape (n, 4)
        Coefficients of ``1, u, u**2, u**3`` in each cell, u from 0 to 1.
    """

    start: float
    width: float
    cells: Floats

    @property
    def end(self) -> float:
        """Phase at which the last cell ends."""
        return self.start + self.width * len(self.cells)

    def _cubic(self, phase):
        """Return coefficients of the cubics at phases, and positions within their intervals."""
        place = (np.asarray(phase) - self.start) / self.width
        cell = np.minimum(np.maximum(place.astype(np.int64), 0), len(self.cells) - 1)
        return self.cells[cell].T, (place - cell).T

    def __call__(self, phase: ArrayLike) -> NDArray:
        """Return values at phases from `start` to `end`. Outside this range the end cells are extrapolated."""
        (a, b, c, d), u = self._cubic(phase)
        return (a + u * (b + u * (c + u * d))).T

    def slope(self, phase: ArrayLike) -> Floats:
        """Return the derivative by the phase, at phases like those of a call."""
        (_, b, c, d), u = self._cubic(phase)
        return ((b + u * (2 * c + 3 * u * d)) / self.width).T

    @property
    def mean(self) -> float:
        """Mean over the table."""
        return float((self.cells @ (1, 1 / 2, 1 / 3, 1 / 4)).mean())


def table(values: ArrayLike, start: float, width: float, *, periodic: bool) -> PhaseTable:
    """`PhaseTable` through equally spaced `values`.

    With `periodic`, the table ends with the first value (F. N. Fritsch, J. Butland, 1984).
    """
    values = np.asarray(values, dtype=float)
    values = np.append(values, values[0]) if periodic else values
    rise = np.diff(values)
    before, after = (np.roll(rise, 1), rise) if periodic else (rise[:-1], rise[1:])
    product = before * after
    slope = np.where(product > 0, 2 * product / np.where(product > 0, before + after, 1.0), 0.0)
    slope = np.append(slope, slope[0]) if periodic else np.concatenate([[0.0], slope, [0.0]])
    return PhaseTable(start, width, _cubics(values, slope))


def _cubics(values, slope):
    """Return the cells of a `PhaseTable` from values and slopes (per cell) at both ends of each cell."""
    rise, left, right = np.diff(values), slope[:-1], slope[1:]
    return np.stack([values[:-1], left, 3 * rise - 2 * left - right, left + right - 2 * rise], axis=1)


def smooth_table(values: Floats) -> PhaseTable:
    """Return the `PhaseTable` of one cycle through equally spaced `values` (`SMOOTH` or more), with `smooth_slopes`."""
    slope = smooth_slopes(values)
    return PhaseTable(0.0, 1 / values.size, _cubics(np.append(values, values[0]), np.append(slope, slope[0])))


def smooth_slopes(values: Floats) -> Floats:
    """Slopes, per cell, of cubics through equally spaced samples of one period.

    They are the slopes of the quartic through five samples, limited to::

        |slope| <= max(3 |s|, 1.5 |t|)

    Here s is the smaller of the slopes of both cells, and t the smaller slope of the parabolas next to the sample (0 if their
    signs differ). At a step, or where a tooth pair comes into contact, the cubics stay between the samples. A smooth maximum
    may exceed them, as the function does. The cubics are not negative if no sample is.

    Parameters
    ----------
    values : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (n,)

    References
    ----------
    H. T. Huynh, Accurate monotone cubic interpolation, SIAM J. Numer. Anal. 30 (1993) 57-100. Slopes within ``3 value`` keep a
    cubic positive: its Bernstein coefficients are ``value + slope / 3`` and so on.

    Examples
    --------
    A sine of 16 samples, whose slope at 0 is 2 pi / 16 = 0.3927:

    >>> round(float(smooth_slopes(np.sin(2 * np.pi * np.arange(16) / 16))[0]), 4)
    0.3924
    """
    rise = np.roll(values, -1) - values
    before = np.roll(rise, 1)
    bend = rise - before
    half = _smaller(bend, np.roll(bend, -1))  # slope limit of the cell after each sample
    parabola = _smaller(before + np.roll(half, 1) / 2, rise - half / 2)
    quartic = (7 * (before + rise) - np.roll(before, 1) - np.roll(rise, -1)) / 12
    most = np.maximum(3 * np.abs(_smaller(before, rise)), 1.5 * np.abs(parabola))
    slope = _smaller(quartic, np.sign(parabola) * most)
    return np.clip(slope, -3 * values, 3 * values) if values.min() >= 0 else slope


def _smaller(one, two):
    """Return the smaller of two numbers of equal sign, or 0 for different signs (minmod)."""
    return np.where(one * two > 0, np.sign(one) * np.minimum(np.abs(one), np.abs(two)), 0.0)
