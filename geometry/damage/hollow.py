"""Hollows that remove contact: recesses of constant depth along the flank normal, with any outline on one flank.

An outline is described on the flank by u, the arc of the transverse profile from the hollow's centre (towards the tip), and w,
the axial distance from its centre along the tooth trace. A kind of hollow (`Pit`) has `radius, z, depth, tooth, side` and

- `axes`, `angle`: half extents [mm] along the profile and along the width before rotation, and the rotation [rad];
- `reach`: half extents along the profile and along the width [mm];
- ``_contains(u, w)``: whether places are in it. ``span(u)``: the range of w at u. ``crossing(gear, roll, z)``: the part of a
  straight contact line inside it. ``_chord(p, q, dp, dq)``: the part of straight lines inside it, in units of its half extents;
- `kinks`: u and w (two tuples) where its outline is not smooth between its ends. ``_edge()``: its outline;
- ``_contours(centre, axes)``: its outline in space by curves, for `gearfe.geometry.mesh.tetrahedra.tetrahedra`.
"""

import math

import numpy as np

from ..tooth.profile import arc_at, cartesian, flank, flank_arcs, roll_at_arc

PLACES = 65  # points of the flank from which hollows are searched


def centre_arc(gear, hollow):
    """Return the arc length of the hollow's centre [mm], counted as in `gearfe.geometry.tooth.profile.arc_at`."""
    return gear.outward * (hollow.radius**2 - gear.r_b**2) / (2 * gear.r_b)


def crossing(gear, hollow, roll, z, limits):
    """Return the ranges of t (0 to 1) of a straight contact line inside a hollow, from roll lengths and heights [mm] at its ends.

    The place u(v) [mm] is quadratic in ``v = (z - hollow.z) / hollow.reach[1]``, which is between -1 and 1 in the hollow for any
    length of the line. ``limits(u)`` are polynomials in v, of which one is zero wherever the line passes the outline.
    """
    slope, reach = z[1] - z[0], hollow.reach[1]
    change = (roll[1] - roll[0]) / slope
    at, sign = roll[0] + change * (hollow.z - z[0]), gear.outward / (2 * gear.r_b)
    u = np.array([sign * at**2 - centre_arc(gear, hollow), 2 * sign * at * change * reach, sign * (change * reach) ** 2])
    roots = np.concatenate([_roots(limit) for limit in limits(u)])
    places = np.unique([-1.0, *roots[np.abs(roots) < 1], 1.0])
    middles = (places[1:] + places[:-1]) / 2
    covered = hollow._contains(np.polynomial.polynomial.polyval(middles, u), reach * middles)
    parts = []
    for first, last, inside in zip(places[:-1], places[1:], covered, strict=True):
        if inside and parts and parts[-1][1] == first:
            parts[-1][1] = last
        elif inside:
            parts.append([first, last])
    ends = [np.clip((hollow.z + reach * np.array(part) - z[0]) / slope, 0.0, 1.0) for part in parts]
    return [(float(t.min()), float(t.max())) for t in ends if t.max() > t.min()]


def _roots(coefficients):
    """Return real roots of a polynomial, among them all roots between -1 and 1."""
    size = np.abs(coefficients)
    if size[0] > size[1:].sum() or not size.any():
        return np.zeros(0)
    roots = np.polynomial.polynomial.polyroots(coefficients[: np.flatnonzero(size > 1e-15 * size.max())[-1] + 1])
    return roots.real[np.abs(roots.imag) < 1e-9]


def rolls(gear, hollow):
    """Roll lengths [mm] of a hollow's ends nearest the root and nearest the tip, on the involute between form and tip circle."""
    return _at(gear, centre_arc(gear, hollow) + hollow.reach[0] * np.array([-1, 1]))


def _at(gear, arcs):
    """Return roll lengths [mm] of arcs, limited to the involute between form and tip circle."""
    return roll_at_arc(gear, np.clip(arcs, *flank_arcs(gear)))


def breaks(gear, hollow):
    """Return roll lengths [mm] between which the remaining tooth section is a smooth function."""
    return np.concatenate([np.linspace(*rolls(gear, hollow), 7), _at(gear, centre_arc(gear, hollow) + np.array(hollow.kinks[0]))])


def profile(gear, hollow):
    """Return the part of the profile ``(2, n)`` [mm] that a hollow removes, in the frame of its tooth."""
    return cartesian(*flank(gear, np.linspace(*rolls(gear, hollow), 9))) * [[1 if hollow.side == "loaded" else -1], [1]]


def flank_edge(gear, hollow):
    """Heights [mm] and radii [mm] of a hollow's outline."""
    u, w = hollow._edge()
    return hollow.z + w, np.hypot(gear.r_b, roll_at_arc(gear, centre_arc(gear, hollow) + u))


