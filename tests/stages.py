"""The machines of the four scenes, healthy, damaged, stiff and with contact loss, that the pages of the dynamics run."""

import math
from dataclasses import replace

import numpy as np
from checks import ellipse_loss

import gearfe as gf
from gearfe.dynamics.machine.helical_pair import pitted_helical
from gearfe.dynamics.machine.herringbone_planetary import herringbone_planetary
from gearfe.dynamics.machine.mesh_curves import Samples, cycle_table
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary

WAVE = 1 + 0.15 * np.cos(2 * math.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * math.pi * np.arange(64) / 64)


def tooth(curve, loss, eps):
    """Return a damaged tooth's curve: the healthy one less a smooth dip over its engagement."""
    phase = np.arange(-16, math.ceil((eps + 0.25) * 64) + 1) / 64
    dip = np.where((phase > 0) & (phase < eps), np.sin(math.pi * np.clip(phase / eps, 0, 1)) ** 2, 0.0)
    return Samples(phase, cycle_table(curve)(phase % 1.0) * (1 - loss * dip))


MEMBERS = gf.load_scene("herringbone").machine["bodies"]


def stage(damaged=True, **options):
    """Return the herringbone stage with a cracked sun tooth; synthetic stiffnesses of the size of a half's."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0, "beta": math.radians(16)}
    sun, planet = gf.Gear(z=18, r_bore=8.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.8, rack_tip_radius=0.2, **rack)
    stiffness = {"sun_planet": 6e8 * WAVE, "planet_ring": 7e8 * WAVE}
    damage = {"sun": (0, {"sun_planet": tooth(stiffness["sun_planet"], 0.3, 1.5)})} if damaged else None
    return herringbone_planetary(gf.PlanetarySet(sun, planet, ring, 3), stiffness, damage=damage, members=MEMBERS, **options)


def spur(damaged):
    """Return the stage of `planetary_pitting` with curves by `ritz`; a dip of 20 % instead of its pits."""
    scene = gf.load_scene("planetary_pitting")
    pairs = [scene.pairs[name] for name in ("sun_planet", "planet_ring")]
    curves = [gf.mesh_stiffness(one.case(), phases=64, method="ritz") for one in pairs]
    gears = gf.PlanetarySet(pairs[0].pair.gear_1, pairs[0].pair.gear_2, pairs[1].pair.gear_2, 3, pairs[0].pair.a)
    stiffness = dict(zip(("sun_planet", "planet_ring"), curves, strict=True))
    damage = {"sun": (0, {"sun_planet": tooth(curves[0], 0.2, pairs[0].pair.eps_alpha)})} if damaged else None
    speed = scene.machine["speed_rpm"] * math.pi / 30
    return pitted_planetary(gears, stiffness, damage=damage, speed=speed, torque=scene.machine["torque_Nm"], zeta=0.02)


def helical(damaged):
    """Return the pair of S3 with its impact law, and a large pit on one pinion tooth."""
    rack = {"m_n": 2.1, "alpha_n": math.radians(17.5), "beta": math.radians(29)}
    pair = gf.GearPair(gf.Gear(z=17, b=19.8, r_bore=6.0, **rack), gf.Gear(z=60, b=16.9, r_bore=24.0, **rack))
    pits = ((0, ellipse_loss(pair, [(pair.pitch_radius_1, 8.0, 10.0, 2.0)])),) if damaged else ()
    return pitted_helical(pair, (gf.Material(E=210e3, nu=0.278),) * 2, pits=pits)


def compound(damaged):
    """Return the machine of `compound_planetary`, curves by `ritz`, with its crack of 50 %."""
    return gf.build_machine(gf.load_scene("compound_planetary"), "crack50" if damaged else None, phases=64, method="ritz")


def article(case="severe_rows"):
    """Return the planetary stage of S0 under its impact law, with friction and pulses on the carrier."""
    scene = gf.load_scene("planetary_pitting")
    return gf.build_machine(replace(scene, machine=scene.machine | {"contact": "impact"}), case)
