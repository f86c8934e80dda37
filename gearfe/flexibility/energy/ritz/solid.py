"""Energy model in three dimensions: helical and spur gears of any width with free end faces.

Curved triangles in the section times polynomials along the width (`panel3d`), all sectors joined exactly as in `ritz`. Loads are
patches on the flank (`gearfe.flexibility.solid`).
"""

import math
from dataclasses import replace
from functools import partial
from numbers import Integral

import numpy as np
from numpy.polynomial import chebyshev, legendre

from ....geometry.damage.chip import loaded_side
from ....geometry.damage.crack import Crack
from ....geometry.damage.front import crack_in_band, whole
from ....geometry.damage.missing import MissingTooth
from ....geometry.mesh.sector import sector
from ...solid import PLACES, Faces, hats, parted, solved_teeth
from ...solved import solved_gears, timed
from .bent import bent
from .depth import LOST, axial_degree
from .dissection import dissect
from .join import join
from .panel import check_order
from .panel3d import SolidModel, panel3d
from .plane_strain import completed, missing, missing_at_cracks

# Depths at which a sloping crack's section is compared with plane strain; Gauss points along each open part.
DEPTHS, ALONG = 3, 12
# edge lengths in modules, see `gearfe.geometry.mesh.sector.SIZES`
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


def flexibility3d(gear, material, damage=(), *, neighbours=1, order=3, axial=None, refine=1.0, cache=True):
    """Compute the `Flexibility3D` of a gear of finite width by the energy model.

    Parameters
    ----------
    gear : Gear
        With a positive `beta` the section at height z is that at z = 0 turned clockwise by ``z tan(beta) / r``; bore or rim are
        held over the whole width, the end faces free.
    material : Material
    damage : tuple of (Crack, MissingTooth or Chip)
        Cracks of any depth along the width, but one that changes follows a straight crack. Their `tooth` counts to the loaded
        side of this gear.
    neighbours : int
        How many following teeth may carry load at the same time.
    order : int
        Of the polynomials in the section, 2 to 8.
    axial : int, optional
        Degree of the polynomials along the width, 0 or at least 3; default `axial_degree`. 0 on a spur gear is plane strain.
    refine : float
        Divides the edge lengths of the triangles.
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.

    Raises
    ------
    ValueError
        If an option is out of range, or a tooth has cracks that the model has not.
    """
    axial = axial_degree(gear.b, gear.m_n) if axial is None else axial
    check_order(order)
    if isinstance(axial, bool) or not isinstance(axial, Integral) or not (axial == 0 or axial > LOST):
        raise ValueError(f"axial = {axial!r}, but it is the degree along the width: 0, or a whole number from {LOST + 1}")
    model = SolidModel(gear, material, int(order), int(axial), float(refine))
    return _flexibility(model, tuple(damage), min(neighbours, gear.z - 1), solved_gears(cache))


def _flexibility(model, damage, neighbours, cache):
    solve = partial(_mirrored if model.gear.beta < 0 else _solved, model, damage, neighbours, cache)
    return cache.get(("ritz3d", model, damage, neighbours), solve)


def _mirrored(model, damage, neighbours, cache):
    """Return the flexibility of the gear of opposite hand. From the other end, odd polynomials along the width change sign."""
    gear = model.gear
    damage = tuple(crack_in_band(one, gear.b, gear.b, 0.0) for one in damage)
    other = _flexibility(replace(model, gear=replace(gear, beta=-gear.beta)), damage, neighbours, cache)
    sign = np.tile((-1.0) ** np.arange(other.degree + 1), PLACES)
    near, far = ({key: sign[:, None] * matrix * sign for key, matrix in matrices.items()} for matrices in (other.near, other.far))
    healthy = other.healthy and _flexibility(model, (), neighbours, cache)
    seam = other.seam and replace(other.seam, opening={tooth: matrix * sign for tooth, matrix in other.seam.opening.items()})
    return replace(other, gear=gear, near=near, far=far, healthy=healthy, seam=seam)


def _solved(model, damage, neighbours, cache):
    healthy = _flexibility(model, (), neighbours, cache) if damage else None
    return timed(lambda: _joined(model, damage, neighbours, healthy, cache), healthy)


