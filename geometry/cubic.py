"""Cubic and linear splines of one and of two variables. They load faster than those of scipy, which take 0.45 s."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import solve_banded

from .aliases import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Cubic:
    """Cubic spline through points. Its third derivative is continuous at the second and the last but one (not-a-knot).

    Parameters
    ----------
    x : ndarray, shape (n,)
        Increasing places, 4 or more.
    y : ndarray, shape (n, ...)
        Values there.

    Examples
    --------
    >>> import numpy as np
    >>> x = np.arange(6.0)
    >>> cube = Cubic(x, x**3)
    >>> print(cube(2.5).round(6), cube(2.5, 1).round(6))
    15.625 18.75

    References
    ----------
    C. de Boor, A Practical Guide to Splines, Springer, 1978, ch. IV.
    """

    x: Floats
    y: Floats
    c: Floats = field(init=False)  # coefficients (4, n - 1, ...) of powers 3 to 0 of the distance from the left point

    def __post_init__(self) -> None:
        """Solve for the slopes at the points."""
        y = self.y.reshape(self.x.size, -1)
        h = np.diff(self.x)[:, None]
        rise = np.diff(y, axis=0) / h
        bands, right = np.zeros((3, self.x.size)), np.empty_like(y)
        bands[0, 2:], bands[1, 1:-1], bands[2, :-2] = h[:-1, 0], 2 * (h[:-1, 0] + h[1:, 0]), h[1:, 0]
        right[1:-1] = 3 * (h[1:] * rise[:-1] + h[:-1] * rise[1:])
        for end, here, there in ((0, 0, 1), (-1, -1, -2)):  # the third derivative of the two parts next to each end is the same
            first, second = h[here], h[there]
            bands[1, end], bands[end, there] = second[0], (first + second)[0]
            right[end] = ((3 * first + 2 * second) * second * rise[here] + first**2 * rise[there]) / (first + second)
        slope = solve_banded((1, 1), bands, right)
        bent = (slope[:-1] + slope[1:] - 2 * rise) / h
        parts = np.array([bent / h, (rise - slope[:-1]) / h - bent, slope[:-1], y[:-1]])
        object.__setattr__(self, "c", parts.reshape(4, self.x.size - 1, *self.y.shape[1:]))

    def __call__(self, at: ArrayLike, order: int = 0) -> Floats:
        """Return the values ``(*at.shape, ...)``, or first derivatives with `order` 1. End parts continue beyond the ends."""
        at = np.asarray(at, dtype=float)
        part = self.x[1:-1].searchsorted(at, side="right")
        u = (at - self.x[part]).reshape((*at.shape, *(1,) * (self.y.ndim - 1)))
        a, b, c, d = self.c.take(part, axis=1)  # These are copies, so that they may be overwritten.
        if order:
            return (3 * a * u + 2 * b) * u + c
        a *= u
        a += b
        a *= u
        a += c
        a *= u
        a += d
        return a

    def held(self, at: ArrayLike) -> Floats:
        """Return the values ``(*at.shape, ...)``. Beyond the ends, end values are constant."""
        return self(np.minimum(np.maximum(at, self.x[0]), self.x[-1]))


@dataclass(frozen=True, slots=True, eq=False)
class Bicubic:
    """Cubic spline of two variables: ``first(x) @ values @ second(y)``, constant beyond the ends of each variable.

    Both splines have a column for each base function.
    """

    first: Cubic
    values: Floats
    second: Cubic

    def __call__(self, x: ArrayLike, y: ArrayLike) -> Floats:
        """Return the values ``(m, n)`` on a grid of `x` ``(m,)`` and `y` ``(n,)``."""
        return self.first.held(x) @ self.values @ self.second.held(y).T

    def ev(self, x: ArrayLike, y: ArrayLike) -> Floats:
        """Return the values ``(...)`` at single places `x` and `y` ``(...)``."""
        if self.first is self.second:  # One call is faster than two.
            ahead, back = self.first.held(np.array([x, y]))
        else:
            ahead, back = self.first.held(x), self.second.held(y)
        return (ahead @ self.values * back).sum(axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class Bilinear:
    """Linear interpolation in a table of two variables, constant beyond the ends of each variable.

    Parameters
    ----------
    x, y : ndarray, shape (m,), (n,)
        Increasing places, 2 or more.
    values : ndarray, shape (m, n)

    Examples
    --------
    >>> import numpy as np
    >>> plane = Bilinear(np.array([0.0, 1.0]), np.array([0.0, 2.0]), np.array([[0.0, 2.0], [1.0, 3.0]]))
    >>> print(plane(np.array([0.5, 3.0]), np.array([1.0, 1.0])))
    [1.5 2. ]
    """

    x: Floats
    y: Floats
    values: Floats

    def __call__(self, x: ArrayLike, y: ArrayLike) -> Floats:
        """Return the values ``(...)`` at single places `x` and `y` ``(...)``."""
        (i, u), (j, v) = _within(self.x, x), _within(self.y, y)
        low, high = ((1 - v) * self.values[k, j] + v * self.values[k, j + 1] for k in (i, i + 1))
        return (1 - u) * low + u * high


def _within(places, at):
    """Return the interval between `places` in which `at` lies, and its part (0 to 1) before `at`."""
    at = np.minimum(np.maximum(at, places[0]), places[-1])
    part = np.minimum(np.searchsorted(places, at, side="right") - 1, places.size - 2)
    return part, (at - places[part]) / (places[part + 1] - places[part])


def through(x: Floats) -> Cubic:
    """Return the base functions of splines through points at `x` ``(n,)``: one at one point, zero at the others."""
    return Cubic(x, np.eye(x.size))
