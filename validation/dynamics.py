"""Integrators on the herringbone stage: seconds per simulated second against error; the fast path on all scenes' machines."""

import math
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from . import machine  # first: it sets the number of threads

import numpy as np  # isort: skip

import gearfe as gf  # isort: skip
from gearfe.dynamics import default_step, simulate  # isort: skip
from gearfe.export import written  # isort: skip
from gearfe.herringbone import herringbone_planetary, pitted_helical  # isort: skip
from gearfe.meshing import Samples, cycle_table  # isort: skip
from gearfe.models import pitted_planetary  # isort: skip

PAGE = Path(__file__).parent / "dynamics.md"
DURATION = 0.01  # of the comparison; the fast path is timed over one second
WAVE = 1 + 0.15 * np.cos(2 * math.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * math.pi * np.arange(64) / 64)

HEAD = [
    "",
    "## The four machines",
    "",
    "Fast path (numpy) against DOP853 (rtol 1e-10) from rest, over about three mesh cycles: largest error of a displacement",
    "over the largest range of a displacement of its kind (translation, rotation) / of a mesh force over its range, at the",
    "default step, its half and its quarter. Curves of the spur stages by `ritz`; a damaged tooth loses 20 % of the stiffness",
    "(planetary), is cracked to 50 % (compound), has a pit of 10 by 2 mm under the impact law (helical), or loses 30 %.",
    "At the default step not all machines stay below 1e-3: for mesh forces of light planets give `dt`, and look at `error=True`.",
    "",
    "| machine | default step, us | default | half | quarter |",
    "|---|---|---|---|---|",
]


def tooth(curve, loss, eps):
    """A damaged tooth's curve: the healthy one less a smooth dip over its engagement."""
    phase = np.arange(-16, math.ceil((eps + 0.25) * 64) + 1) / 64
    dip = np.where((phase > 0) & (phase < eps), np.sin(math.pi * np.clip(phase / eps, 0, 1)) ** 2, 0.0)
    return Samples(phase, cycle_table(curve)(phase % 1.0) * (1 - loss * dip))


def stage(damaged=True, **options):
    """The herringbone stage with a cracked sun tooth; synthetic stiffnesses of the size of a half's."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0, "beta": math.radians(16)}
    sun, planet = gf.Gear(z=18, r_bore=8.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.8, tip_radius=0.2, **rack)
    stiffness = {"sun_planet": 6e8 * WAVE, "planet_ring": 7e8 * WAVE}
    damage = {"sun": (0, {"sun_planet": tooth(stiffness["sun_planet"], 0.3, 1.5)})} if damaged else None
    return herringbone_planetary(gf.PlanetarySet(sun, planet, ring, 3), stiffness, damage=damage, **options)


def spur(damaged):
    """The stage of `planetary_pitting` with curves by `ritz`; a dip of 20 % instead of its pits."""
    scene = gf.load_scene("planetary_pitting")
    pairs = [scene.pairs[name] for name in ("sun_planet", "planet_ring")]
    curves = [gf.mesh_stiffness(**one.case(), phases=64, method="ritz") for one in pairs]
    gears = gf.PlanetarySet(pairs[0].pair.gear_1, pairs[0].pair.gear_2, pairs[1].pair.gear_2, 3, pairs[0].pair.a)
    stiffness = dict(zip(("sun_planet", "planet_ring"), curves, strict=True))
    damage = {"sun": (0, {"sun_planet": tooth(curves[0], 0.2, pairs[0].pair.eps_alpha)})} if damaged else None
    speed = scene.machine["speed_rpm"] * math.pi / 30
    return pitted_planetary(gears, stiffness, damage=damage, speed=speed, torque=scene.machine["torque_Nm"], zeta=0.02)


def helical(damaged):
    """The pair of S3 with its impact law, and a large pit on one pinion tooth."""
    rack = {"m_n": 2.1, "alpha_n": math.radians(17.5), "beta": math.radians(29)}
    pair = gf.GearPair(gf.Gear(z=17, b=19.8, r_bore=6.0, **rack), gf.Gear(z=60, b=16.9, r_bore=24.0, **rack))
    pits = ((0, [(pair.pitch_radius_1, 8.0, 10.0, 2.0)]),) if damaged else ()
    return pitted_helical(pair, (gf.Material(E=210e3, nu=0.278),) * 2, pits=pits)


def compound(damaged):
    """The machine of `compound_planetary`, curves by `ritz`, with its crack of 50 %."""
    return gf.build_machine(gf.load_scene("compound_planetary"), "crack50" if damaged else None, phases=64, method="ritz")


def stiff(made, factor=100.0):
    """The machine with all its springs so many times stiffer, at the same damping ratios."""
    return replace(made, springs=tuple(replace(s, k=factor * s.k, c=math.sqrt(factor) * s.c) for s in made.springs))


def machines():
    """(name, machine, duration [s] of about three mesh cycles) of all four scenes."""
    for name, made, duration in (
        ("planetary_pitting", spur, 0.008),
        ("compound_planetary", compound, 0.008),
        ("helical_pitting", helical, 0.004),
        ("herringbone", stage, 0.005),
    ):
        for case in (False, True):
            yield f"{name}, {'damaged' if case else 'healthy'}", made(case), duration
    yield "planetary_pitting, damaged, supports 100 times stiffer", stiff(spur(True)), 0.003
    yield "herringbone, healthy, bearings 100 times stiffer", stage(False, bearing=1e10, tilt=1e7), 0.003


def accuracy():
    """Rows: errors of the fast path against DOP853 (rtol 1e-10) at the default step, its half and its quarter."""
    for name, made, duration in machines():
        steps = math.ceil(duration / default_step(made) / 4) * 4
        want = simulate(made, duration, dt=4 * duration / steps, method="DOP853", rtol=1e-10)
        cells = []
        for finer in (1, 2, 4):
            got = simulate(made, duration, dt=duration / steps / finer, every=4 * finer, numba=False)
            cells.append(f"{_moved(got, want):.1e} / {_error(got, want):.1e}")
        yield f"| {name} | {1e6 * duration / steps:.1f} | {' | '.join(cells)} |"


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
    lines += HEAD
    for row in accuracy():
        lines.append(row)
        print(row, flush=True)
    text = "\n".join([*lines, ""])
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)


def _error(got, want):
    forces = want.mesh()
    return float((np.abs(got.mesh() - forces).max(axis=0) / np.ptp(forces, axis=0)).max())


def _moved(got, want):
    """Largest error of a displacement over the largest range of its kind."""
    away, size = np.abs(got.q - want.q).max(axis=0), np.ptp(want.q, axis=0)
    turns = np.array([name.endswith(("theta", "tilt_x", "tilt_y")) for name in want.machine.dofs])
    return float(max(away[kind].max() / size[kind].max() for kind in (turns, ~turns)))
