"""The converged energy model: least potential energy over polynomials on one pitch sector, all sectors joined exactly.

Nothing is fitted and no mesh is fine: the field of each load near itself is Flamant's (`panel`), the rest is carried by about
a hundred curved triangles of order 4; sectors without load are joined by doubling, so the whole gear costs little more than
one tooth.
"""

from functools import lru_cache
from numbers import Integral

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import CubicSpline, RectBivariateSpline
from scipy.linalg import cholesky, solve_triangular

from geometry.damage.crack import check_through
from geometry.mesh.outline import stations
from geometry.mesh.sector import sector
from geometry.tooth.profile import arc_at, roll_at_arc

from ...elements.fe import EDGES, SPAN, TIP_ZONE
from ...flexibility.hertz import half_plane, hat_logarithm
from ...flexibility.plane import Flexibility, SeamFaces, TipHats
from .panel import panel

PLACES = 16  # loads on each flank
NEAREST = 0.001  # of them to the tip corner, and to the form point 20 times as much [m_n]
HATS = 2  # times finer hats at the tip corner than those of `fe`
KNOTS = 48  # of the splines that carry their polynomial


def flexibility(gear, material, cracks=(), *, neighbours=1, state="plane strain", order=4, refine=1.0):
    """Flexibility of a gear by the energy model.

    Parameters
    ----------
    gear : Gear
    material : Material
    cracks : tuple of Crack
        Their `tooth` counts to the loaded side of this gear.
    neighbours : int
        How many following teeth may carry load at the same time.
    state : {"plane strain", "plane stress"}
    order : int
        Polynomial order, 2 to 8.
    refine : float
        Divides the edge lengths of the triangles.

    Returns
    -------
    Flexibility

    Raises
    ------
    ValueError
        If `order` is out of range or a crack changes along the width.
    """
    if isinstance(order, bool) or not isinstance(order, Integral) or not 2 <= order <= 8:
        raise ValueError(f"order = {order!r}, but it is the polynomial order: a whole number from 2 to 8")
    options = (state, int(order), float(refine))
    check_through(cracks, "the energy model of the section")
    if not cracks:
        return _healthy(gear, material, neighbours, *options)
    reach = max(1, neighbours - 1)
    solved = sorted({(crack.tooth + k) % gear.z for crack in cracks for k in range(-reach, reach + 1)})
    by_tooth = {tooth: tuple(c for c in cracks if c.tooth % gear.z == tooth) for tooth in solved}
    return _solved(gear, material, by_tooth, _healthy(gear, material, neighbours, *options), *options)


@lru_cache(maxsize=64)
def _healthy(gear, material, neighbours, state, order, refine):
    one = _panel(gear, material, (), state, order, refine)
    teeth = range(min(neighbours + 1, gear.z))
    influence, _ = _join(gear, dict.fromkeys(teeth, one), one)
    near, tip = _own_tooth(gear, influence[0, 0], half_plane(material, state), refine)
    far = {(0, k): _spline(gear, influence[0, k]) for k in teeth if k}
    return Flexibility(gear, {0: near}, far, {0: tip}, _limits(gear), one.unknowns)


def _solved(gear, material, cracks, healthy, state, order, refine):
    """Flexibility with the `cracks` of each solved tooth; `healthy` serves the others."""
    one = _panel(gear, material, (), state, order, refine)
    panels = {t: _panel(gear, material, own, state, order, refine) if own else one for t, own in cracks.items()}
    influence, opening = _join(gear, panels, one)
    between = opening["influence"]
    stiffness = np.linalg.inv(between)
    near, tip, far = {}, {}, {}
    for i in cracks:
        for j in cracks:
            glued = influence[i, j] - opening[i].T @ stiffness @ opening[j]
            if i == j:
                near[i], tip[i] = _own_tooth(gear, glued, half_plane(material, state), refine)
            elif (j - i) % gear.z <= gear.z // 2:
                far[i, j] = _spline(gear, glued)
    arcs, carry = _knots(gear)
    seam = SeamFaces({t: CubicSpline(arcs, carry @ opening[t].T) for t in cracks}, between, stiffness)
    return Flexibility(gear, near, far, tip, _limits(gear), sum(p.unknowns for p in panels.values()), healthy, seam)


@lru_cache(maxsize=64)
def _panel(gear, material, cracks, state, order, refine):
    """A sector under loads at `_places`."""
    return panel(gear, sector(gear, cracks, refine=refine), material, _places(gear), order=order, state=state)


def _join(gear, panels, healthy):
    """Influence between the loads of the teeth of `panels`, with `healthy` sectors everywhere else.

    Returns
    -------
    influence : dict of (int, int) to ndarray, shape (n, n)
    opening : dict
        By tooth the opening of all facing crack nodes under its loads ``(k, n)``, and under ``"influence"`` that under unit
        forces on them ``(k, k)``.
    """
    teeth = sorted(panels)
    segments = []
    for tooth, following in zip(teeth, [*teeth[1:], teeth[0] + gear.z], strict=True):
        segments.append((tooth, panels[tooth].stiffness))
        if following - tooth > 1:
            segments.append((None, _repeated(healthy.stiffness, following - tooth - 1)))
    half = healthy.stiffness.shape[0] // 2
    total = np.zeros((len(segments) * half,) * 2)
    pushes, loads = {}, []
    for k, (tooth, stiffness) in enumerate(segments):
        places = np.concatenate([k * half + np.arange(half), (k + 1) % len(segments) * half + np.arange(half)])
        total[np.ix_(places, places)] += stiffness
        if tooth is not None:
            push = np.zeros((total.shape[0], panels[tooth].push.shape[1] + panels[tooth].open_push.shape[1]))
            push[places] = np.hstack([panels[tooth].push, panels[tooth].open_push])
            pushes[tooth] = slice(sum(p.shape[1] for p in loads), sum(p.shape[1] for p in loads) + push.shape[1])
            loads.append(push)
    loads = np.hstack(loads)
    halved = _halved(total, loads)
    between = halved.T @ halved
    n = healthy.push.shape[1]
    for tooth in teeth:
        at, one = pushes[tooth], panels[tooth]
        own = (one.own + one.own.T) / 2
        between[at, at] += np.block([[own, one.open_own.T], [one.open_own, one.open_open]])
    index = {t: np.arange(pushes[t].start, pushes[t].start + n) for t in teeth}
    faces = np.concatenate([np.arange(pushes[t].start + n, pushes[t].stop) for t in teeth])
    influence = {(i, j): between[np.ix_(index[i], index[j])] for i in teeth for j in teeth}
    opening = {t: between[np.ix_(faces, index[t])] for t in teeth}
    mutual = between[np.ix_(faces, faces)]
    return influence, opening | {"influence": (mutual + mutual.T) / 2}


