"""Printed values of article S2 that need no simulation: stiffnesses, frequencies, times, cracks."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.simulated import amplitude, machine, scene, spectrum

NAME = "compound_planetary"
LEVELS = {"10 %": "crack10", "30 %": "crack30", "50 %": "crack50", "70 %": "crack70", "80 %": "crack80"}
# S2 has the Hertzian, bending, shear and axial terms of Liang, and no foundation.
BEAMS = {"root": "prism", "foundation": "none"}
PAIRS = {
    "s1_sun_planet": "sun_planet",
    "s1_ring_planet": "planet_ring_1",
    "s2_sun_planet": "sun_planet",
    "s2_planet_planet": "planet_planet",
    "s2_ring_planet": "planet_ring_2",
}


@cache
def beams(pair, phases=400, span="cycle"):
    """Return the stiffness curve of a pair from the four components of the article."""
    return gf.mesh_stiffness(scene(NAME).pairs[pair].case(), method="textbook", variants=BEAMS, phases=phases, span=span)


def mean_stiffness():
    """Mean over the cycle [N/m]."""
    return {(name, pair): float(beams(pair).k.mean()) for name, pair in PAIRS.items()}


@cache
def converged(pair):
    """Mean stiffness of a pair by the converged energy model [N/m]."""
    return float(gf.mesh_stiffness(scene(NAME).pairs[pair].case(), method="ritz", phases=64).k.mean())


def converged_stiffness():
    """Return the converged mean stiffness of all pairs, with teeth, foundation, contact and neighbouring teeth."""
    return {(name, pair): converged(pair) for name, pair in PAIRS.items()}


def stiffness_ratio():
    """Return the mean stiffness of the pairs by beams, divided by that of sun 2 and its planet."""
    k = {name: float(beams(pair).k.mean()) for name, pair in PAIRS.items()}
    return {name: k[name] / k["s2_sun_planet"] for name in ("s2_planet_planet", "s1_ring_planet", "s2_ring_planet")}


def engaged(curve):
    """Return a mask of the phases at which tooth 0 carries load."""
    return curve.force[:, np.flatnonzero(curve.order == 0)[0]] > 0


def broken_tooth():
    """Return the remaining share of mean stiffness with a broken tooth: beams without its load, and the converged model."""
    curve = beams("sun_planet", span="tooth")
    on, own = engaged(curve), curve.force[:, np.flatnonzero(curve.order == 0)[0]]
    without = curve.k * (1 - own / curve.force.sum(axis=1))
    return {"sudden break": float(without[on].mean() / curve.k[on].mean()), "sudden break, converged model": left("broken")}


@cache
def left(case):
    """Return the mean stiffness of a case over the healthy one, over the engagement of the damaged tooth (energy model)."""
    pair = scene(NAME).pairs["sun_planet"]
    whole, hurt = (gf.mesh_stiffness(pair.case(one), method="ritz", phases=64, span="tooth") for one in (None, case))
    on = engaged(whole)
    return float(np.interp(whole.phase[on], hurt.phase, hurt.k).mean() / whole.k[on].mean())


def frequencies():
    """Return mesh frequencies and fault frequencies of both stages [Hz]."""
    one, two = scene(NAME).pairs["planet_ring_1"].pair, scene(NAME).pairs["planet_ring_2"].pair
    sun, run = scene(NAME).gears["sun"].z, scene(NAME).machine
    ratios = sun / one.gear_2.z, sun / two.gear_2.z
    carrier = run["speed_rpm"] * ratios[1] / sum(ratios)  # (n2 - nc) z_s2 / z_r2 = nc z_s1 / z_r1
    mesh = carrier / 60 * sun, (run["speed_rpm"] - carrier) / 60 * sun
    return mesh, tuple(run["n_planets"] * f / sun for f in mesh)


def of_mesh_lines(one):
    """Return the share of a signal's power in mesh lines. The signal is cut to whole periods of all lines."""
    mesh, (slow, quick) = frequencies()
    step = quick - slow  # All line frequencies are multiples of this difference.
    count = round(one.rate * math.floor(one.values.size / one.rate * step + 1e-6) / step)
    whole = replace(one, values=one.values[:count])
    found, lines = spectrum(whole), {round(n * f, 6) for f in mesh for n in range(1, 141)}
    return sum(amplitude(found, f) ** 2 for f in lines) / 2 / whole.values.var()


