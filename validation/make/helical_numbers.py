"""Printed values of article S3 that need no simulation: frequencies, errors, contact ratios, contact lines."""

from dataclasses import replace

import numpy as np

from gearfe.dynamics.machine.contact_law import hertz_coefficient
from gearfe.geometry.pair.lines import total_length

from ..shared.simulated import by_name, scene

NAME = "helical_pitting"
CASES = ("minor", "severe", "multi")


def pair():
    """Return the gear pair of the scene."""
    return scene(NAME).pair().pair


def frequencies():
    """Return shaft frequency of the pinion and mesh frequency [Hz]."""
    turn = scene(NAME).machine["speed_rpm"] / 60
    return {"f_r": turn, "f_m": turn * pair().gear_1.z}


def theory():
    """Return the values of the article's table."""
    return frequencies()


def measured():
    """Return shaft and mesh frequency at 2500 rpm [Hz]."""
    return frequencies()


def errors_simulated():
    """Return the errors [%] of the article's table, recomputed from its own printed values."""
    return {name: 100 * abs(1 - b / a) for name, a, b in (("f_r", 41.67, 41.62), ("f_m", 708.33, 708.09))}


def errors_measured():
    """Return the errors [%] of the measurement in the same way."""
    return {name: 100 * abs(1 - b / a) for name, a, b in (("f_r", 41.67, 41.23), ("f_m", 708.33, 707.48))}


def one_speed():
    """Return the pinion speeds [rpm] that follow from the printed mesh frequencies and turning frequencies."""
    rows = {"simulated": (41.62, 708.09), "measured": (41.23, 707.48)}
    return {name: mesh / turn / pair().gear_1.z for name, (turn, mesh) in rows.items()}


def impact_period():
    """Return the period of one revolution of the pinion [s]."""
    return {"severe": 1 / frequencies()["f_r"]}


def hertz():
    """Return the coefficient of the impact law at the pitch point, with radii across the contact line."""
    radii = pair().curvature_radii(pair().pitch_phase) / np.cos(pair().gear_1.beta_b)
    return {"pitch point": hertz_coefficient(float(radii[0]), float(radii[1]), scene(NAME).pair().materials)}


def contact_ratios():
    """Return transverse, overlap and total contact ratio."""
    over = pair().eps_beta
    return {"transverse": pair().eps_alpha, "overlap": over, "total": pair().eps_alpha + over}


def line_length():
    """Return the total length of all contact lines over a cycle [mm], and the least length with pits."""
    length = total_length(pair(), np.arange(400) / 400)
    out = {"mean": length.mean(), "least": length.min(), "most": length.max()}
    phase = np.linspace(-0.1, sum(contact_ratios()[name] for name in ("transverse", "overlap")) + 0.1, 1200)
    whole = total_length(pair(), phase)
    for case in CASES:
        pits = scene(NAME).pair().damage[case]["pinion"]
        out[f"{case}, most lost"] = (whole - total_length(pair(), phase, pits=(pits, ()))).max()
    return {name: float(value) for name, value in out.items()}


def lines_of_lost_length(teeth):
    """Return amplitudes at f_r and 2 f_r of the contact line [mm] lost in the case `multi`, with pits on these pinion teeth."""
    count = 64
    pits = [replace(pit, tooth=tooth) for pit, tooth in zip(scene(NAME).pair().damage["multi"]["pinion"], teeth, strict=True)]
    phase = np.arange(17 * count) / count
    lost = total_length(pair(), phase) - total_length(pair(), phase, pits=(pits, ()))
    return 2 * np.abs(np.fft.rfft(lost))[1:3] / lost.size


QUICK = {"hertz_coefficient": hertz} | by_name(
    theory, measured, errors_simulated, errors_measured, one_speed, impact_period, contact_ratios, line_length,
)  # fmt: skip
