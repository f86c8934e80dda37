"""The machines of the four scenes, healthy, damaged, stiff and with contact loss, that the pages of the dynamics run."""

import math
from dataclasses import replace

from checks import ellipse_loss
from machines import SHAPE, herringbone, tooth
from usual import HERRINGBONE

import gearfe as gf
from gearfe.dynamics.machine.helical_pair import pitted_helical
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary


def stage(damaged=True, **options):
    """Return the herringbone stage with a cracked sun tooth; synthetic stiffnesses of the size of a half's."""
    damage = {"sun": (0, {"sun_planet": tooth(6e8 * SHAPE, 0.3, 1.5)})} if damaged else None
    return herringbone(HERRINGBONE, damage, **options)


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