def _repeated(stiffness, count):
    """Stiffness between the outer sides of `count` equal sectors in a row, by doubling."""
    out = None
    while count:
        if count % 2:
            out = stiffness if out is None else _pair(out, stiffness)
        count //= 2
        stiffness = _pair(stiffness, stiffness) if count else stiffness
    return out


def _pair(one, two):
    """Two sectors side by side, their common side eliminated."""
    h = one.shape[0] // 2
    middle = one[h:, h:] + two[:h, :h]
    coupling = np.hstack([one[h:, :h], two[:h, h:]])
    halved = _halved(middle, coupling)
    out = -halved.T @ halved
    out[:h, :h] += one[:h, :h]
    out[h:, h:] += two[h:, h:]
    return (out + out.T) / 2


def _halved(stiffness, loads):
    """``L**-1 loads`` of ``stiffness = L L'``: its square is the displacement of the loads under each other."""
    return solve_triangular(cholesky(stiffness, lower=True, check_finite=False), loads, lower=True, check_finite=False)


def _limits(gear):
    nearest = NEAREST * gear.m_n
    return arc_at(gear, gear.roll_f) + 20 * nearest, arc_at(gear, gear.roll_a) - nearest


def _scale(gear):
    """The variable of the flank: its roll length at the tip, an offset, and both ends of the logarithm between the limits.

    The flexibility is smooth in the roll length, not in the arc, near the base circle, and logarithmic towards the tip corner.
    """
    offset = NEAREST * gear.m_n * gear.r_b / gear.roll_a
    low, high = (np.log(abs(gear.roll_a - roll_at_arc(gear, limit)) + offset) for limit in _limits(gear))
    return offset, low, high


def _variable(gear, arc):
    """Place on the flank in [-1, 1]: the logarithm of the distance to the tip corner in roll."""
    offset, low, high = _scale(gear)
    return (2 * np.log(np.abs(gear.roll_a - roll_at_arc(gear, arc)) + offset) - low - high) / (high - low)


def _arcs(gear, places):
    offset, low, high = _scale(gear)
    away = np.exp((low + high) / 2 + (high - low) / 2 * places) - offset
    return arc_at(gear, gear.roll_a - gear.outward * away)


@lru_cache(maxsize=64)
def _places(gear):
    """Roll lengths of the loads: Chebyshev points in `_variable`, from root to tip."""
    return roll_at_arc(gear, _arcs(gear, chebyshev.chebpts2(PLACES)))


def _carry(places):
    """Matrix ``(n, PLACES)`` from values at the loads to values at `places` of `_variable`."""
    nodes = chebyshev.chebvander(chebyshev.chebpts2(PLACES), PLACES - 1)
    return np.linalg.solve(nodes.T, chebyshev.chebvander(np.clip(places, -1, 1), PLACES - 1).T).T


@lru_cache(maxsize=64)
def _knots(gear):
    """Arcs of the splines' knots, and the matrix from values at the loads to values there."""
    places = np.linspace(-1, 1, KNOTS)
    return _arcs(gear, places), _carry(places)


def _spline(gear, influence):
    arcs, carry = _knots(gear)
    return RectBivariateSpline(arcs, arcs, carry @ influence @ carry.T)


@lru_cache(maxsize=64)
def _hats(gear, refine):
    """Knots ``(3, n)`` of the hats next to the tip corner, and the matrix from values at the loads to values at their centres."""
    edge = {name: size * gear.m_n / (HATS * refine) for name, size in EDGES.items()}
    arc = arc_at(gear, stations(gear, edge["flank"], tip=edge["tip"], low=edge["low"], span=SPAN))
    knots = np.array([arc[: -2 * SPAN : SPAN], arc[SPAN:-SPAN:SPAN], arc[2 * SPAN :: SPAN]])
    knots = np.column_stack([knots, [arc[-1 - SPAN], arc[-1], arc[-1]]])
    knots = knots[:, knots[1] > arc[-1] - TIP_ZONE * gear.m_n]
    return knots, _carry(_variable(gear, knots.mean(axis=0)))


def _own_tooth(gear, influence, coefficient, refine):
    """Spline S(s, s) of a tooth and its `TipHats`, from the smooth influence between its loads."""
    arcs, carry = _knots(gear)
    near = CubicSpline(arcs, np.einsum("ki,ij,kj->k", carry, influence, carry))
    knots, carry = _hats(gear, refine)
    smooth = carry @ influence @ carry.T
    return near, TipHats(knots.mean(axis=0), knots, smooth + coefficient * hat_logarithm(knots, knots))


def clear():
    """Forget the gears kept in this process."""
    for kept in (_healthy, _panel, _places, _knots, _hats):
        kept.cache_clear()
