"""The planetary gearbox with a damaged sun tooth: sun drives, ring held, load on the carrier."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...geometry.pair.planetary import PlanetarySet
from .contact_cycle import friction_weights
from .gear_mesh import Stiffness
from .layout import Body, Layout
from .member import Member, disc
from .planetary import HOMES, planetary, stage_meshes, stage_phases, teeth_damaged
from .scene_curves import scene_curves, speed_of, stage_of
from .tables import History, Machine, Stage


def pitted_planetary(
    stage: PlanetarySet,
    stiffness: Mapping[str, Stiffness],
    *,
    damage: Mapping[str, Any] | None = None,
    speed: float = 1000 * math.pi / 30,
    torque: float = 100.0,
    carrier_torque: History | None = None,
    bearing: float = 1e8,
    drive: float = 1e4,
    density: float = 7800.0,
    zeta: float = 0.02,
    friction: Mapping[str, float] | None = None,
    gyroscopic: bool = False,
    **mesh: Any,
) -> Machine:
    """The planetary gearbox with pitted sun teeth (articles on 21/31/84): sun drives, ring held, load on the carrier.

    Parameters
    ----------
    stage : PlanetarySet
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}``: mesh stiffnesses [N/m], or with ``power=1.5, backlash=...`` coefficients of
        the impact law [N/m^1.5] (`gearfe.dynamics.machine.contact_cycle.impact_cycle`).
    damage : dict, optional
        By gear: ``{"sun": (tooth, {"sun_planet": curve})}``, planets as ``"planet1"`` with curves for both meshes, ``"ring"``; a
        list of such pairs for several teeth. Or by mesh (``"sun_planet1"``) a tuple of `ToothDamage`.
    speed : float
        Speed of the sun [rad/s]; the articles have 1000 rpm.
    torque : float
        Torque on the sun [N m], assumed 100.
    carrier_torque : number, history or function, optional
        Load against the carrier's rotation [N m] (`machine.tables.pulses`); default: steady, in balance with `torque`.
    bearing : float
        Stiffness of every body's bearing in x and in y [N/m], assumed 1e8.
    drive : float
        Torsional stiffness that holds the sun to its motor and the ring to the housing (a hundred times as much) [N m/rad],
        assumed 1e4: the articles prescribe the sun's speed.
    density : float
        [kg/m3]; masses are those of rings from bore to reference circle (rim to reference circle), the carrier's that of
        all planets together (assumed).
    zeta : float
        Damping ratio of supports, assumed 0.02.
    friction : dict, optional
        ``static, dynamic, v_static, v_dynamic`` of Coulomb friction at the sun's meshes (0.08, 0.05, 1e-4, 1e-2 m/s).
    gyroscopic : bool
        Take in the gyroscopic and centripetal terms of the turning carrier.
    **mesh
        Further fields of every `GearMesh`: for the impact law ``power=1.5, push=True, depth=1e-4, damping=..., backlash=...``.

    Returns
    -------
    Machine
        As `planetary` makes it: in SI units and the frame of the carrier.

    Raises
    ------
    ValueError
        If `density` is not positive, a mesh stiffness or `zeta` is negative or not finite, `speed` or a torque is not finite, the
        times of a history fall, the phases of a damaged tooth's curve do not rise, `friction` has not
        ``0 < v_static < v_dynamic``, or a field of `GearMesh` is out of range.
    """
    outer, inner, n = stage.sun_planet, stage.planet_ring, stage.n_planets
    sun, planet, ring = outer.gear_1, outer.gear_2, inner.gear_2
    turn = speed * sun.z / (sun.z + ring.z)
    frequency = (speed - turn) * sun.z / (2 * math.pi)
    phases = stage_phases((outer, inner), n, frequency=frequency)
    hurt = teeth_damaged(damage, stage_meshes(phases))
    phases = {name: fields | {"damage": hurt[name]} for name, fields in phases.items()}
    member = {name: disc(gear, density, bearing) for name, gear in (("sun", sun), ("planet", planet), ("ring", ring))}
    together, a = n * member["planet"].mass, 1e-3 * stage.a
    member["carrier"] = Member(together, together * a**2, bearing, a)
    member["sun"], member["ring"] = replace(member["sun"], torsion=drive), replace(member["ring"], torsion=100 * drive)
    balance = torque * (1 + ring.z / sun.z)
    load = balance if carrier_torque is None else carrier_torque
    machine = planetary(
        *(member[name] for name in ("sun", "planet", "ring", "carrier")),
        n_planets=n,
        alpha=(outer.alpha_w, inner.alpha_w),
        stiffness=stiffness,
        mesh=lambda kind, i: phases[f"{kind}{i + 1}"] | mesh,
        loads={"sun": torque, "carrier": _against(load)},
        zeta=zeta,
        spin=turn if gyroscopic else 0.0,
    )
    notes: dict[str, Any] = {
        "mesh frequency [Hz]": frequency,
        "fault frequency of a sun tooth [Hz]": n * frequency / sun.z,
        "carrier frequency [Hz]": turn / (2 * math.pi),
        "phases": {name: fields["phase"] for name, fields in phases.items()},
    }
    turning = frequency / sun.z
    returns = {"sun": n * turning, "planet": frequency / planet.z, "ring": n * frequency / ring.z}
    only = Stage("stage", ("sun",), ("planet1",), frequency, turning, n * turning, notes["carrier frequency [Hz]"], returns)
    machine = replace(machine, notes=notes, stages=(only,))
    return (
        machine if friction is None else _rubbed(machine, outer, (speed - turn, -(speed - turn) * sun.z / planet.z), friction, n)
    )


def scene_planetary(scene, case, **options):
    """Machine of a scene with linear contact: the stiffness curves of its pairs."""
    stage = stage_of(scene)
    meshes = stage_meshes(stage_phases((stage.sun_planet, stage.planet_ring), stage.n_planets))
    found = scene_curves(scene, case, options, meshes, HOMES)
    settings = {"speed": speed_of(scene), "torque": scene.machine["torque_Nm"]}
    made = pitted_planetary(stage, found.healthy, damage=found.damage, **settings)
    return replace(made, faults=found.faults(made))


def _against(value):
    if callable(value):
        return lambda t: -value(t)
    return -value if np.ndim(value) == 0 else (value[0], -np.asarray(value[1]))


def _rubbed(machine, pair, speeds, friction, n):
    """The machine with Coulomb friction at its sun-planet meshes."""
    layout = Layout([Body(name, 1.0, 1.0) for name in dict.fromkeys(dof.partition(".")[0] for dof in machine.dofs)])
    weights = friction_weights(pair, speeds, **friction)
    meshes = {mesh.name: mesh for mesh in machine.meshes}
    for i in range(n):
        rows = layout.rubbing("sun", f"planet{i + 1}", angle=2 * math.pi * i / n, alpha=pair.alpha_w)
        name = f"sun_planet{i + 1}"
        meshes[name] = replace(meshes[name], friction=tuple(zip(rows, weights, strict=True)))
    return replace(machine, meshes=tuple(meshes.values()))
