"""Integrals along a tooth as a beam from its root to the load, for true or simplified profiles and damaged sections."""

import math
from functools import lru_cache

import numpy as np
import scipy
from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebint, chebvander
from numpy.polynomial.legendre import leggauss

from ....geometry.damage.hollow import breaks, check_hollows
from ....geometry.tooth.profile import arc_at, cartesian, fillet, flank, form_point
from .beam import load_angle
from .section import DamagedTooth, limits, section

ROOTS = ("fillet", "base", "line", "prism")
FLANK, FOOT = leggauss(24), leggauss(64)
NODES = 40  # Chebyshev nodes per segment of a damaged tooth
HEALTHY = DamagedTooth()


def beam_parts(gear, material, roll, root="fillet", damage=HEALTHY):
    """Return bending, shear and axial flexibility ``(3, n)`` [mm per N/mm] of a tooth as a beam with damaged sections.

    See `gearfe.flexibility.energy.closed.textbook.components` for the integrals, `integrals` for `root` and `damage`.
    """
    beta = load_angle(gear, roll)
    cos, sin = np.cos(beta), np.sin(beta)
    radius, angle = flank(gear, roll)
    i0, i1, i2, area, uncracked = integrals(gear, roll, root, damage)
    arm = cos * (gear.outward * radius * np.cos(angle)) - sin * (radius * np.sin(angle))
    bending = (arm**2 * i0 - 2 * arm * cos * i1 + cos**2 * i2) / material.E
    return bending, 1.2 * cos**2 * area / material.shear_modulus, sin**2 * uncracked / material.E


def integrals(gear, roll, root="fillet", damage=HEALTHY):
    """Integrals of ``1/I, y/I, y**2/I, 1/A``, and of 1/A without cracks, from the foot of the beam to the load.

    Parameters
    ----------
    gear : Gear
    roll : ndarray, shape (n,)
        Roll lengths of the load [mm].
    root : {"fillet", "base", "line", "prism"}
        Where the beam begins, see `gearfe.flexibility.energy.closed.textbook.components`.
    damage : ToothDamage

    Returns
    -------
    ndarray, shape (5, n)
        [1/mm**2, 1/mm, -, -, -] per unit face width; y rises from root to tip (of a ring: minus its y).
    """
    if root not in ROOTS:
        raise ValueError(f"root = {root!r}, but it must be one of {', '.join(ROOTS)}")
    check_hollows(gear, damage.pits)
    if not damage:
        low = _lowest(gear, root)
        foot = np.array(_healthy_foot(gear, root))
        return foot[:, None] + _panel(gear, _flank(gear), low, roll, FLANK)
    limit_lines, pits = _limits(gear, root, damage), damage.pits
    edges, start = _flank_edges(gear, root, limit_lines, pits), np.zeros(5)
    below = _foot(gear, root)
    if below:
        curve, *ends = below
        start = _running(gear, curve, _edges(curve, limit_lines, pits, ends), limit_lines, pits)(np.array(ends[1:]))[:, 0]
    return start[:, None] + _running(gear, _flank(gear), edges, limit_lines, pits)(roll)


def flank_edges(gear, root, damage):
    """Return roll lengths [mm] from the start of the involute to the tip, between which the damaged section is smooth."""
    return _flank_edges(gear, root, _limits(gear, root, damage), damage.pits)


def _flank_edges(gear, root, found, pits):
    kinks = _edges(_flank(gear), found, pits, (_lowest(gear, root), gear.roll_a))
    edges = np.unique(np.concatenate([kinks, *(breaks(gear, pit) for pit in pits)]))[:: gear.outward]
    return edges[np.append(True, np.abs(np.diff(edges)) > 1e-9 * gear.m_n)]


def _lowest(gear, root):
    """Roll length [mm] at which the modelled involute begins."""
    return gear.roll_f if root == "fillet" else math.sqrt(max(gear.r_f**2 - gear.r_b**2, 0.0))


def _limits(gear, root, damage):
    if root == "fillet":
        return limits(gear, damage)
    curve, start, _ = _foot(gear, root) or (_flank(gear), _lowest(gear, root), None)
    return limits(gear, damage, [float(v[0]) for v in curve(np.array([start]))[:2]])


def _edges(curve, found, pits, ends):
    """Return the curve parameters at which limit lines begin or end, and the `ends`."""
    depths = sorted({pit.depth for pit in pits})
    edges = []
    for limit in found:
        at = np.linspace(*ends, 201)
        values = limit.switches(*curve(at)[:2], depths)
        for k, i in np.argwhere(np.sign(values[:, 1:]) * np.sign(values[:, :-1]) < 0):
            edges.append(
                scipy.optimize.brentq(
                    lambda t, k=k, limit=limit: limit.switches(*curve(t)[:2], depths)[k], at[i], at[i + 1], xtol=1e-14
                )
            )
    return np.array([ends[0], *sorted(edges, reverse=ends[0] > ends[1]), ends[1]])


