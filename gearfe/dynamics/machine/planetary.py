"""A planetary stage with any number of planets, and the phases of its meshes.

A value that a source does not state is an argument with a default. The docstring calls it an assumption. Stiffnesses are given by
mesh name as anything `gearfe.dynamics.machine.gear_mesh.GearMesh` takes; damage by mesh name as tuples of `ToothDamage`.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.checks import numbers, whole
from ...core.record import check_keys, check_named, ranged
from ...geometry.checks import WrongTypeError, is_whole, shown
from ...geometry.pair.gear_pair import GearPair
from ...geometry.pair.planetary import PlanetarySet
from ...geometry.renamed import renamed
from .gear_mesh import GearMesh
from .layout import Body, Layout, around, outwards, through
from .loads import History, Load
from .member import Member
from .mesh_curves import Stiffness
from .scene_curves import Meshed
from .stages import Stage
from .tables import Machine
from .tooth_damage import ToothDamage

MOST_PLANETS = 100  # limit of the planets in a stage


@renamed(places="planet_angles")
def planetary(
    sun: Member,
    planet: Member | Sequence[Member],
    ring: Member,
    carrier: Member,
    *,
    n_planets: int,
    alpha: tuple[float, float],
    stiffness: Mapping[str, Stiffness],
    mesh: Callable[[str, int], dict[str, Any]] | None = None,
    loads: Mapping[str, History] | None = None,
    zeta: float = 0.0,
    planet_angles: Sequence[float] | None = None,
    spin: float = 0.0,
) -> Machine:
    """Build a planar planetary stage with 3 degrees of freedom per body, in the frame of the carrier.

    The model of J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, in coordinates that do not rotate with the planets. For
    its frequencies see ``tests/dynamics/test_models.py``.

    Parameters
    ----------
    sun, ring, carrier : Member
    planet : Member or sequence of Member
        One for all planets, or one for each.
    n_planets : int
    alpha : (float, float)
        Working pressure angles sun-planet and planet-ring [rad].
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}`` along the line of action [N/m].
    mesh : callable, optional
        ``mesh(kind, i) -> dict`` of further fields of `GearMesh` for planet i. ``rubbing``: weights of the rows of
        `Layout.rubbing`, as `machine.contact_cycle.friction_weights` makes them.
    loads : dict, optional
        Torques ``{"sun": ..., "ring": ..., "carrier": ...}`` [N m]: numbers, histories or functions.
    zeta : float
        Damping ratio of the supports.
    planet_angles : sequence of float, optional
        Angles of the planets [rad]; default: equal spacing from 0.
    spin : float
        Speed of the carrier [rad/s], whose gyroscopic and centripetal terms are then taken in; 0: they are left out.

    Returns
    -------
    Machine
        In SI units and the frame of the carrier: x and y [m] of all bodies along the same axes, theta [rad] counter-clockwise;
        sun, ring, carrier, then the planets.

    Raises
    ------
    ValueError
        If the bodies of the planets or their `planet_angles` are not `n_planets`; if a mass or a moment of inertia is not
        positive, a mesh stiffness or `zeta` is negative or not finite, a load is not finite, the times of a history fall, or a
        field of `GearMesh` is out of range.
    """
    angles = angles_of_planets(n_planets, planet_angles)
    check_keys("stiffness", stiffness, ("sun_planet", "planet_ring"), only=True)
    names = [f"planet{i + 1}" for i in range(n_planets)]
    planets = [planet] * n_planets if isinstance(planet, Member) else list(planet)
    if len(planets) != n_planets:
        raise ValueError(f"planet: {len(planets)} bodies, but n_planets = {n_planets}: give one for all, or one for each")
    central = {"sun": sun, "ring": ring, "carrier": carrier}
    bodies = [Body(name, m.mass, m.inertia) for name, m in central.items()] + [
        Body(n, m.mass, m.inertia) for n, m in zip(names, planets, strict=True)
    ]
    layout, springs, meshes = Layout(bodies), [], []
    for name, m in central.items():
        springs += layout.springs(name, None, {"x": m.bearing, "y": m.bearing, "theta": m.torsion}, zeta)
    for i, (name, angle, member) in enumerate(zip(names, angles, planets, strict=True)):
        arm = carrier.r_b * outwards(angle)
        springs += layout.springs(name, "carrier", {"x": member.bearing, "y": member.bearing}, zeta, arm)
        for kind, body_1, body_2, r, sense, inside in (
            ("sun_planet", "sun", name, (sun.r_b, member.r_b), 1, False),
            ("planet_ring", name, "ring", (member.r_b, ring.r_b), -1, True),
        ):
            place: dict[str, Any] = {"angle": angle, "alpha": alpha[inside], "sense": sense, "internal": inside}
            fields = {} if mesh is None else _fields(mesh(kind, i))
            if weights := fields.pop("rubbing", None):
                fields["friction"] = tuple(zip(layout.rubbing(body_1, body_2, **place), weights, strict=True))
            meshes.append(GearMesh(f"{kind}{i + 1}", layout.mesh(body_1, body_2, radii=r, **place), stiffness[kind], **fields))
    torques = tuple(Load(f"{name} torque", layout.unit(name, "theta"), value) for name, value in (loads or {}).items())
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), torques, spin=spin)


def _fields(given):
    if not isinstance(given, Mapping):
        raise WrongTypeError(f"mesh returns {shown(given)}, but it must return a dict of fields of GearMesh")
    return dict(given)


def angles_of_planets(n_planets: int, planet_angles: Sequence[float] | None = None) -> NDArray:
    """Return the angles of the planets [rad]. They are equally spaced from 0 unless `planet_angles` states them.

    Raises
    ------
    ValueError
        If `n_planets` is no whole number >= 1, or `planet_angles` are not as many finite angles, all of them different.
    """
    whole("n_planets", n_planets, 1, MOST_PLANETS)
    if planet_angles is None:
        return 2 * math.pi * np.arange(n_planets) / n_planets
    angles = numbers("planet_angles", planet_angles, " [rad]")
    if angles.shape != (n_planets,) or not np.isfinite(angles).all():
        raise ValueError(f"planet_angles = {planet_angles!r}, but give {n_planets} finite angles [rad], one for each planet")
    around = np.sort(angles % (2 * math.pi))
    if n_planets > 1 and np.diff(around, append=around[0] + 2 * math.pi).min() < 1e-9:
        raise ValueError(f"planet_angles = {planet_angles!r}, but two planets have the same angle")
    return angles


@renamed(places="planet_angles")
def stage_phases(
    pairs: tuple[GearPair, GearPair],
    n_planets: int,
    *,
    start: float = 0.0,
    frequency: float = 1.0,
    planet_angles: Sequence[float] | None = None,
) -> dict[str, dict[str, Any]]:
    """Return unwrapped phases and first teeth of the meshes of a simple stage whose sun drives counter-clockwise.

    Parameters
    ----------
    pairs : (GearPair, GearPair)
        Sun-planet and planet-ring.
    n_planets : int
    start : float
        Phase of the first sun-planet mesh at t = 0.
    frequency : float
        Mesh frequency, the same for all meshes [Hz].
    planet_angles : sequence of float, optional
        Angles of the planets [rad].

    Returns
    -------
    dict
        By mesh name: fields of `GearMesh` (``frequency, phase, teeth, first``). Sun teeth are numbered in the order in which they
        enter at planet 1, the teeth of each planet in the order they meet the sun from the pair of sun tooth 0 on, ring teeth
        as planet 1 meets them.

    Raises
    ------
    ValueError
        If a planet cannot be assembled at its place: ``z_sun + z_ring`` times its part of a turn is not whole.
    """
    outer, inner = pairs
    sun, planet, ring = outer.gear_1, outer.gear_2, inner.gear_2
    out, angles = {}, angles_of_planets(n_planets, planet_angles).tolist()
    ranged("start", start), ranged("frequency", frequency, " Hz")
    for i, angle in enumerate(angles):
        phase = around(start, sun.z, 1, angle)
        ahead = (sun.z + ring.z) * angle / (2 * math.pi)
        if abs(ahead - round(ahead)) > 1e-9:
            raise ValueError(
                f"planet {i + 1} at {math.degrees(angle):.4g} degrees cannot be assembled: (z_s + z_r) times its part of a "
                "revolution is not a whole number"
            )
        out[f"sun_planet{i + 1}"] = {"phase": phase, "teeth": (sun.z, planet.z)}
        passed = through(phase, outer, inner, -1, -math.pi)
        out[f"planet_ring{i + 1}"] = {"phase": passed, "teeth": (planet.z, ring.z), "first": (0, round(ahead))}
    return {name: fields | {"frequency": frequency} for name, fields in out.items()}


def carrier_and_mesh(stage: PlanetarySet, speed: float) -> tuple[float, float]:
    """Return carrier speed [rad/s] and mesh frequency [Hz] of a stage with fixed ring and the sun driven at `speed` [rad/s]."""
    speed = ranged("speed", speed, " rad/s")
    turn = speed * stage.sun.z / (stage.sun.z + stage.ring.z)
    return turn, (speed - turn) * stage.sun.z / (2 * math.pi)


def with_stage(machine: Machine, stage: PlanetarySet, speed: float, halves: Sequence[str] = ("",), **notes: Any) -> Machine:
    """Return the machine with the `Stage` and the notes of a stage with fixed ring and the sun driven at `speed` [rad/s]."""
    turn, frequency = carrier_and_mesh(stage, speed)
    n, carrier, turning = stage.n_planets, turn / (2 * math.pi), frequency / stage.sun.z
    returns = {"sun": n * turning, "planet": frequency / stage.planet.z, "ring": n * frequency / stage.ring.z}
    driver, follower = (tuple(f"{body}{half}" for half in halves) for body in ("sun", "planet1"))
    only = Stage("stage", driver, follower, frequency, turning, returns["sun"], carrier, returns)
    stated = {
        "mesh frequency [Hz]": frequency,
        "fault frequency of a sun tooth [Hz]": returns["sun"],
        "carrier frequency [Hz]": carrier,
        "phases": {mesh.name: mesh.phase for mesh in machine.meshes},
    }
    return replace(machine, notes=stated | notes, stages=(only,))


def stage_meshes(phases):
    """Return the `Meshed` records of `stage_phases` between the sun, ``planet1`` and so on, and the ring."""
    out = {}
    for name, fields in phases.items():
        kind = name.rstrip("0123456789")
        planet = f"planet{name[len(kind) :]}"
        bodies = ("sun", planet) if kind == "sun_planet" else (planet, "ring")
        out[name] = Meshed(kind, bodies, fields.get("first", (0, 0)))
    return out


def simple_meshes(stage: PlanetarySet) -> dict[str, Meshed]:
    """Return the `stage_meshes` of a stage."""
    return stage_meshes(stage_phases((stage.sun_planet, stage.planet_ring), stage.n_planets))


HOMES = {"sun_planet": ("sun", "planet1"), "planet_ring": ("planet1", "ring")}


def _tooth_number(gear, tooth):
    if not is_whole(tooth):
        raise ValueError(f"damage of {gear!r}: tooth {tooth!r}, but a tooth number is a whole number")
    return int(tooth)


def teeth_damaged(damage, meshes):
    """Return the `ToothDamage` of each of the `meshes` from damage by gear or by mesh.

    Raises
    ------
    ValueError
        If a gear, a mesh, a kind of mesh or a tooth is unknown.
    """
    damage, kinds = dict(damage or {}), {mesh.pair for mesh in meshes.values()}
    bodies = dict.fromkeys(body for mesh in meshes.values() for body in mesh.bodies)
    out = {name: tuple(damage.pop(name, ())) for name in meshes}
    for gear, given in damage.items():
        check_named("damage of", gear, (*bodies, *meshes))
        for tooth, curves in [given] if isinstance(given, tuple) and len(given) == 2 else given:
            number = _tooth_number(gear, tooth)
            for kind, curve in curves.items():
                check_named(f"damage of {gear!r}: mesh", kind, kinds)
                for name, mesh in meshes.items():
                    if mesh.pair == kind and gear in mesh.bodies:
                        out[name] += (ToothDamage(mesh.bodies.index(gear), number, curve),)
    return out
