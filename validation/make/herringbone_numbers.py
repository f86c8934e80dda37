"""Printed values of article S4 that need no simulation: frequencies, coefficients, masses, counts."""

import math

from gearfe import Pit
from gearfe.flexibility.energy.closed.beam import SAINSOT

from ..shared.simulated import by_name, scene

NAME = "herringbone"


def speeds():
    """Return the frequencies [Hz] of sun, carrier, mesh and fault."""
    sun, ring, run = scene(NAME).gears["sun"].z, scene(NAME).gears["ring"].z, scene(NAME).machine
    turn = run["speed_rpm"] / 60
    carrier = turn / (1 + ring / sun)
    mesh = (turn - carrier) * sun
    return turn, carrier, mesh, run["n_planets"] * mesh / sun


def mesh_frequency():
    """Return the mesh frequency [Hz] by the relative speed of the sun, and by the printed formula with the planet's teeth."""
    turn, carrier, mesh, _ = speeds()
    planet = scene(NAME).gears["planet"].z
    return {
        "(f_s - f_c) z_s": mesh,
        "(f_s - f_c) z_p as printed": (turn - carrier) * planet,
        "f_c z_r": carrier * scene(NAME).gears["ring"].z,
    }


def fault_frequency():
    """Return the fault frequency [Hz] as printed, and the engagement frequency of the damaged tooth."""
    _, _, mesh, fault = speeds()
    run, sun = scene(NAME).machine, scene(NAME).gears["sun"].z
    return {"f_m / (z_s N) as printed": mesh / (sun * run["n_planets"]), "N f_m / z_s": fault}


def periods():
    """Return the periods of sun and fault [s]."""
    turn, _, _, fault = speeds()
    return {"sun": 1 / turn, "fault": 1 / fault}


def mesh_period():
    """Return the printed 60 / (n_1 z_1) divided by the mesh period."""
    turn, _, mesh, _ = speeds()
    return {"60 / (n_1 z_1) as printed": mesh / (turn * scene(NAME).gears["sun"].z)}


def impulses():
    """Return impulses of a damaged sun tooth per revolution of the sun, and per revolution relative to the carrier."""
    turn, carrier, _, fault = speeds()
    return {"turn of the sun": fault / turn, "turn relative to the carrier": fault / (turn - carrier)}


def sainsot():
    """Return the coefficients of the foundation polynomials."""
    names = [f"{row} {column}" for row in ("L", "M", "P", "Q") for column in "ABCDEF"]
    return dict(zip(names, map(float, SAINSOT.ravel()), strict=True))


def masses():
    """Return masses of discs up to the reference circle, 60 mm wide and without bore [kg]."""
    out = {}
    for name in ("sun", "planet"):
        gear = scene(NAME).gears[name]
        out[name] = 7850e-9 * math.pi * gear.r**2 * gear.b
    return out


def inertias():
    """Return moments of inertia of discs of the printed mass up to the reference circle. The ring is a hoop [kg m2]."""
    out = {}
    for name, part in (("sun", 0.5), ("planet", 0.5), ("ring", 1.0)):
        out[name] = part * scene(NAME).machine["bodies"][name][0] * (1e-3 * scene(NAME).gears[name].r) ** 2
    return out


def pit_counts():
    """Return the number of pits of each case in the table of stiffness, from the scene."""
    found = scene(NAME).pairs["sun_planet"].damage
    count = {case: sum(isinstance(one, Pit) for one in found[case]["pinion"]) for case in ("case2", "case4")}
    return {
        "simulated, moderate": count["case2"],
        "measured, moderate": count["case2"],
        "measured, severe": count["case4"],
    }


def measured_range():
    """Return nothing, because the housing is not modelled."""
    return {"healthy, lower": None, "healthy, upper": None}


QUICK = by_name(
    mesh_frequency, fault_frequency, periods, mesh_period, impulses, sainsot, masses, inertias, pit_counts, measured_range,
)  # fmt: skip
