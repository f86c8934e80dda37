"""Transverse outline of one tooth: root arc, trochoid fillet, involute flank, tip arc.

Points are given as radius [mm] and angle from the tooth centre-line [rad]; the centre-line of tooth 0 is +y and the
loaded flank lies at positive angles, which are counted clockwise: ``(X, Y) = R (sin, cos)``.
"""

import math
from functools import lru_cache

import numpy as np
import scipy

from ..kept import keeping
from .involute import inv, inverse_inv


def cartesian(radius, angle):
    """Points ``(2, n)`` [mm] at `radius` [mm] and `angle` [rad], clockwise from +y."""
    return np.array([radius * np.sin(angle), radius * np.cos(angle)])


def turned(points, angle):
    """Points or vectors ``(2, ...)`` or ``(3, ...)`` of x, y and z, rotated clockwise about the z axis by `angle` [rad]."""
    (x, y, *z), cos, sin = points, np.cos(angle), np.sin(angle)
    return np.array([cos * x + sin * y, cos * y - sin * x, *z])


def lengths(points):
    """Lengths ``(n,)`` [mm] along a polyline of points ``(2, n)``, from its start."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=1)))])


def flank(gear, roll):
    """Radius [mm] and angle [rad] of the loaded involute flank at roll length `roll` [mm]."""
    tangent = np.asarray(roll) / gear.r_b
    return np.hypot(roll, gear.r_b), gear.base_half_angle - gear.outward * (tangent - np.arctan(tangent))


def arc_at(gear, roll):
    """Arc length of a place on the flank [mm], increasing from root to tip and zero at the base circle (negative on rings).

    Negative roll lengths denote places in the fillet (`gearfe.geometry.tooth.side`).
    """
    return gear.outward * roll * np.abs(roll) / (2 * gear.r_b)


def flank_arcs(gear):
    """Return the arc lengths of the form point and of the tip along the flank, see `arc_at` [mm]."""
    return arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)


def roll_at_arc(gear, arc):
    """Roll length [mm] at an arc of `arc_at`."""
    square = 2 * gear.r_b * gear.outward * np.asarray(arc)
    return np.sign(square) * np.sqrt(np.abs(square))


def flank_normal(gear, roll):
    """Return the unit vector ``(2, n)`` pointing out of the loaded flank, tangent to the base circle."""
    turn = gear.base_half_angle - gear.outward * np.asarray(roll) / gear.r_b
    return np.array([np.cos(turn), -np.sin(turn)])


def _rack_tip(gear):
    """Centre (xi, eta) of the rack tip rounding in the transverse section, measured from the pitch line [mm]."""
    rho = gear.rack_tip_radius
    xi = math.pi / 4 - (gear.dedendum - rho) * math.tan(gear.alpha_n) - rho / math.cos(gear.alpha_n)
    return max(xi, 0.0) * gear.m_t, (gear.x_E - gear.dedendum + rho) * gear.m_n


def fillet(gear, phi):
    """Radius [mm] and angle [rad] of the generated fillet at rack tip angle `phi` [rad].

    `phi` is the angle of the rack tip's normal in the normal section: alpha_n where the rounding meets the rack
    flank, pi/2 at the root circle. A rack point touches the gear when its normal passes through the pitch point
    (law of gearing); in the transverse section of a helical gear the rounding is an ellipse.
    """
    phi = np.asarray(phi, dtype=float)
    if gear.internal:
        return _shaped_fillet(gear, phi)
    xi_c, eta_c = _rack_tip(gear)
    rho = gear.rack_tip_radius * gear.m_n
    slope = math.cos(gear.beta)
    xi = xi_c + rho * np.cos(phi) / slope
    eta = eta_c - rho * np.sin(phi)
    across = -eta * slope * np.cos(phi) / np.sin(phi)
    rolled = (across - xi) / gear.r
    space = np.arctan2(across, gear.r + eta) - rolled
    return np.hypot(across, gear.r + eta), math.pi / gear.z - space


@lru_cache(maxsize=256)
def _cutter(gear):
    """Return the pinion cutter of a ring: working pressure angle, pitch radii (cutter, ring), place of its tip rounding, radius.

    The cutter has no profile shift and cuts the ring without backlash; its tip reaches the root circle. The radius is at most
    the full rounding of its tip.
    """
    base = gear.r_b * gear.z_cutter / gear.z
    tooth = 2 * gear.x_E * math.tan(gear.alpha_n) / (gear.z - gear.z_cutter) + inv(gear.alpha_t)
    alpha_0 = inverse_inv(tooth)
    pitch, ring = base / math.cos(alpha_0), gear.r_b / math.cos(alpha_0)
    tip = gear.r_f - (ring - pitch)
    if tip <= base:
        raise ValueError(f"z_cutter = {gear.z_cutter}: the cutter's tip lies inside its base circle; use a larger cutter")
    half = math.pi / (2 * gear.z_cutter) + inv(gear.alpha_t)

    def corner(rho):
        """Return the angle of the rounding's centre, which lies on the involute offset inwards by rho."""
        return half - inv(math.acos(min(1.0, base / (tip - rho)))) - rho / base

    rho = gear.rack_tip_radius * gear.m_n
    if corner(rho) < 0:
        if corner(0.0) < 0:
            raise ValueError(f"z_cutter = {gear.z_cutter}: the cutter's teeth are pointed below its tip; lower the dedendum")
        rho = scipy.optimize.brentq(corner, 0.0, rho)
    return alpha_0, pitch, ring, tip - rho, max(corner(rho), 0.0), rho