def takes_all(gear, hollow):
    """Return whether a hollow covers its whole flank, so that all four corners are within its outline."""
    u = arc_at(gear, np.array([gear.roll_f, gear.roll_a])) - centre_arc(gear, hollow)
    w = np.array([0.0, gear.b]) - hollow.z
    return bool(hollow._contains(u, w[:, None]).all())


def warning_of(gear, hollow, size):
    """Return a warning for a hollow (of `size`, in words) on its gear. The result is empty if there is none."""
    if not takes_all(gear, hollow):
        return ""
    return (
        f"{hollow._nouns[0]} with {size} mm removes the whole flank of z = {gear.z}: no flank is left to carry load, only the "
        f"{hollow._nouns[0]}'s floor, {hollow.depth:g} mm lower; lengths are in mm"
    )


def warning_together(gear, hollows):
    """Return a warning if several hollows together remove a whole flank.

    The result is empty if not, or if one alone does.
    """
    arcs = arc_at(gear, np.linspace(gear.roll_f, gear.roll_a, PLACES))
    if len(hollows) < 2 or any(takes_all(gear, hollow) for hollow in hollows):
        return ""
    if (union_length(*intervals(gear, hollows, arcs)) < gear.b * (1 - 1e-9)).any():
        return ""
    return (
        f"{len(hollows)} hollows together remove the whole flank of tooth {hollows[0].tooth} of z = {gear.z}: no flank is "
        "left to carry load, only their floors"
    )


def check_hollows(gear, hollows):
    """Raise ValueError for a hollow with its centre off the flank, or as deep as half the tooth at its place.

    Hollows may cross the tip edge and the end faces, and may overlap. Parts below the form circle are not on the flank and are
    ignored.
    """
    for hollow in hollows:
        noun = hollow._nouns[0]
        low, high = sorted((gear.r_form, gear.r_a))
        if not low <= hollow.radius <= high:
            raise ValueError(
                f"{noun} at radius = {hollow.radius:.6g} mm, but the flank of the {gear.z}-tooth gear runs from {low:.6g} to "
                f"{high:.6g} mm: put the {noun}'s centre there"
            )
        if not 0 <= hollow.z <= gear.b:
            raise ValueError(f"{noun} at z = {hollow.z:.6g} mm, but the face is {gear.b:.6g} mm wide: give 0 <= z <= b")
        radius, angle = flank(gear, rolls(gear, hollow)[1])
        half = float(radius * math.sin(angle))
        if hollow.depth >= half:
            raise ValueError(
                f"{noun} of depth = {hollow.depth:.6g} mm, but half the tooth of the {gear.z}-tooth gear is only {half:.6g} mm "
                "thick at its upper end: make it shallower, put it nearer the root, or state a broken tip as a chip"
            )


def intervals(gear, hollows, arc):
    """Return the axial intervals that hollows remove from the flank at profile arcs `arc`.

    Parameters
    ----------
    gear : Gear
    hollows : sequence of Pit
    arc : ndarray
        See `gearfe.geometry.tooth.profile.arc_at` [mm]; nan is off the flank.

    Returns
    -------
    low, high : ndarray, shape (hollows, *arc.shape)
        Ends [mm] within 0..b, equal where the hollow takes nothing.
    """
    arc = np.asarray(arc, dtype=float)
    low, high = np.zeros((2, len(hollows), *arc.shape))
    for k, hollow in enumerate(hollows):
        low[k], high[k] = (np.clip(end, 0, gear.b) for end in hollow.span(arc - centre_arc(gear, hollow)))
    return low, high


def union_length(low, high):
    """Return the length covered by intervals ``[low, high]`` along the first axis. Overlaps are counted once."""
    if len(low) == 0:
        return np.zeros(np.shape(low)[1:])
    order = np.argsort(low, axis=0, kind="stable")
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    before = np.concatenate([low[:1], np.maximum.accumulate(high, axis=0)[:-1]])
    return np.maximum(high - np.maximum(low, before), 0.0).sum(axis=0)


def in_circle(p, q, dp, dq, flat):
    """Return the intervals (t0, t1) in which lines ``(p + t dp, q + t dq)`` lie in the unit circle. t0 == t1 outside.

    Lines with ``dp**2 + dq**2`` below `flat` are points.
    """
    a, half, c = dp * dp + dq * dq, p * dp + q * dq, p * p + q * q - 1
    root = np.sqrt(np.maximum(half * half - a * c, 0.0))
    hit = half * half - a * c > 0
    wall = np.where(a > flat, a, 1.0)
    inside = c < 0
    low = np.where(a > flat, (-half - root) / wall, np.where(inside, -np.inf, 0.0))
    high = np.where(a > flat, (-half + root) / wall, np.where(inside, np.inf, 0.0))
    return np.where(hit, low, 0.0), np.where(hit, high, 0.0)
