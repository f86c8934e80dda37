"""Machines of scenes under the impact law: coefficients from Hertz's theory, pits as lost contact line (articles S0, S1, S3)."""

import math
from dataclasses import replace

import numpy as np

from ...geometry.damage.pit import Pit
from ...geometry.damage.spall import Spall
from ...geometry.pair.lines import contact_lines, lost_length
from ...scene.schema import scene_schema
from .contact_cycle import impact_cycle
from .contact_law import hertz_coefficient
from .helical_pair import pitted_helical
from .loads import pulses
from .pitted_planetary import pitted_planetary
from .scene_curves import pair_backlash, speed_of, stage_of

PULSED = 100.0  # duration of the load pulses on the carrier [s]
PLAY = 1e-4  # backlash [m]


def pits_loss(pair, pits):
    """Return the contact line length [mm] that pits remove from tooth 0 of the pinion, as a function of its phases.

    At phase 0 the line first touches, at one end of the face.
    """
    pits = [replace(pit, tooth=0) for pit in pits]
    early = pair.eps_beta if pair.gear_1.beta > 0 else 0.0

    def lost(phase):
        lines = contact_lines(pair, np.asarray(phase, dtype=float) - early)
        return lost_length(lines, (pits, ()))[:, lines.order == 0, 0].sum(axis=1)

    return lost


def impact_planetary(scene, case):
    """Build the planetary stage of a scene under the impact law, healthy or with pits on a tooth of the sun."""
    chosen = {name: scene.pair(name) for name in ("sun_planet", "planet_ring")}
    if pits_of(chosen["planet_ring"].damage.get(case, {})):
        raise ValueError("the impact law models damage of the sun's flanks only: use contact = 'linear'")
    tooth_pits = pits_of(chosen["sun_planet"].damage.get(case, {}))
    materials = {name: scene_pair.materials for name, scene_pair in chosen.items()}
    stage, machine = stage_of(scene), scene.machine
    options, pair = _options(machine), stage.sun_planet
    stiffness = {"sun_planet": impact_cycle(pair, materials["sun_planet"])}
    stiffness["planet_ring"] = impact_cycle(stage.planet_ring, materials["planet_ring"])
    damage = None
    if tooth_pits:
        loss, width = pits_loss(pair, tooth_pits), pair.b_w
        hurt = impact_cycle(pair, materials["sun_planet"], lost=lambda phase: loss(phase) / width)
        damage = {"sun": (-tooth_pits[0].tooth % stage.sun.z, {"sun_planet": hurt})}
    steady, load = machine["torque_Nm"] * (1 + stage.ring.z / stage.sun.z), None
    if options["pulse_Nm"]:
        period = options["pulse_period_s"]
        load = pulses(
            steady, steady + options["pulse_Nm"], period, options["pulse_width_s"], math.ceil(PULSED / period), start=period
        )
    radii = (float(r) for r in pair.curvature_radii(pair.pitch_phase))
    return pitted_planetary(
        stage, stiffness, damage=damage, speed=speed_of(scene), torque=machine["torque_Nm"], carrier_torque=load,
        friction=_friction(options),
        **_law(options, scene, "sun_planet", hertz_coefficient(*radii, materials["sun_planet"])),
    )  # fmt: skip


def impact_helical(scene, case):
    """Build the helical pair of a scene under the impact law, healthy or with pits on a tooth of the pinion."""
    chosen, machine = scene.pair(), scene.machine
    pair, materials, tooth_pits = chosen.pair, chosen.materials, pits_of(chosen.damage.get(case, {}))
    options = _options(machine)
    for key in ("friction", "pulse_Nm"):
        if options[key]:
            raise ValueError(f"[machine.impact] {key} = {options[key]}: only the model 'planetary' has this key; omit it")
    radii = (float(r) for r in pair.curvature_radii(pair.pitch_phase))
    law = _law(options, scene, next(iter(scene.pairs)), hertz_coefficient(*radii, materials))
    # pits in the order of engagement
    pits = [(-tooth_pits[0].tooth % pair.gear_1.z, pits_loss(pair, tooth_pits))] if tooth_pits else []
    return pitted_helical(
        pair, materials, pits=pits, speed=speed_of(scene), torque=machine["torque_Nm"],
        **{key: law[key] for key in ("damping", "depth", "backlash")},
    )  # fmt: skip


def pits_of(damage):
    """Return the pits on one pinion tooth of a case of damage. The impact law models no other damage.

    Raises
    ------
    ValueError
        If there is other damage.
    """
    pits = list(damage.get("pinion", ()))
    if damage.get("wheel") or not all(isinstance(pit, (Pit, Spall)) for pit in pits) or len({pit.tooth for pit in pits}) > 1:
        raise ValueError("the impact law models damage of one flank of the pinion (sun) only: use contact = 'linear'")
    return pits


def _options(machine):
    return {key.name: key.default for key in scene_schema()["impact"].keys.values()} | (machine.get("impact") or {})


def _law(options, scene, name, coefficient):
    damping = 1e-3 * coefficient if options["damping_Ns_per_mm"] is None else options["damping_Ns_per_mm"]
    depth = {"depth": 1e-3 * options["depth_mm"], "backlash": pair_backlash(scene, name) or PLAY}
    return {"power": 1.5, "push": True, "damping": 1e3 * damping} | depth


def _friction(options):
    if options["friction"] is None:
        return None
    (static, dynamic), (slow, fast) = options["friction"], options["friction_speeds_mm_per_s"]
    return {"static": static, "dynamic": dynamic, "v_static": 1e-3 * slow, "v_dynamic": 1e-3 * fast}
