"""The planetary gearbox with a damaged sun tooth: sun drives, ring held, load on the carrier."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from ...core.checks import numbers
from ...core.record import check_keys, ranged
from ...geometry.pair.planetary import PlanetarySet
from .contact_cycle import friction_weights
from .loads import History
from .member import Member, gear_member
from .mesh_curves import Stiffness
from .planetary import (
    HOMES,
    carrier_and_mesh,
    planetary,
    simple_meshes,
    stage_meshes,
    stage_phases,
    teeth_damaged,
    with_stage,
)
from .scene_curves import scene_machine, stage_of
from .tables import Machine


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
    """Build the planetary gearbox with pitted sun teeth (articles on 21/31/84): sun drives, ring held, load on the carrier.

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
        Load against the carrier's rotation [N m] (`machine.loads.pulses`); default: steady, in balance with `torque`.
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
    turn, frequency = carrier_and_mesh(stage, speed)
    phases = stage_phases((outer, inner), n, frequency=frequency)
    hurt = teeth_damaged(damage, stage_meshes(phases))
    fields = {name: phases[name] | {"damage": hurt[name]} | mesh for name in phases}
    if friction is not None:
        check_keys("friction", friction, ("static", "dynamic", "v_static", "v_dynamic"), only=True)
        weights = friction_weights(outer, (speed - turn, -(speed - turn) * sun.z / planet.z), **friction)
        fields |= {name: own | {"rubbing": weights} for name, own in fields.items() if name.startswith("sun")}
    member = {name: gear_member(gear, density, bearing) for name, gear in (("sun", sun), ("planet", planet), ("ring", ring))}
    together, a = n * member["planet"].mass, 1e-3 * stage.a
    member["carrier"] = Member(together, together * a**2, bearing, a)
    member["sun"], member["ring"] = replace(member["sun"], torsion=drive), replace(member["ring"], torsion=100 * drive)
    torque = ranged("torque", torque, " N m")
    load = torque * (1 + ring.z / sun.z) if carrier_torque is None else carrier_torque
    machine = planetary(
        *(member[name] for name in ("sun", "planet", "ring", "carrier")),
        n_planets=n,
        alpha=(outer.alpha_wt, inner.alpha_wt),
        stiffness=stiffness,
        mesh=lambda kind, i: fields[f"{kind}{i + 1}"],
        loads={"sun": torque, "carrier": _against(load)},
        zeta=zeta,
        spin=turn if gyroscopic else 0.0,
    )
    return with_stage(machine, stage, speed)


def scene_planetary(scene, case, **options):
    """Build the machine of a scene with linear contact, with the stiffness curves of its pairs."""
    stage = stage_of(scene)
    return scene_machine(scene, case, options, simple_meshes(stage), HOMES, partial(pitted_planetary, stage))


def _against(value):
    if callable(value):
        return lambda t: -value(t)
    history = isinstance(value, (tuple, list)) or getattr(value, "ndim", 0) == 2
    times, torques = value if history and len(value) == 2 else (None, value)
    torques = -numbers("carrier_torque", torques, " N m")
    return torques if times is None else (times, torques)
