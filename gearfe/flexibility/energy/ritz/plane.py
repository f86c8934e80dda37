"""Converged energy model: least potential energy over polynomials on one pitch sector. All sectors are joined exactly.

No constant is fitted. The field near each load is Flamant's (`panel`), and about a hundred curved triangles of order 4 represent
the rest. Sectors without load are joined by doubling, so that the whole gear costs little more than one tooth.
"""

from functools import partial

import numpy as np
from numpy.polynomial import chebyshev

from ....geometry.cubic import Bicubic, Cubic
from ....geometry.damage.chip import loaded_side
from ....geometry.damage.crack import check_through
from ....geometry.damage.missing import MissingTooth, missing_teeth
from ....geometry.kept import keeping
from ....geometry.mesh.sector import sector
from ....geometry.tooth.profile import arc_at, roll_at_arc
from ...plane import BELOW, NEAREST, TILT, Flexibility, SeamFaces, glued, leaning, reached_teeth
from ...solved import solved_gears
from .join import join
from .panel import SectionModel, check_order, panel

PLACES = 16  # number of loads on each flank
FOOT = 20 * NEAREST  # distance of the first load from the form point [m_n]; the last load is `NEAREST` from the tip corner
HATS = 2  # ratio of the lengths of hat functions of `fe` at corners to these
KNOTS = 48  # number of knots of the splines that represent the polynomials


def flexibility(gear, material, cracks=(), *, broken=(), neighbours=1, state="plane strain", order=4, refine=1.0, cache=True):
    """Compute the `Flexibility` of a gear by the energy model.

    Parameters
    ----------
    gear : Gear
    material : Material
    cracks : tuple of Crack
        Their `tooth` counts to the loaded side of this gear.
    broken : tuple of (MissingTooth or Chip)
        Missing teeth and chipped tips, in the same numbers.
    neighbours : int
        How many following teeth may carry load at the same time.
    state : {"plane strain", "plane stress"}
    order : int
        Polynomial order, 2 to 8.
    refine : float
        Divides the edge lengths of the triangles and the hat functions at corners.
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.

    Raises
    ------
    ValueError
        If `order` is out of range or a crack changes along the width.
    """
    check_order(order)
    check_through(cracks, "the energy model of the section")
    model = SectionModel(gear, material, state, int(order), float(refine))
    return _flexibility(model, tuple(cracks), tuple(broken), neighbours, solved_gears(cache))


def _flexibility(model, cracks, broken, neighbours, cache):
    solve = partial(_damaged, model, cracks, broken) if cracks or broken else partial(_healthy, model)
    return cache.get(("ritz", model, cracks, broken, neighbours), partial(solve, neighbours, cache))


def _healthy(model, neighbours, cache):
    gear, healthy = model.gear, loaded_sector(model, (), cache)
    teeth = range(min(neighbours + 1, gear.z))
    influence, _ = join(gear, dict.fromkeys(teeth, healthy), healthy)
    far = {(0, k): _spline(gear, influence[0, k]) for k in teeth if k}
    near, within, leans = _own_tooth(gear, influence[0, 0])
    fine = HATS * model.refine
    return Flexibility(
        gear, {0: near}, far, {0: within}, _limits(gear), fine, healthy.unknowns, basis=_basis(gear), leans={0: leans}
    )


def _damaged(model, cracks, broken, neighbours, cache):
    """Return the flexibility with damage. Teeth outside `reached` have the healthy flexibility."""
    gear = model.gear
    healthy = _flexibility(model, (), (), neighbours, cache)
    gone, hurt = missing_teeth(gear, broken), {one.tooth % gear.z: one for one in broken}
    reached = reached_teeth(gear, (*cracks, *broken), neighbours)
    ends = {tooth: loaded_side(gear, broken, tooth) for tooth in reached}
    by_tooth = {tooth: tuple(crack for crack in cracks if crack.tooth % gear.z == tooth) for tooth in reached}
    panels = {tooth: loaded_sector(model, own, cache, broken=hurt.get(tooth)) for tooth, own in by_tooth.items()}
    influence, opening = join(gear, panels, loaded_sector(model, (), cache))
    teeth = [tooth for tooth in reached if tooth not in gone]
    between = opening["influence"]
    stiffness = np.linalg.inv(between)
    own, ahead = glued(gear, teeth, lambda i, j: influence[i, j], opening, stiffness)
    parts = {tooth: _own_tooth(ends[tooth], own[tooth]) for tooth in teeth}
    near, within, leans = ({tooth: part[k] for tooth, part in parts.items()} for k in range(3))
    far = {(i, j): _spline(ends[i], one, ends[j]) for (i, j), one in ahead.items()}
    seam = SeamFaces({t: _opening(ends[t], opening[t]) for t in teeth}, between, stiffness)
    unknowns, fine = sum(p.unknowns for p in panels.values()), HATS * model.refine
    seam = seam if cracks else None
    tips = {t: (end.roll_a, _limits(end), _basis(end)) for t, end in ends.items() if end is not gear}
    return Flexibility(gear, near, far, within, _limits(gear), fine, unknowns, healthy, seam, _basis(gear), leans, gone, tips)


