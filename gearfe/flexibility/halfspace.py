"""Half-space under patches and lines of load (Boussinesq): the singular part of a loaded flank in three dimensions."""

import math

import numpy as np
from numpy.polynomial import legendre

FAR = 4.0  # distance along the width, in patch lengths, beyond which plain quadrature is used
PIECES = 20  # number of intervals of `graded`


def half_space(material):
    """Coefficient k [mm**2/N]: the surface at distance R from a force F moves along the force by ``k F / R`` (Boussinesq).

    ``k = (1 - nu**2) / (pi E)`` (K. L. Johnson, Contact Mechanics, 1985, eq. 3.22b).
    """
    return (1 - material.nu**2) / (math.pi * material.E)


def modes(z, width, degree):
    """Legendre polynomials ``(n, degree + 1)`` at `z` [mm], orthonormal over ``0 <= z <= width`` [1/sqrt(mm)]."""
    values = legendre.legvander(2 * np.asarray(z, dtype=float) / width - 1, degree)
    return values * np.sqrt((2 * np.arange(degree + 1) + 1) / width)


def fourth_integral(x, c):
    """Fourth antiderivative of ``1 / sqrt(x**2 + c**2)`` over x, c > 0."""
    r = np.hypot(x, c)
    return (x**3 / 6 - c**2 * x / 4) * np.arcsinh(x / c) - 11 / 36 * r**3 + 5 / 12 * c**2 * r


def _masses(knots):
    start, top, stop = knots
    height = 2 / (stop - start)
    return (start, height / (top - start)), (top, -height / (top - start) - height / (stop - top)), (stop, height / (stop - top))


def hat_points(knots, count):
    """Gauss points and weights ``(n, 2 * count)`` of hat functions of unit area on `knots` ``(3, n)``."""
    gauss, weight = legendre.leggauss(count)
    start, top, stop = knots[:, :, None]
    up = (1 + gauss) / 2
    height = 2 / (stop - start)
    points = np.hstack([start + (top - start) * up, stop - (stop - top) * up])
    return points, np.hstack([(top - start) * height * up * weight / 2, (stop - top) * height * up * weight / 2])


def hat_distance(knots, shift, c):
    """Mean of ``1 / R`` over pairs of hat functions of unit area, ``R**2 = (s - s' + shift)**2 + c**2``.

    The second derivative of a hat function is three point masses. The double integral is therefore a sum of nine values of
    `fourth_integral`. If c is large compared with the hat functions, these values would cancel, and Gauss points are used.

    The arguments are `knots` ``(3, n)``, `shift` ``(n, n, t)`` and c > 0 ``(t,)`` [mm]. The result is ``(n, n, t)`` [1/mm].
    """
    out = np.zeros(shift.shape)
    far = c > FAR * (knots[2] - knots[0]).max()
    near = ~far
    for p, mass_p in _masses(knots):
        for q, mass_q in _masses(knots):
            x = (p[:, None] - q)[..., None] + shift[..., near]
            out[..., near] += (mass_p[:, None] * mass_q)[..., None] * fourth_integral(x, c[near])
    points, weight = hat_points(knots, 4)
    apart = points[:, None, :, None] - points[None, :, None, :]
    weights = weight[:, None, :, None] * weight[None, :, None, :]
    for k in np.flatnonzero(far):
        out[..., k] = (weights / np.hypot(apart + shift[..., k, None, None], c[k])).sum(axis=(2, 3))
    return out


def between(ends, count):
    """Gauss points between rising `ends`, `count` in each interval, and their weights."""
    gauss, weight = legendre.leggauss(count)
    half = np.diff(ends)[:, None] / 2
    return ((ends[:-1, None] + ends[1:, None]) / 2 + half * gauss).ravel(), (half * weight).ravel()


def graded(knots, width):
    """Return ends of growing intervals from 0 to `width` [mm], because kernels rise logarithmically towards 0."""
    fine = min((knots[2] - knots[0]).min(), width) * 1e-9
    return np.append(0.0, fine * (width / fine) ** np.linspace(0, 1, PIECES + 1))


