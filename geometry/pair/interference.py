"""Interference: where the outlines of two meshing gears cut into each other."""

import math

import numpy as np

from ..tooth.profile import cartesian, fillet_length, flank, root_curve


def outline(gear, count=60):
    """Half outline of a tooth from tip to root: radius [mm] and angle from the centre-line [rad]."""
    radius_f, angle_f = flank(gear, np.linspace(gear.roll_a, gear.roll_f, count))
    radius_r, angle_r = root_curve(gear, np.linspace(fillet_length(gear), 0.0, count))
    return np.concatenate([radius_f, radius_r[1:]]), np.concatenate([angle_f, angle_r[1:]])


def overlap(pair, nominals):
    """Deepest cut [mm] of either outline into the other, contact flanks included, at some places of the contact.

    Points of the teeth of one gear around the pitch point are looked up in the half thickness of the other's teeth; both
    ways. Without backlash the cut is zero up to rounding. Catches tips in fillets and, for rings, tips in tips.
    """
    gears, centres, mirror = (pair.gear_1, pair.gear_2), (0.0, pair.centre_2), (1, pair.outward)
    outlines, turned = [outline(gear) for gear in gears], np.array(pair.turn(np.asarray(nominals)))
    deepest = 0.0
    for own, other in ((0, 1), (1, 0)):
        gear, mate = gears[own], gears[other]
        radius, half = outlines[own]
        solid_radius, solid_half = outlines[other]
        rising = np.argsort(solid_radius)
        low, high = sorted((mate.r_a, mate.r_f))
        reach = min(gear.z // 2, 8 if not pair.gear_2.internal else pair.gear_1.z // 2)
        teeth, apart = 2 * math.pi / gear.z * np.arange(-reach, reach + 1), centres[own] - centres[other]
        towards = -math.copysign(mate.outward, apart)  # cosine of the angle at which the mate is
        widest = towards * (mate.r_a**2 - radius**2 - apart**2) / (2 * radius * apart)  # its cosine where a point may reach it
        reached = math.cos(min(math.acos(np.clip(widest.min(), -1, 1)) + half.max(), math.pi))
        for turns in turned.T:
            near = teeth[towards * np.cos(turns[own] + mirror[own] * teeth) >= reached]
            shape = (near[:, None, None] + np.array([1, -1])[None, :, None] * half).reshape(-1)
            x, y = cartesian(np.tile(radius, shape.size // radius.size), turns[own] + mirror[own] * shape)
            y = y + apart
            away = np.hypot(x, y)
            near = (away > low) & (away < high)
            angle = mirror[other] * (np.arctan2(x[near], y[near]) - turns[other])
            pitch = 2 * math.pi / mate.z
            inside = np.interp(away[near], solid_radius[rising], solid_half[rising]) - abs(
                (angle + pitch / 2) % pitch - pitch / 2
            )
            deepest = max(deepest, float(np.max(inside * away[near], initial=0.0)))
    return deepest


def radial_assembly(pair):
    """Whether a pinion can be put into its ring by moving it radially (both turned to a tooth in a space).

    The pinion is lowered from its place to the ring's centre in steps; no outline may be cut on the way.
    """
    one, ring = pair.gear_1, pair.gear_2
    radius, half = outline(one)
    solid_radius, solid_half = outline(ring)
    rising = np.argsort(solid_radius)
    teeth = 2 * math.pi / one.z * np.arange(one.z)
    shape = (teeth[:, None, None] + np.array([1, -1])[None, :, None] * half).reshape(-1)
    radii = np.tile(radius, shape.size // radius.size)
    for drop in np.linspace(0, (one.addendum + ring.addendum + 0.5) * one.m_n, 24):
        x, y = cartesian(radii, shape)
        y = y + pair.a - drop
        away = np.hypot(x, y)
        near = (away > ring.r_a) & (away < ring.r_f)
        pitch = 2 * math.pi / ring.z
        angle = np.arctan2(x[near], y[near]) + pitch / 2  # the pinion's tooth 0 stands in a space
        inside = np.interp(away[near], solid_radius[rising], solid_half[rising]) - abs((angle + pitch / 2) % pitch - pitch / 2)
        if np.max(inside * away[near], initial=0.0) > 1e-3 * one.m_n + pair.backlash / 2:
            return False
    return True
