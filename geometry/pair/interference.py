"""Interference of the outlines of two meshing gears."""

import math

import numpy as np

from ..tooth.profile import fillet_length, flank, root_curve


def outline(gear, count=60):
    """Half outline of a tooth from tip to root: radius [mm] and angle from the centre-line [rad]."""
    radius_f, angle_f = flank(gear, np.linspace(gear.roll_a, gear.roll_f, count))
    radius_r, angle_r = root_curve(gear, np.linspace(fillet_length(gear), 0.0, count))
    return np.concatenate([radius_f, radius_r[1:]]), np.concatenate([angle_f, angle_r[1:]])


def overlap(pair, nominals):
    """Return the deepest cut [mm] of one outline into the other at some contact places, contact flanks included.

    Points of the teeth of one gear near the pitch point are compared with the half thickness of the other gear's teeth, and
    vice versa. Without backlash the cut is zero within rounding. The test detects tips in fillets and, for rings, tips in
    tips.
    """
    gears, centres, mirror = pair.gears, (0.0, pair.centre_2), (1, pair.outward)
    outlines, turned = [outline(gear) for gear in gears], np.array(pair.turn(np.asarray(nominals)))
    deepest = 0.0
    for index, mate_index in ((0, 1), (1, 0)):
        gear, mate = gears[index], gears[mate_index]
        radius, half = outlines[index]
        reach = min(gear.z // 2, 8 if not pair.gear_2.internal else pair.gear_1.z // 2)
        teeth, apart = 2 * math.pi / gear.z * np.arange(-reach, reach + 1), centres[index] - centres[mate_index]
        towards = -math.copysign(mate.outward, apart)  # cosine of the direction to the mate, 1 or -1
        # cosine of the angle within which a point may reach the mate
        widest = towards * (mate.r_a**2 - radius**2 - apart**2) / (2 * radius * apart)
        reached = math.cos(min(math.acos(np.clip(widest.min(), -1, 1)) + half.max(), math.pi))
        angle = turned[index][:, None] + mirror[index] * teeth
        pose, tooth = np.nonzero(towards * np.cos(angle) >= reached)
        x, y = _teeth(radius, half, angle[pose, tooth])
        cut = _cut(mate, outlines[mate_index], x, y + apart, turned[mate_index][pose, None], mirror[mate_index])
        deepest = max(deepest, cut)
    return deepest


def radial_assembly(pair):
    """Return whether a pinion can be inserted into its ring radially.

    The pinion is moved in steps from its position to the ring's centre. The outlines must not intersect on the way.
    """
    pinion, ring = pair.gears
    solid, between = outline(ring), -math.pi / ring.z  # The pinion's tooth 0 is in a tooth space of the ring.
    x, y = _teeth(*outline(pinion), 2 * math.pi / pinion.z * np.arange(pinion.z))
    drops = np.linspace(0, (pinion.addendum + ring.addendum + 0.5) * pinion.m_n, 24)
    allowed = 1e-3 * pinion.m_n + pair.backlash / 2
    return all(_cut(ring, solid, x, y + pair.a - drop, between) <= allowed for drop in drops)


def _teeth(radius, half, angle):
    """Points ``(2, teeth, n)`` [mm] of whole teeth at angles ``(teeth,)`` [rad], from the outline of half a tooth."""
    tooth = np.append(radius, radius) * np.exp(1j * np.append(half, -half))
    points = np.exp(1j * angle)[:, None] * tooth
    return points.imag, points.real


def _cut(mate, solid, x, y, turn=0.0, mirror=1):
    """Depth [mm] of points inside the teeth of a rotated gear with the half outline `solid`, or 0 outside."""
    away, pitch, rising = np.hypot(x, y), 2 * math.pi / mate.z, np.argsort(solid[0])
    low, high = sorted((mate.r_a, mate.r_f))
    near = (away > low) & (away < high)
    away, turn = away[near], np.broadcast_to(turn, near.shape)[near]
    angle = (mirror * (np.arctan2(x[near], y[near]) - turn) + pitch / 2) % pitch - pitch / 2
    inside = np.interp(away, solid[0][rising], solid[1][rising]) - abs(angle)
    return float(np.max(inside * away, initial=0.0))