def mating_time():
    """Contact ratio over the mesh frequency of stage 2 [s]."""
    return {"sun 2": scene(NAME).pairs["sun_planet"].pair.eps_alpha / frequencies()[0][1]}


def crack_step():
    """Return the length of a 20 % crack [mm] if a 50 % crack reaches the centre-line, by the start of the crack."""
    from gearfe.geometry.damage.crack import crack_path

    sun = scene(NAME).gears["sun"]
    half = sun.r_b * math.sin(sun.base_half_angle)  # The source models the tooth below the base circle as a prism.
    start, tip = crack_path(sun, gf.Crack(level=0.5)).T
    return {
        "from the foot of the article's tooth": 0.4 * half / math.sin(math.radians(45)),
        "from the 30-degree tangent": 0.4 * float(np.hypot(*(tip - start))),
    }


def input_speed():
    """Return the speed of sun 2 from the two printed fault frequencies [rpm]."""
    n = scene(NAME).machine["n_planets"]
    return {"from 16.8 and 18.2 Hz": 60 * (16.8 + 18.2) / n}


def pulse_intervals():
    """Mesh periods [s]."""
    return {f"stage {i + 1}": 1 / f for i, f in enumerate(frequencies()[0])}


def fault_frequencies():
    """Return the fault frequencies N f_m / z_s [Hz]."""
    return {f"sun {i + 1}": f for i, f in enumerate(frequencies()[1])}


def fault_period():
    """Return the fault period [s]."""
    return {"sun 1": 1 / frequencies()[1][0]}


def measured_mesh():
    """Return the mesh frequencies at 700 rpm [Hz]."""
    return {f"stage {i + 1}": f for i, f in enumerate(frequencies()[0])}


def measured_fault():
    """Return the fault frequencies at 700 rpm [Hz]."""
    return fault_frequencies()


def measured_period():
    """Return the fault periods at 700 rpm [s]."""
    return {f"sun {i + 1}": 1 / f for i, f in enumerate(frequencies()[1])}


def measured_speed():
    """Return the input speeds that follow from the measured mesh and fault lines, divided by 700 rpm.

    Both must agree for one record.
    """
    mesh, fault = frequencies()
    return {
        "mesh lines of both stages": (180.6 / mesh[1]) / (167.3 / mesh[0]),
        "fault lines": (17.67 / fault[1]) / (16.23 / fault[0]),
    }


def same_instant():
    """Return whether planet i meets sun 1 and the ring at their pitch points at the same time."""
    phases = machine(NAME, None, "auto").notes["phases"]
    sun, ring = (scene(NAME).pairs[name].pair.pitch_phase for name in ("sun_planet", "planet_ring_1"))
    apart = (phases["p1_ring"] - ring - phases["sun1_p1"] + sun) % 1.0
    return {"stage 1": min(apart, 1 - apart) < 1e-6}


def crack_levels():
    """Return the smallest stiffness over the engagement of a cracked tooth over the healthy one, by level and method."""
    chosen = scene(NAME).pairs["sun_planet"]
    out = {}
    for level, case in LEVELS.items():
        for method, options in (("ritz", {}), ("textbook", {"variants": BEAMS | {"crack_model": "straight"}})):
            run = {"method": method, "phases": 64, "span": "tooth"} | options
            whole = gf.mesh_stiffness(chosen.case(), **run).k
            out[f"{level}, {method}"] = float((gf.mesh_stiffness(chosen.case(case), **run).k / whole).min())
    return out


QUICK = {
    "mean_stiffness": mean_stiffness,
    "converged_stiffness": converged_stiffness,
    "stiffness_ratio": stiffness_ratio,
    "broken_tooth": broken_tooth,
    "mating_time": mating_time,
    "crack_step": crack_step,
    "input_speed": input_speed,
    "pulse_intervals": pulse_intervals,
    "fault_frequencies": fault_frequencies,
    "fault_period": fault_period,
    "measured_mesh": measured_mesh,
    "measured_fault": measured_fault,
    "measured_period": measured_period,
    "measured_speed": measured_speed,
    "same_instant": same_instant,
    "crack_levels": crack_levels,
}
