"""Teeth of a planetary set at one position: mesh phases, tooth numbers and directions of the forces.

The carrier is fixed. Angles are clockwise from +y. The sun drives and rotates clockwise. Planets rotate counter-clockwise, and
the torque on the ring is counter-clockwise. The mesh of sun and planet i is that of `GearPair.turn`, rotated by the planet's
angle. The frame of planet and ring is mirrored, because the planet is the pinion there, and pinions rotate clockwise.

Teeth are numbered clockwise in this frame, by whole numbers that may lie outside 0 ... z - 1. With the sun rotated by
`position` pitches, sun tooth j is in a pair of phase ``position - z_s (angle_i - angle_0) / 2 pi + j``, with planet tooth
``C_i - j``; ring tooth ``D_i - j'`` with planet tooth ``-j'``.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.checks import numbers
from ..geometry.aliases import Floats
from ..geometry.tooth.profile import turned

if TYPE_CHECKING:
    from ..geometry.pair.planetary import PlanetarySet

DIGITS = 9  # number of digits in which the phases of equal planets must agree
FITS = 1e-6  # largest position error of a planet [pitches] at which the set can be assembled


@dataclass(frozen=True, slots=True)
class Standing:
    """Phases ``(positions, planets)`` of tooth 0 of sun (`outer`) and planet (`inner`) in their meshes.

    `planet` and `ring` ``(planets,)`` are C_i and D_i of the module. C_i is the planet tooth that meets tooth 0 of the sun,
    and D_i the ring tooth that meets tooth 0 of the planet.
    """

    outer: Floats
    inner: Floats
    planet: NDArray[np.int64]
    ring: NDArray[np.int64]


def assembled(set_: "PlanetarySet", angles: ArrayLike) -> Floats:
    """Check planet angles and return them [rad].

    ValueError if the teeth do not mesh at these angles, or planets touch. The message gives the nearest possible angles.
    """
    places = numbers("planet_angles", angles, " [rad], one for each planet")
    if places.ndim != 1 or not places.size or not np.isfinite(places).all():
        raise ValueError(f"planet_angles = {angles!r}, but give a finite angle for each planet [rad]")
    step = 2 * math.pi / (set_.sun.z + set_.ring.z)
    away = (places - places[0]) / step
    if (np.abs(away - np.round(away)) > FITS).any():
        fit = np.degrees(places[0] + step * np.round(away)).tolist()
        raise ValueError(
            f"planets at {', '.join(f'{x:.6g}' for x in np.degrees(places))} degrees cannot be assembled: they stand whole "
            f"multiples of 360 / (z_s + z_r) = {math.degrees(step):.6g} degrees apart; nearest: "
            f"{', '.join(f'{x:.6g}' for x in fit)}"
        )
    around = np.sort(places % (2 * math.pi))
    apart = np.diff(np.append(around, around[0] + 2 * math.pi))
    if places.size > 1 and 2 * set_.a * math.sin(min(apart.min(), math.pi) / 2) <= 2 * set_.planet.r_a:
        raise ValueError(f"planets {math.degrees(apart.min()):.4g} degrees apart touch each other: give fewer, or other angles")
    return places


def standing(set_: "PlanetarySet", angles: Floats, position: ArrayLike) -> Standing:
    """Return the `Standing` of a set whose sun is rotated by `position` ``(n,)`` of its pitches.

    At position 0 planet 1 and the sun are at mesh phase 0, with tooth 0 of both; ring tooth 0 is that of the newest pair of
    planet 1 and the ring.
    """
    sun_planet, planet_ring, n = set_.sun_planet, set_.planet_ring, angles.size
    behind = set_.sun.z * (angles - angles[0]) / (2 * math.pi)
    outer = np.atleast_1d(position)[:, None] - behind
    planet = -np.floor(np.round(-behind, DIGITS)).astype(int)
    # rotation of the planet's tooth 0, at position 0
    turn = _turn_2(sun_planet, sun_planet.path[0] + (planet - behind) * sun_planet.p_bt)
    start = planet_ring.gear_1.r_b * (-turn - _turn_1(planet_ring, 0.0))
    inner = (start - planet_ring.path[0]) / planet_ring.p_bt
    at_ring = angles - _turn_2(planet_ring, start)
    pitch = 2 * math.pi / set_.ring.z
    newest = np.floor(np.round(inner[0], DIGITS))  # Pair 0 contains the planet's tooth -newest.
    ring_0 = at_ring[0] + newest * pitch  # Angle of the ring's tooth 0, because planet tooth j' meets ring tooth D - j'.
    number = (at_ring - ring_0) / pitch
    whole = np.round(number)
    if n and np.abs(number - whole).max() > 1e-3:
        raise RuntimeError("the ring's teeth do not fit all planets: an error of the geometry")
    inner = np.atleast_1d(position)[:, None] + inner
    return Standing(np.round(outer, DIGITS), np.round(inner, DIGITS), planet, whole.astype(int))


def _turn_1(pair, nominal):
    """Clockwise angle of the pinion tooth in contact at `nominal` [mm], anywhere on the line of action."""
    middle = pair.gear_1.r_b * math.tan(pair.alpha_wt)
    return pair.turn(middle)[0] + (nominal - middle) / pair.gear_1.r_b


def _turn_2(pair, nominal):
    middle = pair.gear_1.r_b * math.tan(pair.alpha_wt)
    return pair.turn(middle)[1] - pair.outward * (nominal - middle) / pair.gear_2.r_b


def tooth_angles(set_: "PlanetarySet", angles: Floats, stand: Standing) -> tuple[float, Floats, float]:
    """Clockwise angles of tooth 0 of sun, planets ``(planets,)`` and ring [rad] at the first position of `stand`."""
    sun_planet, planet_ring = set_.sun_planet, set_.planet_ring
    sun = angles[0] + _turn_1(sun_planet, sun_planet.path[0] + stand.outer[0, 0] * sun_planet.p_bt)
    planets = angles + _turn_2(sun_planet, sun_planet.path[0] + (stand.outer[0] + stand.planet) * sun_planet.p_bt)
    at_ring = angles[0] - _turn_2(planet_ring, planet_ring.path[0] + stand.inner[0, 0] * planet_ring.p_bt)
    return float(sun), planets, float(at_ring - 2 * math.pi / set_.ring.z * stand.ring[0])


def directions(set_: "PlanetarySet", angles: Floats) -> tuple[Floats, Floats]:
    """Return unit forces ``(2, planets)`` on the planets along x and y, from the sun and from the ring."""
    outer, inner = set_.sun_planet.alpha_wt, -set_.planet_ring.alpha_wt
    return turned((math.cos(outer), math.sin(outer)), angles), turned((math.cos(inner), math.sin(inner)), angles)
