"""Rows of pits along the axis, a contact line or the profile of a flank, in one half or both."""

import math
from dataclasses import replace
from numbers import Integral

import numpy as np

from ..damage.hollow import centre_arc
from ..damage.pit import MOST, Pit
from ..tooth.profile import roll_at_arc
from .lines import Band, bands_of

ALONG = ("axis", "contact_line", "profile")


def pit_line(
    pair, which, along, count, pitch, *, radius, middle, face="helical", groove=0.0, both=False, mirrored=False, **numbers
):
    """Return `count` equal pits along a line of a flank, centred at the point with `radius` and height `middle`.

    A contact line is straight, in the flank and in the plane of action. Over a height dz the pinion's roll length decreases by
    ``tan(beta_b) dz`` away from the end that touches first, and the line is ``dz / cos(beta_b)`` long. Pits of radius r at a
    pitch of 2 r therefore touch each other, on a spur gear exactly. The outer ends of herringbone halves touch first, see
    `bands_of`.

    Parameters
    ----------
    pair : GearPair
    which : {0, 1}
        0: flank of the pinion, 1: flank of the wheel.
    along : {"axis", "contact_line", "profile"}
        ``axis``: at one radius; ``contact_line``: where one tooth pair touches at one phase; ``profile``: at one height.
    count : int
    pitch : float
        Distance of neighbouring centres along the line [mm]: of ``profile`` of the transverse profile's arc.
    radius, middle : float
        Middle of the row: distance from the gear's axis and height [mm], see `Pit`.
    face, groove
        Type of teeth, see `gearfe.geometry.pair.lines.bands_of`. A contact line is that of the half with `middle`.
    both : bool
        If True, its mirror image is in the other half of a herringbone gear too.
    mirrored : bool
        If True, a row along a contact line is inclined the other way, so that contact lines cross it.
    **numbers
        Arguments of `Pit`: axes, depth, angle, tooth, side.

    Returns
    -------
    list of Pit

    Raises
    ------
    ValueError
        If the row is impossible, or a row along a contact line leaves its half. Pits off their flank are rejected when they are
        used with their gear, see `gearfe.geometry.damage.hollow.check_hollows`.

    >>> from gearfe.geometry.tooth.gear import Gear
    >>> from gearfe.geometry.pair.gear_pair import GearPair
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), beta=math.radians(16), b=60.0)
    >>> pair = GearPair(Gear(z=18, r_bore=8.1, **rack), Gear(z=27, r_bore=12.8, **rack))
    >>> row = dict(radius=18.73, middle=15.0, face="herringbone", axes=(0.5, 0.5), depth=0.2)
    >>> [(round(pit.radius, 3), round(pit.z, 3)) for pit in pit_line(pair, 0, "contact_line", 3, 1.0, both=True, **row)]
    [(18.823, 14.034), (18.73, 15.0), (18.64, 15.966), (18.823, 45.966), (18.73, 45.0), (18.64, 44.034)]
    """
    gear = pair.gears[which]
    if along not in ALONG:
        raise ValueError(f"along = {along!r}, but pits lie along one of {', '.join(ALONG)}")
    if isinstance(count, bool) or not isinstance(count, Integral) or not 1 <= count <= MOST:
        raise ValueError(f"count = {count!r} pits in a row, but give a whole number from 1 to {MOST}")
    if count > 1 and not pitch > 0:
        raise ValueError(f"pitch = {pitch} mm, but pits of a row lie apart: give a positive distance of their centres")
    if mirrored and along != "contact_line":
        raise ValueError(f"mirrored with along = {along!r}, but only a row along a contact line can be inclined the other way")
    start = Pit(radius=radius, z=middle, **numbers)
    steps = pitch * (np.arange(count) - (count - 1) / 2) if count > 1 else np.zeros(1)
    radii, heights = np.full(count, float(radius)), middle + steps
    if along == "profile":
        arc = centre_arc(gear, start) + gear.outward * steps[:: gear.outward]
        radii, heights = np.sqrt(gear.r_b**2 + roll_at_arc(gear, arc) ** 2), np.full(count, float(middle))
    elif along == "contact_line":
        radii, heights = _contact_line(pair, which, radius, middle, steps, face, groove, mirrored)
    row = [replace(start, radius=float(r), z=float(z)) for r, z in zip(radii, heights, strict=True)]
    return row + (in_both_halves(gear, row, face) if both else [])


def _contact_line(pair, which, radius, middle, steps, face, groove, mirrored):
    """Radii and heights [mm] of a row along a contact line."""
    gear = pair.gears[which]
    if not radius > gear.r_b:
        raise ValueError(f"pits about radius = {radius:.6g} mm, but contact lines of z = {gear.z} lie beyond {gear.r_b:.6g} mm")
    band = _band(pair, gear, face, groove, middle)
    slope = band.slope * (1 if which == 0 else -pair.outward) * (-1 if mirrored else 1)
    heights = middle + steps * math.cos(gear.beta_b)
    rolls = math.sqrt(radius**2 - gear.r_b**2) + slope * (heights - middle)
    if not (rolls > 0).all() or heights[0] < band.low or heights[-1] > band.high:
        raise ValueError(
            f"a row of {steps.size} pits over {np.ptp(steps):.6g} mm along the contact line leaves the flank of "
            f"z = {gear.z}, or its half of the width: make it shorter, or move its middle"
        )
    return np.hypot(gear.r_b, rolls), heights


def in_both_halves(gear, pits, face):
    """Return pits of a herringbone gear together with their mirror images in the other half."""
    if face != "herringbone":
        raise ValueError(f"{pits[0]._nouns[1]} in both halves, but face = {face!r}: only herringbone gears have halves")
    return [pit.mirrored(gear.b) for pit in pits]


def _band(pair, gear, face, groove, middle):
    """Return the `Band` of the face at height `middle` of a gear, in heights of this gear.

    Roll lengths decrease from the end that touches first.
    """
    below = (gear.b - pair.b_w) / 2  # The mid-planes of both gears coincide.
    for first, last in bands_of(pair, face, groove):
        low, high = sorted((first + below, last + below))
        if low <= middle <= high:
            return Band(low, high, math.copysign(math.tan(pair.gear_1.beta_b), first - last), first + below)
    raise ValueError(f"pits about middle = {middle:.6g} mm, but the teeth of z = {gear.z} have no contact there")
