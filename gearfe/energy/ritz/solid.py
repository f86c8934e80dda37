"""The energy model in three dimensions: helical and spur gears of any width, both end faces free.

Curved triangles in the section times polynomials along the width (`panel3d`), all sectors joined exactly as in `ritz`. Loads are
patches on the flank; see `gearfe.flexibility.solid` for what is made of them.
"""

import math
from dataclasses import replace
from functools import lru_cache
from numbers import Integral

import numpy as np

from geometry.mesh.sector import sector

from ...flexibility.halfspace import hat_points
from ...flexibility.hertz import half_plane, hat_logarithm
from ...flexibility.solid import PLACES, Faces, hats, parted, solved_teeth
from . import plane as ritz
from .elimination import dissect
from .panel3d import panel3d

LOST = 2  # axial modes too poor to be kept
# edge lengths in modules, see `geometry.mesh.sector.SIZES`
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


def flexibility3d(gear, material, cracks=(), *, width=None, neighbours=1, order=3, axial=None, refine=1.0):
    """Flexibility of a gear of finite width by the energy model.

    Parameters
    ----------
    gear : Gear
        With a positive `beta` the section at height z is that at z = 0 turned clockwise by ``z tan(beta) / r``; bore or rim are
        held over the whole width, the end faces free.
    material : Material
    cracks : tuple of Crack
        Parallel to the teeth, open over the whole width or parts of it, not sloping. Their `tooth` counts to the loaded side of
        this gear.
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
        If an option is out of range, or a crack's depth changes along the width.
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
    if not cracks:
        return _healthy(gear, material, min(neighbours, gear.z - 1), *options)
    return _cracked(gear, material, _even(cracks), min(neighbours, gear.z - 1), *options)


def axial_degree(width, m_n):
    """Degree along a `width` [mm] that goes with cubic triangles: 2 and 0.8 per normal module [mm], at least 8."""
    return max(8, math.ceil(0.8 * width / m_n) + LOST)


@lru_cache(maxsize=16)
def _healthy(gear, material, neighbours, *options):
    one = _panel(gear, material, (), *options)
    return _joined(gear, material, dict.fromkeys(solved_teeth(gear, (), neighbours), one), one, {}, *options, None)


@lru_cache(maxsize=8)
def _cracked(gear, material, cracks, neighbours, *options):
    one = _panel(gear, material, (), *options)
    found = {t: tuple(c for c in cracks if c.tooth % gear.z == t) for t in {crack.tooth % gear.z for crack in cracks}}
    panels = dict.fromkeys(solved_teeth(gear, cracks, neighbours), one)
    panels |= {t: _panel(gear, material, own, *options) for t, own in found.items()}
    return _joined(gear, material, panels, one, found, *options, _healthy(gear, material, neighbours, *options))


def _even(cracks):
    """Cracks open over their whole length; ValueError if one is not so over all of its width."""
    for crack in cracks:
        if crack.ends != (1.0, 1.0):
            raise ValueError(
                f"crack open over parts {crack.ends} of its length, but the energy model has cracks of one depth: give "
                "ends = (1, 1) and the level they have there, or use method = 'fe3d'"
            )
    return tuple(cracks)


def _seams(cracks):
    """Cracks of one tooth as the section has them, and where along the width each is open (None: everywhere).

    Raises
    ------
    ValueError
        If cracks on one side of a tooth are not parts of one crack.
    """
    found = {}
    for crack in cracks:
        found.setdefault(replace(crack, width=None), []).append(crack.width)
    sides = [crack.side for crack in found]
    if len(set(sides)) < len(sides):
        raise ValueError(
            f"cracks of different shape on the {sides[0]} side of a tooth: the energy model has one section for all of them; "
            "give them the same level, start and angle, or use method = 'fe3d'"
        )
    return tuple(found), tuple(None if None in widths else tuple(widths) for widths in found.values())


@lru_cache(maxsize=16)
def _panel(gear, material, cracks, width, order, axial, refine):
    shapes, parts = _seams(cracks)
    section, tree = _sector(gear, shapes, refine)
    options = {"order": order, "degree": axial, "parts": parts, "tree": tree}
    return panel3d(gear, section, material, hats(gear), width, **options)


@lru_cache(maxsize=16)
def _plane_panel(gear, material, cracks, order, refine):
    section, tree = _sector(gear, cracks, refine)
    options = {"order": order, "degree": 0, "plane": True, "tree": tree}
    return panel3d(gear, section, material, hats(gear), 1.0, **options)


@lru_cache(maxsize=16)
def _sector(gear, cracks, refine):
    made = sector(gear, cracks, refine=refine, sizes=SIZES)
    return made, dissect(made)


def _joined(gear, material, panels, one, cracks, width, order, axial, refine, healthy):
    influence, opening = ritz._join(gear, panels, one)
    degree = max(axial - LOST, 0)
    kept = (np.arange(PLACES)[:, None] * (axial + 1) + np.arange(degree + 1)).ravel()
    influence = {key: value[np.ix_(kept, kept)] for key, value in influence.items()}
    missing = _missing(gear, material, (), order, refine)
    for tooth in panels:
        influence[tooth, tooth] = influence[tooth, tooth] + np.kron(missing, np.eye(degree + 1))
    even = np.ix_(*[np.arange(PLACES) * (degree + 1)] * 2)
    for tooth, own in cracks.items():
        if all(crack.through for crack in own):
            influence[tooth, tooth][even] += _missing(gear, material, own, order, refine) - missing
    made = parted(gear, material, width, degree, influence, sum(p.unknowns for p in panels.values()), healthy)
    if not cracks:
        return made
    faces = Faces({tooth: opening[tooth][:, kept] for tooth in panels}, opening["influence"])
    return replace(made, seam=faces)


@lru_cache(maxsize=64)
def _missing(gear, material, cracks, order, refine):
    """What the section's polynomials miss between the hats ``(PLACES, PLACES)`` [mm per N/mm], known in plane strain.

    There `ritz` has it: it takes the singular fields of loads out. Near the tip corner the difference is that of all modes along
    the width, to a thousandth; what a crack adds to it is taken for the even mode only.
    """
    panels = {tooth: _plane_panel(gear, material, own, order, refine) for tooth, own in ((0, cracks), (1, ()))}
    found = ritz._join(gear, panels, panels[1])[0][0, 0]
    return plane_hats(gear, material, cracks) + half_plane(material) * hat_logarithm(hats(gear), hats(gear)) - found


@lru_cache(maxsize=64)
def plane_hats(gear, material, cracks=()):
    """Plane strain's flexibility between the hats ``(PLACES, PLACES)`` [mm per N/mm], the half-plane's logarithm left out."""
    panels = {k: ritz._panel(gear, material, own, "plane strain", 4, 1.0) for k, own in enumerate((cracks, ()))}
    influence = ritz._join(gear, panels, panels[1])[0][0, 0]
    points, weight = hat_points(hats(gear), 12)
    carry = ritz._carry(ritz._variable(gear, points.ravel())).reshape(*points.shape, -1)
    mean = np.einsum("hg,hgk->hk", weight, carry)
    return mean @ (influence + influence.T) @ mean.T / 2


def clear():
    """Forget the gears kept in this process."""
    for kept in (_healthy, _cracked, _panel, _plane_panel, _sector, _missing, plane_hats):
        kept.cache_clear()