def loaded_sector(model, cracks, cache=True, *, broken=None):
    """Return the `Panel` of a sector with `cracks` under normal loads at `loaded_places` and eight inclined loads at `_leans`.

    The tooth may be `broken`. A missing tooth has no loads.
    """
    gear = model.gear
    end, missing = loaded_side(gear, [broken], broken.tooth if broken else 0), isinstance(broken, MissingTooth)

    def solve():
        rolls = np.append(loaded_places(end), np.repeat(roll_at_arc(gear, _leans(end)), 2))
        tilt = np.append(np.zeros(PLACES), [TILT, -TILT] * 4)
        loads = slice(0 if missing else None)
        return panel(model, sector(gear, cracks, broken=broken, refine=model.refine), rolls[loads], tilt[loads])

    return solved_gears(cache).get(("ritz sector", model, cracks, broken), solve)


def _limits(gear):
    return arc_at(gear, gear.roll_f) + FOOT * gear.m_n, arc_at(gear, gear.roll_a) - NEAREST * gear.m_n


def _leans(gear):
    """Return the four arcs of the inclined loads [mm] (see `leaning`)."""
    low, high = _limits(gear)
    below = max(high - BELOW * gear.m_n, (low + high) / 2)
    return np.array([low, (low + below) / 2, below, high])


def _scale(gear):
    """Return the scale of the flank variable: roll length at the tip, an offset, and both ends of the logarithm.

    The flexibility is smooth in the roll length, not in the arc, near the base circle, and logarithmic towards the tip corner.
    """
    offset = NEAREST * gear.m_n * gear.r_b / gear.roll_a
    low, high = (np.log(abs(gear.roll_a - roll_at_arc(gear, limit)) + offset) for limit in _limits(gear))
    return offset, low, high


def _variable(gear, arc):
    """Place on the flank in [-1, 1], by the logarithm of the distance to the tip corner in roll length."""
    offset, low, high = _scale(gear)
    return (2 * np.log(np.abs(gear.roll_a - roll_at_arc(gear, arc)) + offset) - low - high) / (high - low)


def _arcs(gear, places):
    offset, low, high = _scale(gear)
    away = np.exp((low + high) / 2 + (high - low) / 2 * places) - offset
    return arc_at(gear, gear.roll_a - gear.outward * away)


@keeping(64)
def loaded_places(gear):
    """Roll lengths of the loads: Chebyshev points in `_variable`, from root to tip."""
    return roll_at_arc(gear, _arcs(gear, chebyshev.chebpts2(PLACES)))


def carry(gear, arc):
    """Interpolation matrix ``(n, PLACES)`` from values at the loads to values at arcs ``(n,)`` of the flank [mm]."""
    return _carry(_variable(gear, arc))


def _carry(places):
    """Interpolation matrix ``(n, PLACES)`` from values at the loads to values at `places`, which are in `_variable`."""
    nodes = chebyshev.chebvander(chebyshev.chebpts2(PLACES), PLACES - 1)
    return np.linalg.solve(nodes.T, chebyshev.chebvander(np.clip(places, -1, 1), PLACES - 1).T).T


@keeping(64)
def _knots(gear):
    """Return the arcs of the spline knots, and the matrix from values at the loads to values at the knots."""
    return _arcs(gear, np.linspace(-1, 1, KNOTS)), _between()


@keeping(1)
def _between():
    return _carry(np.linspace(-1, 1, KNOTS))


def _spline(gear, influence, other=None):
    """Return the `influence` between two flanks as a spline over their arcs. The tips of the two teeth may differ."""
    return Bicubic(_basis(gear), influence[:PLACES, :PLACES], _basis(other or gear))


def _opening(gear, opening):
    arcs, matrix = _knots(gear)
    return Cubic(arcs, matrix @ opening[:, :PLACES].T)


@keeping(64)
def _basis(gear):
    """Return the spline basis for S(s, s') of a tooth: from values at the loads to values at an arc."""
    return Cubic(*_knots(gear))


def _own_tooth(gear, influence):
    """Return splines S(s, s) and S(s, s') of normal loads, and `leaning`, from the influence of all loads."""
    (arcs, matrix), between = _knots(gear), influence[:PLACES, :PLACES]
    near = Cubic(arcs, ((matrix @ between) * matrix).sum(axis=1))
    at, tilted = _leans(gear), np.diag(influence)[PLACES:]
    return near, (between + between.T) / 2, leaning(at, near(at), tilted[::2], tilted[1::2])