def _panel(gear, curve, start, stop, rule):
    """Return the integrals of the healthy tooth from `start` (number or array) to `stop` (array) of the curve's parameter."""
    points, weights = rule
    span = (np.asarray(stop) - start)[:, None]
    at = np.reshape(start, (-1, 1)) + span / 2 * (1 + points)
    return (_integrands(gear, curve, at, (), ()) * span / 2 * weights).sum(axis=2)


def _integrands(gear, curve, at, found, pits):
    """Return the integrands ``(5, *at.shape)`` of `integrals` over the parameter of the curve."""
    h, y, slope, arc = curve(at)
    flat = [np.broadcast_to(v, at.shape).ravel() for v in (h, y, arc)]
    area, inertia, uncracked = (v.reshape(at.shape) for v in section(gear, *flat, found, pits))
    return slope * np.array([1 / inertia, y / inertia, y**2 / inertia, 1 / area, 1 / uncracked])


def _running(gear, curve, edges, found, pits):
    """Return the integrals of a damaged tooth from the first edge to any place, as a function of places ``(n,)``.

    The sections are independent of the load, so that one polynomial per part between edges is valid for all loads. At the
    ends of pits, damaged sections vary like square roots. They are smooth in the angle t of ``place = edge + span sin(t)**2``.
    """
    at, span = edges[:-1, None], np.diff(edges)[:, None]
    nodes = np.cos(math.pi * (np.arange(NODES) + 0.5) / NODES)
    angle = math.pi / 4 * (1 + nodes)
    values = _integrands(gear, curve, at + span * np.sin(angle) ** 2, found, pits) * span * np.sin(2 * angle)
    fitted = values @ chebvander(nodes, NODES - 1) * 2 / NODES
    fitted[..., 0] /= 2
    grown = chebint(fitted, lbnd=-1, scl=math.pi / 4, axis=-1)
    before = np.cumsum(grown.sum(axis=-1), axis=1) - grown.sum(axis=-1)  # Every Chebyshev polynomial has the value 1 at 1.

    sign = np.sign(span.sum())

    def at_places(places):
        part = np.clip(np.searchsorted(sign * edges, sign * places, side="right") - 1, 0, len(span) - 1)
        way = np.clip((places - edges[part]) / span[part, 0], 0, 1)
        beyond = np.abs(edges[part] + way * span[part, 0] - places)
        if (beyond > 1e-6 * gear.m_n).any():
            raise ValueError(
                f"roll = {places[beyond.argmax()]:.6g} mm lies outside the flank of the damaged tooth of z = {gear.z}: give "
                "one from "
                f"{edges.min():.6g} to {edges.max():.6g} mm"
            )
        place = 4 / math.pi * np.arcsin(np.sqrt(way)) - 1
        return before[:, part] + np.einsum("knt,nt->kn", grown[:, part], chebvander(place, NODES))

    return at_places


def _flank(gear):
    """Curve of the involute by roll length [mm]: half thickness, height, its derivative, and the arc."""

    def involute(at):
        radius, angle = flank(gear, at)
        slope = gear.outward * at / gear.r_b * np.cos(load_angle(gear, at))
        return radius * np.sin(angle), gear.outward * radius * np.cos(angle), slope, arc_at(gear, at)

    return involute


def _foot(gear, root):
    """Return the profile below the involute as a curve, and its parameter range from the root upwards, or None."""
    if root == "fillet":
        top = form_point(gear)[0]
        slope = _fillet_height(gear).deriv()

        def trochoid(phi):
            x, y = cartesian(*fillet(gear, phi))
            return x, gear.outward * y, gear.outward * slope(phi), math.nan

        return trochoid, math.pi / 2, top
    if root == "base" or gear.r_f >= gear.r_b:
        return None
    sin, cos = math.sin(gear.base_half_angle), math.cos(gear.base_half_angle)
    if root == "line":
        return lambda r: (r * sin, r * cos, np.full(np.shape(r), cos), math.nan), gear.r_f, gear.r_b
    x = gear.r_b * sin
    return lambda y: (np.full(np.shape(y), x), y, np.ones(np.shape(y)), math.nan), math.sqrt(gear.r_f**2 - x**2), gear.r_b * cos


@lru_cache(maxsize=64)
def _fillet_height(gear):
    """Return a Chebyshev interpolant (48 nodes) of the fillet height [mm] over the rack tip angle."""
    top = form_point(gear)[0]
    return Chebyshev.interpolate(lambda phi: cartesian(*fillet(gear, phi))[1], 48, domain=[top, math.pi / 2])


@lru_cache(maxsize=64)
def _healthy_foot(gear, root):
    below = _foot(gear, root)
    if below is None:
        return (0.0,) * 5
    curve, start, stop = below
    return tuple(_panel(gear, curve, start, np.array([stop]), FOOT)[:, 0].tolist())
