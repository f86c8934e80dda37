"""The herringbone planetary stage with its relief groove."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ...core.record import check_keys, ranged
from ...geometry.pair.gear_pair import GearPair
from ...geometry.pair.planetary import PlanetarySet
from .gear_mesh import GearMesh
from .layout import AXES, SPACE, Body, Layout, outwards
from .loads import Load
from .member import gear_member
from .mesh_curves import Stiffness
from .planetary import HOMES, carrier_and_mesh, simple_meshes, stage_meshes, stage_phases, teeth_damaged, with_stage
from .scene_curves import scene_machine, stage_of
from .springs import Spring
from .tables import Machine

WIDEST = 10  # widest relief groove [face widths]
HALVES = {"L": -1, "R": 1}


def herringbone_planetary(
    stage: PlanetarySet,
    stiffness: Mapping[str, Stiffness],
    *,
    damage: Mapping[str, Any] | None = None,
    speed: float = 2000 * math.pi / 30,
    torque: float = 400.0,
    members: Mapping[str, tuple[float, float]] | None = None,
    bearing: float = 1e8,
    tilt: float = 1e5,
    housing: float = 1e9,
    drive: float = 1e4,
    groove: float = 20.0,
    shear_modulus: float = 80e9,
    zeta: float = 0.02,
    mesh_zeta: float = 0.05,
    density: float = 7800.0,
    gyroscopic: bool = False,
    **mesh: Any,
) -> Machine:
    """Build the herringbone stage: 6 degrees of freedom per half of sun and planets and for the ring, one for the carrier.

    The sun drives, the ring is held, and the carrier is the output. With three planets there are 55 degrees of freedom and 12
    meshes. The mesh rows contain the transverse line of action, ``tan(beta_b)`` along the axis with opposite signs in both
    halves, and the tilting moment of the axial force. The article prints ``sin(beta)`` and no tilting.

    Parameters
    ----------
    stage : PlanetarySet
        Helical gears with the width of *one half*.
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}`` of one half [N/m].
    damage : dict, optional
        ``{"sun": (tooth, {"sun_planet": curve})}`` as in `machine.pitted_planetary.pitted_planetary`; in both halves.
    speed, torque : float
        Speed [rad/s] and torque [N m] of the sun: the article has 2000 rpm and 400 N m.
    members : dict, optional
        Masses [kg] and inertias [kg m2] of whole bodies, ``{"sun": (mass, inertia), "planet": ..., "ring": ..., "carrier":
        ...}``; default: rings from bore to reference circle of `density`, the carrier as heavy as its planets (assumed).
        Inertias across the axis are half of those about it (assumed).
    bearing, tilt : float
        Supports of each half of sun and planets [N/m], [N m/rad], assumed 1e8 and 1e5.
    housing : float
        Support of the ring [N/m], assumed 1e9; tilting and turning with it times its squared base radius.
    drive : float
        Torsional stiffness between motor and sun [N m/rad], assumed 1e4 (half of it at each half).
    groove : float
        Width of the relief groove [mm], assumed 20: the halves are joined by a hollow shaft from bore to root circle.
    shear_modulus : float
        Shear modulus of that shaft [Pa]; its Young's modulus is 2.6 times as large.
    zeta, mesh_zeta : float
        Damping ratios of supports and meshes, assumed 0.02 and 0.05.
    density : float
        [kg/m3], assumed 7800.
    gyroscopic : bool
        Take in the gyroscopic moments of sun, planets and ring, which tilt; not what else the turning of the carrier does.
    **mesh
        Further fields of every `GearMesh` (``backlash``: half of the article's dead zone lies on either side of 0 there).

    Returns
    -------
    Machine
        In SI units and the frame of the carrier: x, y, z [m], tilt_x, tilt_y and theta [rad] of the halves ``sunL``, ``sunR``,
        ``planet1L``... and of ``ring``, theta of ``carrier``; axes are the same for all bodies, angles counter-clockwise.

    Raises
    ------
    ValueError
        If a mass, a moment of inertia or `density` is not positive, a mesh stiffness, `zeta` or `mesh_zeta` is negative or not
        finite, `speed` or `torque` is not finite, the phases of a damaged tooth's curve do not rise, or a field of `GearMesh` is
        out of range.
    """
    pairs, n = {"sun_planet": stage.sun_planet, "planet_ring": stage.planet_ring}, stage.n_planets
    check_keys("stiffness", stiffness, pairs, only=True)
    sun, torque = pairs["sun_planet"].gear_1, ranged("torque", torque, " N m")
    layout, apart = _halves(stage, members or _solid(stage, density)), 5e-4 * (sun.b + groove)
    springs = _supports(layout, stage, (bearing, tilt, housing, drive, zeta))
    for name, gear in (("sun", sun), *((f"planet{i + 1}", stage.planet) for i in range(n))):
        springs += _neck(layout, name, gear, (groove, shear_modulus, apart, zeta))
    phases = stage_phases((stage.sun_planet, stage.planet_ring), n, frequency=carrier_and_mesh(stage, speed)[1])
    meshed, meshes, helix = stage_meshes(phases), [], math.tan(abs(sun.beta_b))
    hurt = teeth_damaged(damage, meshed)
    for (name, fields), angle in zip(phases.items(), np.repeat(2 * math.pi * np.arange(n) / n, 2), strict=True):
        kind, bodies, _ = meshed[name]
        # The axial forces of a planet's two meshes balance, because its flanks are parallel.
        sense, height = (1, 0.0) if kind == "sun_planet" else (-1, apart)
        for half, hand in HALVES.items():
            one, two = (body if body == "ring" else f"{body}{half}" for body in bodies)
            row = layout.pair_mesh(one, two, pairs[kind], angle, sense=sense, helix=hand * helix, height=hand * height)
            options = {"zeta": mesh_zeta} | fields | {"damage": hurt[name]} | mesh
            meshes.append(GearMesh(f"{name}{half}", row, stiffness[kind], **options))
    loads = [Load(f"sun{half} torque", layout.unit(f"sun{half}", "theta"), torque / 2) for half in HALVES]
    loads.append(Load("carrier torque", layout.unit("carrier", "theta"), -torque * (1 + stage.ring.z / sun.z)))
    rotors = _rotors(layout, stage, speed) if gyroscopic else {}
    machine = Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), tuple(loads), rotors=rotors)
    overlap = {"overlap ratio of one half": pairs["sun_planet"].eps_beta_of(sun.b)}
    return with_stage(machine, stage, speed, tuple(HALVES), **overlap)


def _rotors(layout, stage, speed):
    """Return the angular velocities of the bodies that tilt, relative to the carrier [rad/s].

    A body that rotates at w relative to the ground has the gyroscopic term ``J_p w``. The frame that rotates at W subtracts
    ``2 J_t W``. These bodies have ``J_p = 2 J_t``, so that ``J_p (w - W)`` remains.
    """
    turn, _ = carrier_and_mesh(stage, speed)
    speeds = {"sun": speed - turn, "planet": -(speed - turn) * stage.sun.z / stage.planet.z, "ring": -turn}
    return {body: speeds[body.rstrip("LR0123456789")] for body in layout.bodies if body != "carrier"}


def scene_herringbone(scene, case, **options):
    """Build the machine of a scene, with the stiffness curves of halves of its pairs and the bodies that the scene states."""
    halves = {}
    for name, scene_pair in scene.pairs.items():
        width = (scene_pair.pair.b_w - scene_pair.groove) / 2
        gears = (replace(gear, b=width) for gear in scene_pair.pair.gears)
        halves[name] = replace(
            scene_pair, pair=GearPair(*gears, scene_pair.pair.a), force=scene_pair.force / 2, face="helical", groove=0.0
        )
    half = replace(scene, pairs=halves)
    stage = stage_of(half)
    build = partial(herringbone_planetary, stage, members=scene.machine.get("bodies") or None)
    return scene_machine(half, case, options, simple_meshes(stage), HOMES, build)


def _solid(stage, density):
    """Return masses and inertias of whole bodies from gears that consist of two halves."""
    gears = {"sun": stage.sun, "planet": stage.planet, "ring": stage.ring}
    discs = {name: gear_member(gear, density, 0.0, width=2 * gear.b) for name, gear in gears.items()}
    out = {name: (member.mass, member.inertia) for name, member in discs.items()}
    together = stage.n_planets * out["planet"][0]
    return out | {"carrier": (together, together * (1e-3 * stage.a) ** 2)}


def _halves(stage, members):
    names = ["sun", *(f"planet{i + 1}" for i in range(stage.n_planets))]
    bodies = []
    for name in names:
        mass, inertia = (value / 2 for value in members[name.rstrip("0123456789")])
        bodies += [Body(f"{name}{half}", mass, inertia, SPACE, inertia / 2) for half in HALVES]
    mass, inertia = members["ring"]
    bodies.append(Body("ring", mass, inertia, SPACE, inertia / 2))
    bodies.append(Body("carrier", *members["carrier"], "theta"))
    return Layout(bodies)


def _supports(layout, stage, options):
    """Return the springs of sun, planets and ring to ground or carrier."""
    bearing, tilt, housing, drive, zeta = options
    moves = dict.fromkeys("xyz", bearing) | {"tilt_x": tilt, "tilt_y": tilt}
    out = []
    for half in HALVES:
        out += layout.springs(f"sun{half}", None, moves | {"theta": drive / 2}, zeta)
        for i in range(stage.n_planets):
            angle = 2 * math.pi * i / stage.n_planets
            arm = 1e-3 * stage.a * outwards(angle)
            out += layout.springs(f"planet{i + 1}{half}", "carrier", moves, zeta, arm)
    turn = housing * (1e-3 * stage.ring.r_b) ** 2
    return out + layout.springs("ring", None, dict.fromkeys("xyz", housing) | dict.fromkeys(SPACE.split()[3:], turn), zeta)


def _neck(layout, name, gear, options):
    """Return the springs of the hollow shaft under the relief groove, between the faces of both halves."""
    width, G, apart, zeta = options
    width, G = ranged("groove", width, " mm", above=0.0), ranged("shear_modulus", G, " Pa", above=0.0)
    if width > WIDEST * gear.b:
        raise ValueError(f"groove = {width:g} mm, but give at most {WIDEST * gear.b:g} mm, {WIDEST} face widths")
    outer, inner, length = 1e-3 * gear.r_f, 1e-3 * gear.r_bore, 1e-3 * width
    area, second = math.pi * (outer**2 - inner**2), math.pi / 4 * (outer**4 - inner**4)
    bend = 2.6 * G * second / length
    sizes = {"x": 0.9 * G * area / length, "z": 2.6 * G * area / length, "tilt_x": bend, "theta": 2 * G * second / length}
    sizes |= {"y": sizes["x"], "tilt_y": bend}
    out = []
    for dof, k in sizes.items():
        if dof in AXES:
            row = layout.point(f"{name}L", AXES[dof], (0, 0, apart)) - layout.point(f"{name}R", AXES[dof], (0, 0, -apart))
        else:
            row = layout.unit(f"{name}L", dof) - layout.unit(f"{name}R", dof)
        out.append(Spring(f"{name} groove {dof}", row, k, 2 * zeta * math.sqrt(k / (row**2 / layout.mass).sum())))
    return out
