"""Contacts and gaps of tooth pairs with modified flanks.

With material C1 removed at a point of the pinion's flank, this point is on the involute rotated back by ``C1 / r_b1``. A pitch
deviation rotates the whole flank. In the terms of `geometry.pair.contacts` the involute through that point crosses the line of
action at ``n1 = n + delta / 2 - C1`` and the wheel's at ``n2 = n - delta / 2 + C2``. A pinion point at roll length rho, opposite
the wheel's point at rho2, therefore touches at the approach::

    delta(rho) = C1(rho) + C2(rho2) + D(n + delta / 2 - C1(rho))

The gap of the pair is the least of these over the pinion's whole side, fillet included, and over the corners of both: the
envelope of both modified sides, at the pose in which the pair first touches. The sum of both modifications at the nominal point,
a common approximation, has errors of up to a quarter of the deflection at corners.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..aliases import Floats
from ..tooth.flank_form import FlankForm
from ..tooth.profile import arc_at, fillet_length, roll_at_arc
from .approach import approach, facing
from .contacts import TIP, Contacts, Touch, contacts, corners_of
from .gear_pair import GearPair

EDGE = 0.25  # part of the largest removal of a tip edge at which the edge may touch
FAR = 0.1  # Beyond this unmodified gap only corners are searched, because no load closes it [m_n].
SCAN = 25  # starting points of the search along the flank
OFF = 1e6  # distance assigned to points off the flanks [mm]
VERTEX = 1e-4  # half width of the final parabola of the search [m_n]
GOLDEN = (math.sqrt(5) - 1) / 2
FLATTER = 20.0  # largest relative radius of curvature over that of the involutes; flatter flanks conform, without a contact line


def flank_contacts(
    pair: GearPair, phase: ArrayLike, *, extended: bool = True, flanks: tuple[FlankForm, FlankForm] | None = None
) -> Contacts:
    """Return the `contacts` of a pair with modified flanks, given by `gearfe.geometry.pair.flanks.flank_forms`.

    Gaps can be negative if a tooth is ahead of its nominal position. ValueError if flanks are so hollow that they would conform.
    """
    plain = contacts(pair, phase, extended=extended)
    if flanks is None:
        return plain
    order, touch = np.broadcast_to(plain.order, plain.gap.shape), Touch(*(getattr(plain, name) for name in Touch._fields))
    return Contacts(plain.order, plain.nominal, *touching_modified(pair, flanks, plain.nominal, order, touch))


def touching_modified(
    pair: GearPair, forms: tuple[FlankForm, FlankForm], nominal: Floats, order: NDArray[np.int64], plain: Touch
) -> Touch:
    """Return the first contact of modified flanks, starting from that of unmodified ones, in arrays of any shape.

    See `first_touch`.
    """
    meets, empty = np.isfinite(plain.gap), np.full(plain.gap.shape, np.inf)
    out = Touch(
        plain.roll_1.copy(), plain.roll_2.copy(), empty, np.zeros(meets.shape, dtype=int), np.full_like(plain.corner_gap, np.inf),
        np.full_like(plain.corner_roll, np.nan), np.ones(meets.shape),
    )  # fmt: skip
    for values, met in zip(out, first_touch(pair, forms, nominal[meets], order[meets], plain.gap[meets]), strict=True):
        values[..., meets] = met
    return out


def first_touch(
    pair: GearPair,
    forms: tuple[FlankForm, FlankForm],
    nominal: Floats,
    order: NDArray[np.int64],
    start: Floats,
    z: Floats | None = None,
) -> Touch:
    """Return the first contact of the modified flanks of transverse sections. All contact models use this gap function.

    Parameters
    ----------
    pair : GearPair
    forms : (FlankForm, FlankForm)
        Flanks of pinion and wheel.
    nominal, order : ndarray, shape (n,)
        Abscissae of the sections' contacts on the line of action [mm], and numbers of their pairs.
    start : ndarray, shape (n,)
        Gaps of the unmodified flanks [mm]; inf where they cannot meet.
    z : ndarray, shape (n,), optional
        Heights over the common width of both gears, which lie centred on each other [mm]; without them modifications along the
        width are ignored.

    Returns
    -------
    Touch
        `gap` is the approach shared by both gears at which the section touches, inf where it cannot; `radius` 1 there.

    Raises
    ------
    ValueError
        If flanks are so hollow that they would conform.
    """
    common = pair.b_w
    own_z = [None if z is None else z + (gear.b - common) / 2 for gear in pair.gears]
    sections = forms[0].at(own_z[0]).of(order), forms[1].at(own_z[1]).of(order)
    rolls_1, rolls_2, gap = nominal.copy(), pair.mate_roll(nominal), np.full(nominal.shape, np.inf)
    near, corner = start < FAR * pair.gear_1.m_n, np.zeros(nominal.shape, dtype=int)
    never, start = ~np.isfinite(start), np.where(np.isfinite(start), start, 0.0)
    inner = [form.at(None if h is None else h[near]).of(order[near]) for form, h in zip(forms, own_z, strict=True)]
    rolls_1[near], rolls_2[near], gap[near] = _inside(pair, inner, nominal[near], order[near], start[near])
    gaps, places = np.full((4, nominal.size), np.inf), np.full((2, 4, nominal.size), np.nan)
    for number, roll, driver in corners_of(pair):
        if number in TIP and forms[number - 1].edge is not None:
            continue
        host, met = (rolls_1, rolls_2) if driver else (rolls_2, rolls_1)
        distance, facing_roll, *_ = approach(pair, roll, nominal, driver=driver, start=start, flanks=sections, order=order)
        gaps[number - 1] = np.where(np.isnan(distance) | never, np.inf, distance)
        places[:, number - 1] = (np.full(nominal.size, roll), facing_roll)[:: 1 if driver else -1]
        first = np.isfinite(gaps[number - 1]) & (gaps[number - 1] <= gap + 1e-12)
        host[first], met[first], gap[first], corner[first] = roll, facing_roll[first], distance[first], number
    return Touch(rolls_1, rolls_2, gap, corner, gaps, places, _radius(pair, sections, rolls_1, rolls_2, np.isfinite(gap)))


def _radius(pair, forms, roll_1, roll_2, there):
    """Relative radii of curvature of modified flanks ``(n,)`` [mm].

    It is that of the pitch point where they do not meet, or where their involutes are hollow.
    """
    plain = np.where(there, pair.relative_radius(roll_1, roll_2), 1.0)
    involute = np.where(there & (plain > 0), 1 / np.where(plain > 0, plain, 1.0), 0.0)
    bend = np.where(there, forms[0].bend(roll_1) + forms[1].bend(roll_2), 0.0)
    hollow = (involute > 0) & (involute + bend < involute / FLATTER)
    if hollow.any():
        i = np.flatnonzero(hollow)[0]
        raise ValueError(
            f"the modified flanks conform at roll lengths {roll_1[i]:.5g} and {roll_2[i]:.5g} mm of pinion and wheel: no "
            "line contact there; smooth the table, or lower the amounts"
        )
    return np.where(involute > 0, 1 / np.where(involute > 0, involute + bend, 1.0), pair.pitch_relative_radius)


def _inside(pair, forms, nominal, order, start):
    """Return touching points on the flanks, corners excluded: rolls of both gears and gaps ``(n,)``, inf without contact."""
    pinion = pair.gear_1
    amounts = [form.removed(form.before_edge(np.linspace(form.low, form.high, 65))[None, :]) for form in forms]
    range_ = sum(np.ptp(values, axis=-1) for values in amounts)
    edges = [form.edge.most for form in forms if form.edge is not None]
    if edges:  # A rounded tip is part of the flank and may touch beyond the path. `first_touch` handles sharp corners.
        range_ = range_ + start + EDGE * max(edges)
    shift = forms[0].shift(order) + forms[1].shift(order)
    on_path = [arc_at(pinion, roll) for roll in pair.path]
    low, high = arc_at(pinion, pinion.roll_f) - fillet_length(pinion), arc_at(pinion, pinion.roll_a)
    ends = np.linspace(*pair.path, 9)
    reach = float(np.abs(pair.relative_radius(ends, pair.mate_roll(ends))).max())
    middle = arc_at(pinion, nominal)
    off = np.abs(middle - np.clip(middle, *on_path))
    half = 1.1 * np.sqrt(off**2 + 2 * reach * (range_ + np.abs(shift))) + 1e-3 * pinion.m_n
    if edges:
        half = half + np.abs(nominal - np.clip(nominal, *pair.path))  # Rounded tips slide into the fillet of the mate.
    first, last = np.clip(middle - half, low, high), np.clip(middle + half, low, high)
    roll_0 = np.clip(nominal, *pair.path)
    pose = start + shift + forms[0].removed(forms[0].before_edge(roll_0))
    pose = pose + forms[1].removed(forms[1].before_edge(pair.mate_roll(roll_0)))
    turns = pair.turn(nominal)
    arcs = first[:, None] + (last - first)[:, None] * np.linspace(0, 1, SCAN)
    columns = [turn[:, None] for turn in turns]
    values = _residual(pair, forms, arcs, columns, order[:, None], pose[:, None])
    best = np.argmin(values, axis=1)
    rows = np.arange(nominal.size)
    bounds = arcs[rows, np.maximum(best - 1, 0)], arcs[rows, np.minimum(best + 1, SCAN - 1)]
    roll, gap = roll_0, pose
    for steps in (8, 16):
        arc = _least(lambda s, at=gap: _residual(pair, forms, s, turns, order, at), *bounds, steps)
        roll = roll_at_arc(pinion, arc)
        gap, met, *_ = approach(pair, roll, nominal, start=gap, flanks=forms, order=order)
        gap = np.where(np.isfinite(gap), gap, pose)
        width = (bounds[1] - bounds[0]) / 8
        bounds = np.maximum(arc - width, bounds[0]), np.minimum(arc + width, bounds[1])
    roll, met, gap = _exact(pair, forms, nominal, order, (arc, roll, met, gap))
    on = np.isfinite(met)
    return roll, np.where(on, met, pair.mate_roll(roll)), np.where(on, gap, np.inf)


def _exact(pair, forms, nominal, order, near):
    """Return rolls of both gears and gaps of touching points, from approximate arcs, rolls and gaps `near` them.

    The search locates the point within 1e-6 mm. For smooth flanks this affects only the last digits of the gap, which a
    parabola through three places restores. At a ridge the error is 1e-9 mm. Ridges are therefore evaluated separately, because
    the search may find no contact next to a steep one.
    """
    arc, roll, met, start = near
    least = np.where(np.isfinite(met), start, np.inf)
    step = VERTEX * pair.gear_1.m_n
    sides = [roll_at_arc(pair.gear_1, arc + k * step) for k in (-1, 1)]
    before, after = (approach(pair, at, nominal, start=start, flanks=forms, order=order)[0] for at in sides)
    bend = before - 2 * least + after
    off = np.where(bend > 0, (before - after) / np.where(bend > 0, 2 * bend, 1.0), 0.0)
    at = arc + step * np.clip(np.nan_to_num(off), -1, 1)
    # The abscissa must not exceed the tip.
    tried = [(True, roll_at_arc(pair.gear_1, np.minimum(at, arc_at(pair.gear_1, pair.gear_1.roll_a))))]
    for driver, form in ((True, forms[0]), (False, forms[1])):  # The point just inside each kink is also a candidate.
        tried += [(driver, np.nextafter(kink, (form.low + form.high) / 2)) for kink, _ in form.kinks]
    for driver, at in tried:
        gap, faced, *_ = approach(pair, at, nominal, driver=driver, start=start, flanks=forms, order=order)
        roll_1, roll_2 = (at, faced) if driver else (faced, at)
        host_roll, side = (roll_1, pair.gear_1) if driver else (roll_2, pair.gear_2)
        better = (gap < least) & (side.outward * (side.roll_a - host_roll) >= 0)
        roll, met, least = (np.where(better, *choice) for choice in ((roll_1, roll), (roll_2, met), (gap, least)))
    return roll, met, least


def _residual(pair, forms, arc, turns, order, pose):
    """Return the distance of each place on the pinion flank to the wheel, for gears at `pose` [mm] (inf off the flanks)."""
    roll = roll_at_arc(pair.gear_1, arc)
    forms = [form.of(order) for form in forms]
    back = forms[0].removed(roll) + forms[0].shift(order)
    distance, met, *_ = facing(pair, roll, None, True, turns)(pose / 2 - back)
    # Distance beyond the tip, which directs the search back to the flank.
    away = np.maximum(pair.outward * (met - pair.gear_2.roll_a), 0.0)
    value = back + forms[1].removed(np.where(away > 0, pair.gear_2.roll_a, met)) + forms[1].shift(order) + distance - pose
    return np.where(np.isfinite(distance), value, np.where(np.isfinite(away), OFF + away, np.inf))


def _least(function, low, high, steps):
    """Return the arguments of the least value between the arrays `low` and `high`, by golden section search."""
    a, d = low, high
    b, c = d - GOLDEN * (d - a), a + GOLDEN * (d - a)
    at_b, at_c = function(b), function(c)
    for _ in range(steps):
        left = at_b < at_c
        a, d = np.where(left, a, b), np.where(left, c, d)
        new = np.where(left, d - GOLDEN * (d - a), a + GOLDEN * (d - a))
        value = function(new)
        b, c = np.where(left, new, c), np.where(left, b, new)
        at_b, at_c = np.where(left, value, at_c), np.where(left, at_b, value)
    return np.where(at_b < at_c, b, c)