def patch_kernel(knots, width, degree, slope=0.0, stretch=1.0):
    """Mean of ``1 / R`` over patches: hat functions across the flank times orthonormal polynomials along the width.

    With t = z - z' the flat distance is ``R**2 = (s - s' - slope t)**2 + (stretch t)**2``: the lines of contact of an involute
    helicoid, which is developable, are the lines ``ds = slope dz``, and `stretch` is their length per width, 1 / cos(beta_b).

    `knots` ``(3, n)`` are start, top and end of the hat functions along the profile arc [mm], `degree` is that of the polynomials
    (`modes`), `slope` ``(n, n)`` or a number, symmetric; the result is ``(n, degree + 1, n, degree + 1)``.
    """
    t, weight = between(graded(knots, width), max(16, degree + 4))
    shift = -np.asarray(slope)[..., None] * t
    out = over_width(
        knots, (shift, stretch * t, weight), (np.zeros(t.size), width - t), lambda z: (z + t[:, None], z), width, degree
    )
    return out.transpose(0, 2, 1, 3) + out.transpose(1, 3, 0, 2)  # For t < 0 both patches are exchanged.


def over_width(knots, apart, span, places, width, degree):
    """Integral ``(n, n, degree + 1, degree + 1)`` of 1 / R over patches, for t distances of their places along the width.

    `apart` are `shift` and c of `hat_distance` and the weights ``(t,)`` of the distances. The first place z runs over `span`
    ``(t,)``, from low to high [mm]; ``places(z)`` are those of both patches.
    """
    (shift, away, weight), (low, high), n = apart, span, knots.shape[1]
    gauss, inner = legendre.leggauss(degree + 1)
    wide = (high - low)[:, None] / 2
    one, two = (modes(z, width, degree) for z in places(low[:, None] + wide * (1 + gauss)))
    overlap = (one * (wide * inner * weight[:, None])[..., None]).mT @ two
    distance = hat_distance(knots, np.broadcast_to(shift, (n, n, away.size)), away).reshape(n * n, -1)
    return (distance @ overlap.reshape(away.size, -1)).reshape(n, n, degree + 1, degree + 1)


def strip(half_width):
    """Distance x [mm] at which a line load acts like a Hertzian strip on its own middle: ``-ln x = ln(2 / a) + 1/2``."""
    return half_width / 2 * math.exp(-0.5)


def pair_kernel(ends, i, j, x, other=None):
    """Mean of ``1 / sqrt((l - l')**2 + (x**2 + x'**2) / 2)`` over pairs ``(i, j)`` of cells of one line ``(n,)`` [1/mm].

    The matrix of all pairs is positive definite whatever the x: a sum over t > 0 of
    ``exp(-t (l - l')**2) exp(-t x**2 / 2) exp(-t x'**2 / 2)``.

    Parameters
    ----------
    ends : (ndarray, ndarray)
        Starts and stops of all cells [mm].
    i, j : ndarray, shape (n,)
        Numbers of the cells.
    x : ndarray
        Of `strip`, of all cells [mm].
    other : (ndarray, ndarray), optional
        Where the cells j begin and end instead, if they are images.
    """
    (start, stop), (low, high) = ends, other or ends
    least = np.sqrt((x[i] ** 2 + x[j] ** 2) / 2)

    def twice(apart):
        return apart * np.arcsinh(apart / least) - np.hypot(apart, least)

    kernel = twice(stop[i] - low[j]) + twice(high[j] - start[i]) - twice(start[i] - low[j]) - twice(stop[i] - high[j])
    return kernel / ((stop[i] - start[i]) * (high[j] - low[j]))


def pair_slope(ends, i, j, x, other=None):
    """Return ``dK / dx_i / x_i`` of `pair_kernel` K for constant other x ``(n,)`` [1/mm**3]. It equals ``dK / dx_j / x_j``."""
    (start, stop), (low, high) = ends, other or ends
    least = np.sqrt((x[i] ** 2 + x[j] ** 2) / 2)
    away = (stop[i] - low[j], high[j] - start[i], start[i] - low[j], stop[i] - high[j])
    stop_low, high_start, start_low, stop_high = (np.hypot(apart, least) for apart in away)
    return (start_low + stop_high - stop_low - high_start) / (2 * least**2) / ((stop[i] - start[i]) * (high[j] - low[j]))
