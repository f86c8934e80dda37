"""The energy model in three dimensions: helical and spur gears of any width, both end faces free.

Curved triangles in the section times polynomials along the width (`panel3d`), all sectors joined exactly as in `ritz`. Loads are
patches on the flank; what a patch does to itself like a half-space is taken out (`halfspace`), the rest is smooth.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from numbers import Integral

import numpy as np
from numpy.polynomial import chebyshev

from geometry.gear import Gear
from geometry.sector import sector
from geometry.tooth import arc_at, roll_at_arc

from ..hertz import half_plane, hat_logarithm
from . import ritz
from .halfspace import half_space, hat_points, modes, patch_kernel
from .panel3d import panel3d

PLACES = 8  # hats on each flank
HAT = 0.4  # half their width [m_n]
OFFSET = 0.2  # in the logarithm of the distance to the tip corner [m_n]
LOST = 2  # axial modes too poor to be kept
# edge lengths in modules, see `geometry.sector.SIZES`
SIZES = {
    "flank": 0.28,
    "back": 0.7,
    "corner": 0.02,
    "kink": 0.2,
    "fillet": 0.4,
    "root": 1.0,
    "side": 0.7,
    "crack": 0.5,
    "crack tip": 0.01,
}


@dataclass(frozen=True, slots=True)
class Flexibility3D:
    """Flexibility of one gear between loads anywhere on its loaded flanks, the half-space's part on the same flank left out.

    A load is a force per width P(z) [N/mm], at right angles to the flank, on a line s(z) of it. The displacement against it is

        u(z) = int P(z)' [bulk(s, z, s', z') + k / R] dz',    bulk = sum of p_a(z) c_i(s) B_ia,jb c_j(s') p_b(z')

    with orthonormal Legendre polynomials p over the width, polynomials c through the hats, and R the flat distance.

    Attributes
    ----------
    gear : Gear
        Its `beta` says how the section turns.
    width : float
        [mm].
    degree : int
        Highest axial mode kept.
    kernel : float
        k of the half-space [mm**2/N].
    near : dict of int to ndarray, shape (n, n)
        B of each solved tooth, ``n = PLACES * (degree + 1)``, modes innermost [mm/N mm].
    far : dict of (int, int) to ndarray, shape (n, n)
        B between two teeth, nothing taken out; the second is further to the loaded side.
    unknowns : int
    healthy : Flexibility3D or None
        Of the gear without damage, for teeth that were not solved; a healthy gear has only tooth 0 solved.
    """

    gear: Gear
    width: float
    degree: int
    kernel: float
    near: dict
    far: dict
    unknowns: int
    healthy: object = None

    def basis(self, roll, z):
        """Rows ``(n, PLACES * (degree + 1))`` that read B at roll lengths `roll` and heights `z` [mm]."""
        across, along = _carry(self.gear, roll), modes(z, self.width, self.degree)
        return (across[:, :, None] * along[:, None, :]).reshape(across.shape[0], -1)

    def between(self, first, second):
        """B of a tooth, or between two teeth; None if they are too far apart to have been solved."""
        z = self.gear.z
        whole = self if self.healthy is None else self.healthy
        if (second - first) % z == 0:
            return self.near.get(first % z, whole.near[0])
        for one, two, turned in ((first, second, False), (second, first, True)):
            found = self.far.get((one % z, two % z), whole.far.get((0, (two - one) % z)))
            if found is not None:
                return found.T if turned else found
        return None

    def matrix(self, tooth, roll, z):
        """Displacements ``(n, n)`` [mm/N] of loads at `roll`, `z` [mm] of teeth `tooth` on each other, half-space left out."""
        tooth, rows = np.asarray(tooth), self.basis(roll, z)
        out = np.zeros((tooth.size,) * 2)
        members = {number: np.flatnonzero(tooth == number) for number in np.unique(tooth).tolist()}
        for first, own in members.items():
            for second, theirs in members.items():
                kernel = self.between(first, second)
                if kernel is not None:
                    out[np.ix_(own, theirs)] = rows[own] @ kernel @ rows[theirs].T
        return out


def flexibility3d(gear, material, cracks=(), *, width=None, neighbours=1, order=3, axial=None, refine=1.0):
    """Flexibility of a gear of finite width by the energy model.

    Parameters
    ----------
    gear : Gear
        With a positive `beta` the section at height z is that at z = 0 turned clockwise by ``z tan(beta) / r``; bore or rim are
        held over the whole width, the end faces free.
    material : Material
    cracks : tuple of Crack
        Through the whole width, parallel to the teeth. Their faces may pass through each other. Their `tooth` counts to the
        loaded side of this gear.
    width : float, optional
        [mm], default ``gear.b``.
    neighbours : int
        How many following teeth may carry load at the same time.
    order : int
        Of the polynomials in the section, 2 to 8.
    axial : int, optional
        Degree of the polynomials along the width, 0 or at least 3; default `axial_degree`. 0 on a spur gear is plane strain.
    refine : float
        Divides the edge lengths of the triangles.

    Returns
    -------
    Flexibility3D

    Raises
    ------
    ValueError
        If an option is out of range.
    """
    width = float(gear.b if width is None else width)
    if not (math.isfinite(width) and width > 0):
        raise ValueError(f"width = {width} mm, but a gear needs a positive face width")
    axial = axial_degree(width, gear.m_n) if axial is None else axial
    if isinstance(order, bool) or not isinstance(order, Integral) or not 2 <= order <= 8:
        raise ValueError(f"order = {order!r}, but it is the polynomial order: a whole number from 2 to 8")
    if isinstance(axial, bool) or not isinstance(axial, Integral) or not (axial == 0 or axial > LOST):
        raise ValueError(f"axial = {axial!r}, but it is the degree along the width: 0, or a whole number from {LOST + 1}")
    options = (width, int(order), int(axial), float(refine))
    neighbours = min(neighbours, gear.z - 1)
    if cracks:
        return _cracked(gear, material, tuple(cracks), neighbours, *options)
    return _healthy(gear, material, neighbours, *options)


def axial_degree(width, m_n):
    """Degree along a `width` [mm] that goes with cubic triangles: 2 and 0.8 per normal module [mm], at least 8."""
    return max(8, math.ceil(0.8 * width / m_n) + LOST)


@lru_cache(maxsize=16)
def _healthy(gear, material, neighbours, *options):
    one = _panel(gear, material, (), *options)
    return _joined(gear, material, dict.fromkeys(range(neighbours + 1), one), one, {}, *options, None)


@lru_cache(maxsize=8)
def _cracked(gear, material, cracks, neighbours, *options):
    one = _panel(gear, material, (), *options)
    found = {t: tuple(c for c in cracks if c.tooth % gear.z == t) for t in sorted({crack.tooth % gear.z for crack in cracks})}
    panels = {(t + k) % gear.z: one for t in found for k in range(-neighbours, neighbours + 1)}
    panels |= {t: _panel(gear, material, own, *options) for t, own in found.items()}
    healthy = _healthy(gear, material, neighbours, *options)
    return _joined(gear, material, dict(sorted(panels.items())), one, found, *options, healthy)


@lru_cache(maxsize=16)
def _panel(gear, material, cracks, width, order, axial, refine):
    return panel3d(gear, _sector(gear, cracks, refine), material, _knots(gear), width, order=order, degree=axial)


@lru_cache(maxsize=16)
def _sector(gear, cracks, refine):
    return sector(gear, cracks, refine=refine, sizes=SIZES)


def _joined(gear, material, panels, one, cracks, width, order, axial, refine, healthy):
    influence, _ = ritz._join(gear, panels, one)
    degree = max(axial - LOST, 0)
    kept = (np.arange(PLACES)[:, None] * (axial + 1) + np.arange(degree + 1)).ravel()
    influence = {key: value[np.ix_(kept, kept)] for key, value in influence.items()}
    local = half_space(material) * _own(gear, width, degree)
    missing = _missing(gear, material, (), order, refine)
    local = local - np.kron(missing, np.eye(degree + 1))
    near = {t: influence[t, t] - local for t in panels if healthy is not None or t == 0}
    for t, own in cracks.items():
        first = np.arange(PLACES) * (degree + 1)
        near[t][np.ix_(first, first)] += _missing(gear, material, own, order, refine) - missing
    far = {
        (i, j): influence[i, j] for i in panels for j in panels if i != j and (j - i) % gear.z <= gear.z // 2
        if healthy is not None or i == 0
    }  # fmt: skip
    return Flexibility3D(gear, width, degree, half_space(material), near, far, sum(p.unknowns for p in panels.values()), healthy)


@lru_cache(maxsize=64)
def _missing(gear, material, cracks, order, refine):
    """What the section's polynomials miss between the hats ``(PLACES, PLACES)`` [mm per N/mm], known in plane strain.

    There `ritz` has it: it takes the singular fields of loads out. Near the tip corner the difference is that of all modes along
    the width, to a thousandth; what a crack adds to it is taken for the even mode only.
    """
    panels = {}
    for tooth, own in ((0, cracks), (1, ())):
        options = {"order": order, "degree": 0, "plane": True}
        panels[tooth] = panel3d(gear, _sector(gear, own, refine), material, _knots(gear), 1.0, **options)
    found = ritz._join(gear, panels, panels[1])[0][0, 0]
    knots = _knots(gear)
    return plane_hats(gear, material, cracks) + half_plane(material) * hat_logarithm(knots, knots) - found


@lru_cache(maxsize=64)
def plane_hats(gear, material, cracks=()):
    """Plane strain's flexibility between the hats ``(PLACES, PLACES)`` [mm per N/mm], the half-plane's logarithm left out."""
    panels = {k: ritz._panel(gear, material, own, "plane strain", 4, 1.0) for k, own in enumerate((cracks, ()))}
    influence = ritz._join(gear, panels, panels[1])[0][0, 0]
    points, weight = hat_points(_knots(gear), 12)
    carry = ritz._carry(ritz._variable(gear, points.ravel())).reshape(*points.shape, -1)
    mean = np.einsum("hg,hgk->hk", weight, carry)
    return mean @ (influence + influence.T) @ mean.T / 2


def _own(gear, width, degree):
    """Mean distance of each patch to the others of its flank, see `patch_kernel`: ``(n, n)``."""
    knots = _knots(gear)
    roll = roll_at_arc(gear, knots.mean(axis=0))
    slope = math.tan(gear.beta) / gear.r * (roll[:, None] + roll) / 2
    n = PLACES * (degree + 1)
    return patch_kernel(knots, width, degree, slope, 1 / math.cos(gear.beta_b)).reshape(n, n)


def _scale(gear):
    """Ends of the flank as arcs, and the offset in the logarithm of the distance to the tip corner [mm]."""
    return arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a), OFFSET * gear.m_n


def _variable(gear, arc):
    """Place on the flank in [-1, 1]: the logarithm of the distance to the tip corner."""
    low, high, offset = _scale(gear)
    away = high + offset - np.clip(arc, low, high)
    return 2 * np.log(away / (high - low + offset)) / math.log(offset / (high - low + offset)) - 1


@lru_cache(maxsize=64)
def _knots(gear):
    """Hats ``(3, PLACES)`` on the flank [mm]: at Chebyshev points of `_variable`, from root to tip, cut off at the ends."""
    low, high, offset = _scale(gear)
    part = (1 + chebyshev.chebpts1(PLACES)) / 2
    middle = high + offset - (high - low + offset) * (offset / (high - low + offset)) ** part
    reach = HAT * gear.m_n
    return np.array([np.maximum(middle - reach, low), middle, np.minimum(middle + reach, high)])


@lru_cache(maxsize=64)
def _from_hats(gear):
    """Coefficients ``(PLACES, PLACES)`` of Chebyshev polynomials by their means over the hats."""
    points, weight = hat_points(_knots(gear), 12)
    return np.linalg.inv(np.einsum("hg,hgk->hk", weight, chebyshev.chebvander(_variable(gear, points), PLACES - 1)))


def _carry(gear, roll):
    """Matrix ``(n, PLACES)`` from means over the hats to values at roll lengths [mm]."""
    return chebyshev.chebvander(_variable(gear, arc_at(gear, np.asarray(roll, dtype=float))), PLACES - 1) @ _from_hats(gear)


def clear():
    """Forget the gears kept in this process."""
    for kept in (_healthy, _cracked, _panel, _sector, _missing, plane_hats, _knots, _from_hats):
        kept.cache_clear()
