"""Integrators on the herringbone stage (55 degrees of freedom, 12 meshes): seconds per simulated second against error."""

import math
from importlib.util import find_spec
from pathlib import Path

from . import machine  # first: it sets the number of threads

import numpy as np  # isort: skip

import gearfe as gf  # isort: skip
from gearfe.dynamics import simulate  # isort: skip
from gearfe.export import written  # isort: skip
from gearfe.herringbone import herringbone_planetary  # isort: skip
from gearfe.meshing import Samples, cycle_table  # isort: skip

PAGE = Path(__file__).parent / "dynamics.md"
DURATION = 0.01  # of the comparison; the fast path is timed over one second
WAVE = 1 + 0.15 * np.cos(2 * math.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * math.pi * np.arange(64) / 64)


def stage():
    """The herringbone stage with a cracked sun tooth; synthetic stiffnesses of the size of a half's."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0, "beta": math.radians(16)}
    sun, planet = gf.Gear(z=18, r_bore=8.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.8, tip_radius=0.2, **rack)
    phase = np.arange(-16, 116) / 64
    dip = np.where((phase > 0) & (phase < 1.5), np.sin(math.pi * np.clip(phase / 1.5, 0, 1)) ** 2, 0.0)
    hurt = Samples(phase, cycle_table(6e8 * WAVE)(phase % 1.0) * (1 - 0.3 * dip))
    stiffness = {"sun_planet": 6e8 * WAVE, "planet_ring": 7e8 * WAVE}
    return herringbone_planetary(gf.PlanetarySet(sun, planet, ring, 3), stiffness, damage={"sun": (0, {"sun_planet": hurt})})


def run():
    """Write `dynamics.md` and print it."""
    model = stage()
    want = simulate(model, DURATION, dt=1e-4, method="DOP853", rtol=1e-10)
    lines = [
        "# Integrators on the herringbone stage",
        "",
        f"Made by `python -m validation dynamics` on {machine.describe()}.",
        "55 degrees of freedom, 12 meshes, a damaged sun tooth.",
        "Error: largest of any mesh force over its range, against DOP853 (rtol 1e-10).",
        "",
        "| integrator | seconds per simulated second | error |",
        "|---|---|---|",
    ]
    for compiled in [False, *([True] if find_spec("numba") else [])]:
        name = "fast, numba" if compiled else "fast, numpy"
        simulate(model, DURATION, numba=compiled)  # compile
        for dt in (5e-5, 2.5e-5, 1.25e-5):
            got = simulate(model, DURATION, dt=dt, every=round(1e-4 / dt), numba=compiled)
            seconds = simulate(model, 1.0, dt=dt, numba=compiled).stats["seconds"]
            lines.append(f"| {name}, {1e6 * dt:g} us | {seconds:.3g} | {_error(got, want):.2g} |")
    for method, rtol in (("RK45", 1e-4), ("RK45", 1e-6), ("DOP853", 1e-6), ("LSODA", 1e-4), ("DOP853", 1e-10)):
        got = want if rtol == 1e-10 else simulate(model, DURATION, dt=1e-4, method=method, rtol=rtol)
        lines.append(f"| {method}, rtol {rtol:g} | {got.stats['seconds'] / DURATION:.3g} | {_error(got, want):.2g} |")
    text = "\n".join([*lines, ""])
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)


def _error(got, want):
    forces = want.mesh()
    return float((np.abs(got.mesh() - forces).max(axis=0) / np.ptp(forces, axis=0)).max())