def cutter_tip_radius(gear):
    """Return the feasible tip radius of a ring's cutter [m_n]."""
    return _cutter(gear)[5] / gear.m_n


def _shaped_fillet(gear, phi):
    """Return the fillet of a ring: envelope of the cutter tip rounding, normal (cos phi, sin phi) through the pitch point."""
    _, pitch, ring, centre, offset, rho = _cutter(gear)
    sin, cos = np.sin(phi), np.cos(phi)
    along = -pitch * sin + np.sqrt(pitch**2 * sin**2 + centre**2 - pitch**2)
    turned = np.arctan2(along * cos, pitch + along * sin) - offset
    x, y = (along + rho) * cos, ring + (along + rho) * sin
    space = np.arctan2(x, y) - turned * pitch / ring
    return np.hypot(x, y), math.pi / gear.z - space


@lru_cache(maxsize=256)
def form_point(gear):
    """Return the point where fillet and involute meet: rack tip angle [rad] and roll length [mm].

    Without undercut they are tangent at ``phi = alpha_n``. When the straight rack flank reaches below the
    interference point, the trochoid cuts the involute and the crossing is found by bisection; at the limit itself
    (z = 17 with a standard rack is slightly beyond it) both results agree.

    Raises
    ------
    ValueError
        If nothing is left of the involute, or the undercut severs the tooth.
    """
    if gear.internal:
        phi = _cutter(gear)[0]
        radius = fillet(gear, phi)[0]
        if radius <= gear.r_a or fillet(gear, math.pi / 2)[1] > math.pi / gear.z:
            raise ValueError(
                f"z = {gear.z}, x = {gear.x}: the fillets overlap and leave no ring flank; lower the rack_tip_radius"
            )
        return phi, float(np.sqrt(radius**2 - gear.r_b**2))
    _, eta_c = _rack_tip(gear)
    depth = -(eta_c - gear.rack_tip_radius * gear.m_n * math.sin(gear.alpha_n))
    phi = gear.alpha_n
    if depth > gear.r * math.sin(gear.alpha_t) ** 2:
        phi = _undercut(gear)
    radius = float(fillet(gear, phi)[0])
    roll = math.sqrt(max(radius**2 - gear.r_b**2, 0.0))
    if radius >= gear.r_a:
        raise ValueError(
            f"z = {gear.z}, x = {gear.x}: undercut removes the whole involute "
            f"(form radius {radius:.5g} mm, tip {gear.r_a:.5g} mm); raise x"
        )
    waist = fillet(gear, np.linspace(phi, math.pi / 2, 200))[1].min()
    if waist <= 0:
        raise ValueError(f"z = {gear.z}, x = {gear.x}: undercut severs the tooth at its root; raise x")
    return phi, roll


