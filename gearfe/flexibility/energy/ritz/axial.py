"""Functions along the width of a gear: polynomials over the whole width, and over the part where a crack is open.

Over the whole width the functions are orthonormal Legendre polynomials, whose mass matrix is the identity. The faces of a crack
that is open between two heights separate only there, by polynomials over that part. These vanish at its ends, except at an end
face of the gear. Where the crack ends inside the gear, the field changes over a short distance. All nodes near the crack and
its faces therefore also have short cubic functions around that height.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import block_diag

from ...halfspace import modes

PUSHING = 6  # highest degree of forces between crack faces over the whole width, which every node has (`depth.degrees`)
OPEN = 6, 1.6  # degree of the opening over a part of the width: minimum, and increase per normal module
# Reach of the short cubics about the end of a crack [m_n], and length of the shortest one over that reach. They were set by
# comparison with hexahedra of one gear, 12 mm wide and cracked over half of the width. They were checked only with finer
# layers and with a width of 8 mm of this gear.
ENDS = 1.0, 0.2
MOVED = 3  # number of polynomials in z that multiply the crack depth
FRONT = 8  # additional Gauss points where the section varies along the crack front


@dataclass(frozen=True, slots=True)
class Axial:
    """Functions along the width, and sets of them.

    - `mass`, `mixed` and `slope` ``(n, n)`` are integrals of f f', f df' and df df'.
    - `sets` are index arrays. The first is the modes over the whole width. Then follow, for each crack, the modes of its
      opening, those of the forces that push its faces apart, those of the nodes near it, and those that move with its front.
      The last sets are the modes up to degree 0, 1, ... .
    - `points` are, for each crack, the heights [mm] at which its faces may touch. `at` are the values of the functions of the
      force there (points, functions).
    - `z` and `weight` [mm] (q,) integrate over the width. `value` and `rise` (q, n) are the functions and their slopes at `z`.
    """

    mass: np.ndarray
    mixed: np.ndarray
    slope: np.ndarray
    sets: tuple
    points: tuple
    at: tuple
    z: np.ndarray
    weight: np.ndarray
    value: np.ndarray
    rise: np.ndarray


def axial(width, degree, parts=(), m_n=1.0, fronts=()):
    """Return the `Axial` of a gear.

    Parameters
    ----------
    width, degree
        Of the gear [mm], and of the polynomials over all of it.
    parts : tuple of (None or tuple of (float, float))
        Of each crack: None if it is open over the whole width, or the parts of the width where it is, apart from each other [mm].
    m_n : float
        Normal module [mm]; the degree of the openings follows from it.
    fronts : sequence of None or Front
        Of each crack, if its depth changes along the width: nodes near it have its depth as a function too.
    """
    fronts = tuple(fronts) or (None,) * len(parts)
    bands = sorted({band for where in filter(None, parts) for band in where})
    degrees = {band: max(OPEN[0], math.ceil(OPEN[1] * (band[1] - band[0]) / m_n) + 2) for band in bands}
    fine = _fine(bands, width, m_n, parts, fronts)
    kinks = [z for front in filter(None, fronts) for z in front.kinks()]
    ends = np.unique([0.0, width, *kinks, *np.ravel(bands), *np.concatenate([*fine.values(), []])])
    z, weight = _gauss(ends, width, max([degree, *degrees.values()]) + 1 + (FRONT if kinks else 0))
    columns = _Columns()
    every = columns.add(*_whole(z, width, degree))
    by_band = _over_bands(columns, every, degrees, fine, z, width)
    sets, touch = [every], []
    for front, where in zip(fronts, parts, strict=True):
        there = where or (None,)
        moved = every[:0]
        if front and front.sharp:
            moved = columns.add(*_depth(z, weight, front, columns.value[0], columns.rise[0]))
        open_, push, near = (np.concatenate([kind[band] for band in there]) for kind in by_band)
        sets += [open_, push, np.concatenate([every, near, moved]), np.append(every, moved)]
        touch.append(_points(where or ((0.0, width),), [degrees.get(band, min(degree, PUSHING)) for band in there]))
    points, at = zip(*touch, strict=True) if touch else ((), ())
    sets += [every[: k + 1] for k in range(degree + 1)]
    value, rise = np.hstack(columns.value), np.hstack(columns.rise)
    mass = value.T @ (weight * value)
    mass[: degree + 1, : degree + 1] = np.eye(degree + 1)
    mixed, slope = value.T @ (weight * rise), rise.T @ (weight * rise)
    return Axial(mass, mixed, slope, tuple(sets), points, at, z, weight[:, 0], value, rise)


class _Columns:
    """Functions and their derivatives at the Gauss points, collected block by block."""

    def __init__(self):
        self.value, self.rise, self.count = [], [], 0

    def add(self, value, rise):
        """Add functions ``(points, n)`` and return their numbers ``(n,)``."""
        self.value.append(value)
        self.rise.append(rise)
        self.count += value.shape[1]
        return np.arange(self.count - value.shape[1], self.count)


def _over_bands(columns, every, degrees, fine, z, width):
    """Return the indices of axial functions by band: for crack openings, for forces on crack faces, and the short cubics."""
    opening, pushing, short = {None: every}, {None: every[: PUSHING + 1]}, {None: every[:0]}
    for band, order in degrees.items():
        opening[band], short[band] = columns.add(*_open(z, band, order, width)), every[:0]
        pushing[band] = columns.add(*_pushing(z, band, order))
    for (band, k), places in fine.items():
        made, inside = _short(z, places, band[k], 1 - 2 * k)
        numbers = columns.add(*made)
        short[band], opening[band] = np.append(short[band], numbers), np.append(opening[band], numbers[inside])
    return opening, pushing, short


def _fine(bands, width, m_n, parts, fronts):
    """Return the knots of the short cubics, by band and by its end inside the gear (0 or 1)."""
    shallow = {
        end for front, where in zip(fronts, parts, strict=True) if front for end in np.ravel(where or ()) if front.runs_out(end)
    }
    ends = [(band, k) for band in bands for k in (0, 1) if 1e-9 * width < band[k] < width * (1 - 1e-9)]
    return {(band, k): _steps(band, k, width, m_n, band[k] in shallow) for band, k in ends}


def _gauss(ends, width, count):
    """Gauss points ``(q,)`` [mm] and weights ``(q, 1)``, `count` of them between every two of the sorted `ends`."""
    ends = ends[np.append(True, np.diff(ends) > 1e-12 * width)]
    gauss, weight = legendre.leggauss(count)
    half = np.diff(ends)[:, None] / 2
    return (ends[:-1, None] + half * (1 + gauss)).ravel(), (half * weight).ravel()[:, None]


def _whole(z, width, degree):
    """Orthonormal Legendre polynomials over the width, and their slopes ``(n, degree + 1)``."""
    value = modes(z, width, degree)
    scale = np.sqrt((2 * np.arange(degree + 1) + 1) / width) * 2 / width
    local = 2 * z / width - 1
    rise = legendre.legvander(local, degree)[:, :degree] @ legendre.legder(np.eye(degree + 1)) if degree else 0 * value
    return value, rise * scale


def _open(z, band, degree, width):
    """Continuous polynomials over a band and their slopes. They vanish outside, and at ends inside the gear."""
    low, high = band
    length, slack = high - low, 1e-9 * width
    inside = ((z > low) & (z < high))[:, None]
    t = np.clip(2 * (z - low) / length - 1, -1, 1)
    p = legendre.legvander(t, degree)
    k = np.arange(2, degree + 1)
    value = [(p[:, 2:] - p[:, :-2]) / np.sqrt(2 * (2 * k - 1))]
    rise = [np.sqrt((2 * k - 1) / 2) * p[:, 1:-1] * 2 / length]
    for free, sign in ((low <= slack, -1), (high >= width - slack, 1)):
        if free:
            value.append((1 + sign * t)[:, None] / 2)
            rise.append(np.full((z.size, 1), sign / length))
    return np.hstack(value) * inside * math.sqrt(2 / length), np.hstack(rise) * inside * math.sqrt(2 / length)


def _steps(band, k, width, m_n, shallow):
    """Return the knots [mm] of the short cubics around one end of a band. They are closer together towards the end.

    A narrow ligament beyond the end needs closer knots, unless the crack is `shallow` there.
    """
    end, inwards = band[k], 1 - 2 * k
    # Short cubics of both ends that met would represent a cubic over the whole band, which is already an opening function.
    inside, outside = min(ENDS[0] * m_n, 0.4 * (band[1] - band[0])), min(ENDS[0] * m_n, 0.9 * (width - end if k else end))
    nearest = ENDS[1] * (inside if shallow else min(inside, outside))
    steps = [side * _graded(min(nearest, reach), reach) for side, reach in ((inwards, inside), (-inwards, outside))]
    return np.unique(end + np.concatenate([[0.0], *steps]))


def _graded(nearest, reach):
    """Distances from `nearest` to `reach` [mm], each at most 1 / `ENDS[1]` times the previous one."""
    count = math.ceil(math.log(reach / nearest) / -math.log(ENDS[1]) - 1e-9)
    if count < 1:
        return np.array([reach])
    return nearest * (reach / nearest) ** (np.arange(count + 1) / count)


def _short(z, places, end, inwards):
    """Return cubics with knots `places` that vanish at both ends, their derivatives, and which vanish outside the crack."""
    value, rise, inside = [], [], []
    for low, middle, high in zip(places[:-2], places[1:-1], places[2:], strict=True):  # hat functions
        up, down = (z > low) & (z <= middle), (z > middle) & (z < high)
        value.append(np.where(up, (z - low) / (middle - low), np.where(down, (high - z) / (high - middle), 0.0)))
        rise.append(np.where(up, 1 / (middle - low), np.where(down, -1 / (high - middle), 0.0)))
        inside.append(inwards * (middle - end) > 0)
    for low, high in zip(places[:-1], places[1:], strict=True):
        there, t = (z > low) & (z < high), 2 * (z - low) / (high - low) - 1
        value += [np.where(there, 1 - t**2, 0.0), np.where(there, t * (1 - t**2), 0.0)]
        rise += [np.where(there, slope * 2 / (high - low), 0.0) for slope in (-2 * t, 1 - 3 * t**2)]
        inside += [inwards * ((low + high) / 2 - end) > 0] * 2
    return (np.column_stack(value), np.column_stack(rise)), np.array(inside)


def _depth(z, weight, front, whole, rise):
    """Return the crack depth f(z) times the first `MOVED` polynomials, and their derivatives ``(n, k)``.

    At points that move with the front by f(z), a smooth field varies like ``a(z) + f(z) b(z)``. The part that the polynomials
    already represent is subtracted.
    """
    value, slope = front.depth(z)
    few, steep = whole[:, :MOVED], rise[:, :MOVED]
    value, slope = value[:, None] * few, slope[:, None] * few + value[:, None] * steep
    carried = whole.T @ (weight * value)
    value, slope = value - whole @ carried, slope - rise @ carried
    size, turn = np.linalg.eigh(value.T @ (weight * value))
    kept = size > 1e-12  # All functions are scaled to about 1.
    turn = turn[:, kept] / np.sqrt(size[kept])
    return value @ turn, slope @ turn


def _pushing(z, band, degree):
    """Return orthonormal polynomials over a band for the forces on crack faces. They are zero outside."""
    low, high = band
    value = modes(z - low, high - low, degree) * ((z > low) & (z < high))[:, None]
    return value, 0 * value


def _points(bands, degrees):
    """Gauss points of the bands [mm], and the values there of the forces' polynomials, band by band."""
    places, blocks = [], []
    for (low, high), degree in zip(bands, degrees, strict=True):
        z = (high - low) * (1 + legendre.leggauss(degree + 1)[0]) / 2
        places.append(low + z)
        blocks.append(modes(z, high - low, degree))
    return np.concatenate(places), block_diag(*blocks)