def _joined(model, damage, neighbours, healthy, cache):
    """Join the flexibility of the gear from its sectors. `healthy` is the flexibility without damage."""
    gear, degree = model.gear, max(model.axial - LOST, 0)
    healthy_panel, teeth = solid_sector(model, (), cache), solved_teeth(gear, damage, neighbours)
    by_tooth = {t: tuple(one for one in damage if one.tooth % gear.z == t) for t in {one.tooth % gear.z for one in damage}}
    panels = dict.fromkeys(teeth, healthy_panel)
    panels |= {t: solid_sector(model, own, cache) for t, own in by_tooth.items()}
    influence, opening = join(gear, panels, healthy_panel)
    kept = (np.arange(PLACES)[:, None] * (model.axial + 1) + np.arange(degree + 1)).ravel()
    influence = {(i, j): influence[i, j][np.ix_(kept, kept)] for i in teeth for j in teeth}
    opening, between = {tooth: opening[tooth][:, kept] for tooth in teeth}, opening["influence"]
    ends = np.cumsum([0, *(panels[tooth].open_own.shape[0] for tooth in sorted(teeth))]).tolist()
    for tooth, first, stop in zip(sorted(teeth), ends[:-1], ends[1:], strict=True):
        own = slice(first, stop)
        _complete(model, by_tooth.get(tooth, ()), influence[tooth, tooth], opening[tooth][own], between[own, own], cache)
    unknowns = sum(p.unknowns for p in panels.values())
    made = parted(gear, model.material, degree, influence, unknowns, healthy, damage=damage, cache=cache)
    return replace(made, seam=Faces(opening, between)) if between.size else made


def _complete(model, damage, influence, opening, between, cache):
    """Add the flexibility that the section polynomials of a tooth with `damage` lack, in place.

    It is added to the `influence` between hat functions, to the `opening` of crack points under the hat functions, and to the
    influence `between` these points. The part of a crack acts through its opening, and vanishes where its faces are closed.
    """
    cracks, broken = _parts(damage)
    slopes, degree = not all(crack.even for crack in cracks), len(influence) // PLACES - 1
    influence += np.kron(_missing(model, broken, cache, slopes), np.eye(degree + 1))
    if slopes and len(cracks) == 1:
        missed = _missing_along(model, cracks[0], cache)
    elif cracks and all(crack.even and crack.width is None for crack in cracks):
        missed = _missing_at_cracks(model, tuple(whole(crack) for crack in cracks), cache)
    else:
        return
    even, root = np.arange(PLACES) * (degree + 1), math.sqrt(model.gear.b)  # The constant mode has the value 1 / root.
    influence[np.ix_(even, even)] += missed[:PLACES]
    heights = len(opening) // (len(missed) - PLACES)
    opening[:, even] += np.repeat(missed[PLACES:], heights, axis=0) / root
    between += np.kron(completed(missed, len(cracks)), np.full((heights,) * 2, 1 / model.gear.b))


def _seams(cracks):
    """Return the cracks of one tooth in the section, their open parts along the width (None: whole width), and their fronts.

    A front is a crack whose depth changes along the width, or None.

    Raises
    ------
    ValueError
        If cracks on one side of a tooth are not parts of one crack, or more than one has a front.
    """
    by_shape = {}
    for crack in cracks:
        by_shape.setdefault(whole(crack), []).append(crack)
    sides = [crack.side for crack in by_shape]
    if len(set(sides)) < len(sides):
        raise ValueError(
            f"cracks of different shape on the {sides[0]} side of a tooth: the energy model has one section for all of them; "
            "give them the same level, start and angle, or use method = 'fe3d'"
        )
    fronts = [None if all(crack.even for crack in group) else group[0] for group in by_shape.values()]
    if len(fronts) - fronts.count(None) > 1 or any(front and len(by_shape[whole(front)]) > 1 for front in fronts):
        raise ValueError(
            f"tooth {cracks[0].tooth} has several cracks, and the depth of more than one may change along the width: the energy "
            "model follows one front; give the others ends = (1, 1) on the other side, or use method = 'fe3d'"
        )
    parts = ([crack.width for crack in group] for group in by_shape.values())
    return tuple(by_shape), [None if None in group else tuple(group) for group in parts], fronts


