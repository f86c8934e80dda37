"""Printed values of articles S0 and S1 that need no simulation: frequencies, geometry, contact lines."""

import numpy as np

import gearfe as gf
from gearfe.dynamics.machine.contact_law import hertz_coefficient
from gearfe.geometry.damage.pit import Pit
from gearfe.geometry.pair.lines import total_length

from ..shared.simulated import by_name, scene

NAME = "planetary_pitting"
CASES = ("mild", "moderate", "severe")
BINS = 61440 / 307200  # [Hz] bin width of the measured spectra


def stage():
    """Return the pairs sun-planet and planet-ring."""
    return scene(NAME).pairs["sun_planet"], scene(NAME).pairs["planet_ring"]


def speeds():
    """Return the speeds of sun and carrier [rpm], and mesh and fault frequency [Hz]."""
    outer, inner = stage()
    sun, ring = outer.pair.gear_1.z, inner.pair.gear_2.z
    run = scene(NAME).machine
    carrier = run["speed_rpm"] * sun / (sun + ring)
    mesh = (run["speed_rpm"] - carrier) / 60 * sun
    return run["speed_rpm"], carrier, mesh, run["n_planets"] * mesh / sun


def hertz():
    """Return the coefficient K of Hertz's law at the pitch point."""
    outer, _ = stage()
    radii = outer.pair.curvature_radii(outer.pair.pitch_phase)
    return {"sun and planet": hertz_coefficient(float(radii[0]), float(radii[1]), outer.materials)}


def base_radius():
    """Return the base radii."""
    return {name: scene(NAME).gears[name].r_b for name in ("sun", "planet")}


def carrier_speed():
    """Return the carrier speed with a held ring."""
    return {"sun at 1000 rpm": speeds()[1]}


def mesh_frequency():
    """Return the mesh frequency from the contacts of all meshes per time."""
    return {"simulated": speeds()[2]}


def mesh_period():
    """Return the mesh period [s]."""
    return {"simulated": 1 / speeds()[2]}


def fault_frequency():
    """Return the fault frequency, from the planets that a damaged sun tooth meets per revolution relative to the carrier."""
    return {"simulated": speeds()[3]}


def fault_interval():
    """Return the time between two contacts of a damaged sun tooth [s]."""
    return {"simulated": 1 / speeds()[3]}


def measured_lines():
    """Return the bins of the measured spectra that are nearest to carrier and fault frequency at 1000 rpm."""
    return {name: round(value / BINS) * BINS for name, value in (("carrier", speeds()[1] / 60), ("fault", speeds()[3]))}


def ring_shift():
    """Return the profile shift with which planet and ring mesh without backlash at the centre distance of sun and planet."""
    outer, inner = stage()
    run = scene(NAME).machine
    made = gf.PlanetarySet(outer.pair.gear_1, outer.pair.gear_2, inner.pair.gear_2, run["n_planets"], outer.pair.a)
    return {"ring": made.closing_shift()}


def contact_ratio():
    """Return the contact ratio by involute geometry. S0's formula agrees for equal shifts."""
    outer, inner = stage()
    return {"sun and planet": outer.pair.eps_alpha, "planet and ring": inner.pair.eps_alpha}


def lengths(count=400):
    """Return phases, length of all contact lines [mm] by case, and lengths by the formulas of S0 for the same pits.

    In S0 a pit removes the length ``l = sqrt((D/2)**2 - (D/2 - d)**2)``, half of a circle's chord, with the distance d of the
    contact from the pit's edge. N pits remove N l.
    """
    outer, _ = stage()
    pair = outer.pair
    phase = (np.arange(count) + 0.5) / count * (pair.eps_alpha + 0.5) - 0.25
    out = {"healthy": total_length(pair, phase)}
    printed = {}
    for case in CASES:
        pits = outer.damage[case]["pinion"]
        out[case] = total_length(pair, phase, pits=(pits, ()))
        printed[case] = out["healthy"] - sum(_printed_chord(pair, phase, pit) for pit in pits)
    return phase, out, printed


def _printed_chord(pair, phase, pit: Pit):
    """Return l(t) [mm] of one pit by S0. D is the distance along the profile from the pit's edge to the contact."""
    roll = pair.path[0] + phase * pair.p_bt
    arc = (roll**2 + pair.gear_1.r_b**2 - pit.radius**2) / (2 * pair.gear_1.r_b)
    half = pit.axes[0]
    touching = (phase >= 0) & (phase < pair.eps_alpha)
    return np.where(touching, np.sqrt(np.maximum(half**2 - np.minimum(abs(arc), half) ** 2, 0.0)), 0.0)


def line_length():
    """Return the shortest and longest total contact line. With pits, return the shortest."""
    _, ours, _ = lengths()
    out = {"double contact, no pits": ours["healthy"].max(), "single contact, no pits": ours["healthy"].min()}
    return out | {f"{case}, least": ours[case].min() for case in CASES}


QUICK = {"hertz_coefficient": hertz} | by_name(
    base_radius, carrier_speed, mesh_frequency, mesh_period, fault_frequency, fault_interval, measured_lines,
    ring_shift, contact_ratio, line_length,
)  # fmt: skip