def _undercut(gear):
    """Return the rack tip angle at which the trochoid crosses the involute."""

    def excess(phi):
        radius, angle = fillet(gear, phi)
        return float(gear.half_thickness(max(radius, gear.r_b)) - angle)

    if fillet(gear, math.pi / 2)[0] >= gear.r_b:
        return gear.alpha_n
    at_base = scipy.optimize.brentq(lambda phi: float(fillet(gear, phi)[0]) - gear.r_b, gear.alpha_n, math.pi / 2, xtol=1e-15)
    if excess(at_base) <= 0 or excess(gear.alpha_n) >= 0:
        return gear.alpha_n
    return scipy.optimize.brentq(excess, gear.alpha_n, at_base, xtol=1e-15)


def root_half_angle(gear):
    """Half angle [rad] of the tooth at the point where its fillet touches the root circle."""
    return float(fillet(gear, math.pi / 2)[1])


@keeping(256)
def _fillet_arc(gear):
    """Return a fine table of arc length [mm] from the root circle over rack tip angle, for interpolation."""
    phi = np.linspace(math.pi / 2, form_point(gear)[0], 400)
    return phi, lengths(cartesian(*fillet(gear, phi)))


def fillet_length(gear):
    """Arc length of the fillet [mm]."""
    return float(_fillet_arc(gear)[1][-1])


def fillet_arc(gear, phi):
    """Arc length [mm] from the root circle along the fillet at rack tip angle `phi` [rad]."""
    angles, length = _fillet_arc(gear)
    return float(np.interp(-phi, -angles, length))


def fillet_angle(gear, arc):
    """Rack tip angle [rad] at arc lengths [mm] from the root circle along the fillet."""
    phi, length = _fillet_arc(gear)
    return np.interp(arc, length, phi)


def root_curve(gear, arc):
    """Radius [mm] and angle [rad] along root circle (`arc` < 0) and fillet (`arc` > 0), arc lengths [mm] from their joint."""
    arc = np.asarray(arc, dtype=float)
    radius, angle = fillet(gear, fillet_angle(gear, arc))
    return np.where(arc < 0, gear.r_f, radius), np.where(arc < 0, root_half_angle(gear) - arc / gear.r_f, angle)


def _fillet_slope(gear):
    """Return rack tip angles [rad], and decreasing angles of the fillet tangent to the tooth centre-line [rad]."""
    phi = np.linspace(math.pi / 2, form_point(gear)[0], 2001)
    x, y = cartesian(*fillet(gear, phi))
    return (phi[1:] + phi[:-1]) / 2, np.arctan2(-np.diff(x), gear.outward * np.diff(y))


def tangent_range(gear):
    """Least and largest angle [rad] that tangents of the fillet make with the centre-line of the tooth."""
    slope = _fillet_slope(gear)[1]
    return float(slope[-1]), float(slope[0])


def tangent_point(gear, inclination=math.pi / 6):
    """Rack tip angle [rad] at which the fillet tangent makes `inclination` [rad] with the tooth centre-line.

    The point of 30 degrees on an external gear, of 60 degrees on a ring, is the critical section of ISO 6336-3:2019, 6.2. Outside
    of `tangent_range` the end of the fillet nearest to it is returned.
    """
    phi, slope = _fillet_slope(gear)
    return float(np.interp(-inclination, -slope, phi))