def _parts(damage):
    """Cracks of a tooth and its lost part (`MissingTooth`, `Chip` or None)."""
    cracks = tuple(one for one in damage if isinstance(one, Crack))
    return cracks, next((one for one in damage if one not in cracks), None)


def solid_sector(model, damage, cache=True):
    """Return the `Panel` of a sector with `damage` of its tooth, loaded by hat functions times all modes (none if missing)."""
    kept, gear = solved_gears(cache), model.gear

    def solve():
        cracks, broken = _parts(damage)
        shapes, parts, fronts = _seams(cracks)
        section, tree = _sector(gear, shapes, broken, model.refine, kept)
        bends = [None] * len(fronts)
        for i, crack in enumerate(fronts):
            if crack:
                bends[i] = bent(gear, section, i, crack)
                parts[i] = bends[i][1].open()
                parts[i] = None if parts[i] == ((0.0, gear.b),) else parts[i]
        knots = hats(loaded_side(gear, damage, damage[0].tooth if damage else 0))
        loads = slice(0 if isinstance(broken, MissingTooth) else None)
        return panel3d(model, section, knots[:, loads], parts=tuple(parts), bends=tuple(bends), tree=tree)

    return kept.get(("ritz3d sector", model, damage), solve)


def _sector(gear, cracks, broken, refine, cache):
    """Return the section's triangles and their nested halves."""

    def solve():
        made = sector(gear, cracks, broken=broken, refine=refine, sizes=SIZES)
        return made, dissect(made)

    return cache.get(("ritz3d section", gear, cracks, broken, refine), solve)


def _missing_along(model, crack, cache):
    """Return the mean of `missing_at_cracks` over the width, with the section following a crack front of changing depth.

    It is solved at `DEPTHS` depths, and interpolated by a polynomial.
    """

    def solve():
        sections = tuple(_sector(model.gear, own, None, model.refine, cache)[0] for own in ((whole(crack),), ()))
        shift, front = bent(model.gear, sections[0], 0, crack)
        x, weight = legendre.leggauss(ALONG)
        parts = np.array(front.open())
        half = np.diff(parts, axis=1) / 2
        depth, weight = front.depth((parts[:, :1] + half * (1 + x)).ravel())[0], (half * weight).ravel() / model.gear.b
        low, high, nodes = depth.min(), depth.max(), chebyshev.chebpts1(DEPTHS)
        at = np.clip((2 * depth - low - high) / max(high - low, 1e-9), -1, 1)
        carry = chebyshev.chebvander(at, DEPTHS - 1) @ np.linalg.inv(chebyshev.chebvander(nodes, DEPTHS - 1))
        out = 0.0
        for own, share in zip(((low + high + (high - low) * nodes) / 2).tolist(), weight @ carry, strict=True):
            points = sections[0].points + (own - 1) * shift
            out = out + share * missing_at_cracks(model, sections, points=points, cubic=True, cache=cache)
        return out

    return cache.get(("ritz3d missing along", model, crack), solve)


def _missing(model, chip, cache, cubic):
    """Return `plane_strain.missing` of the solved section, for all modes along the width.

    Near the tip corner, the difference in plane strain agrees with that of all modes along the width within a thousandth.
    """

    def solve():
        sections = (_sector(model.gear, (), own, model.refine, cache)[0] for own in (chip, None))
        return missing(model, *sections, chip=chip, cubic=cubic, cache=cache)

    return cache.get(("ritz3d missing", model, chip, cubic), solve)


def _missing_at_cracks(model, cracks, cache):
    """Return `plane_strain.missing_at_cracks` of the solved sections, for uniform load along the width."""

    def solve():
        sections = tuple(_sector(model.gear, own, None, model.refine, cache)[0] for own in (cracks, ()))
        return missing_at_cracks(model, sections, cache=cache)

    return cache.get(("ritz3d missing at cracks", model, cracks), solve)
