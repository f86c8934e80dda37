"""Integrators: seconds per simulated second against error; the fast path at its own step on all scenes' machines."""

import math
import time
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import gearfe as gf
from gearfe.files import written
from gearfe.machine.gear_mesh import Samples, cycle_table
from gearfe.machine.helical_pair import pitted_helical
from gearfe.machine.herringbone_planetary import herringbone_planetary
from gearfe.machine.pitted_planetary import pitted_planetary
from gearfe.motion import excitation
from gearfe.motion.response import acceleration
from gearfe.motion.simulate import simulate

from ..shared import machine
from ..shared.places import PAGES
from ..shared.speed_page import save

PAGE = PAGES / "dynamics.md"
DURATION = 0.01  # of the comparison; the fast path is timed over one second
WAVE = 1 + 0.15 * np.cos(2 * math.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * math.pi * np.arange(64) / 64)

RATES = (2e3, 5e3, 1e4, 2.5e4, 5e4)  # of the output [Hz]; the last holds all others

HEAD = [
    "",
    "## The step that `simulate` chooses",
    "",
    "Without `step` the fast path halves its step on a short stretch until two runs agree; where contact is lost, whole runs.",
    "Here against DOP853 (rtol 1e-10) between located changes of contact, from rest, over about three mesh cycles, at five",
    "output rates, 2 to 50 kHz: the largest error of a displacement over the largest range of a displacement of its kind",
    '(translation, rotation), and of a mesh force over its range; and the estimate, `stats["error"]`, of the larger of both.',
    "Wanted: 1e-3, with contact loss 1e-2, and the error below the estimate in 95 of 100 runs. Curves of the spur stages by",
    "`ritz`; a damaged tooth loses 20 % of the stiffness (planetary), is cracked to 50 % (compound), has a pit of 10 by 2 mm",
    "under the impact law (helical), or loses 30 % (herringbone). Contact is lost to errors of 40 um with 0.1 mm of play.",
    "",
    "| machine | steps, us | estimates | largest displacement error | largest force error | covered | losses of contact |",
    "|---|---|---|---|---|---|---|",
]
CHATTER = [
    "",
    "## A chattering stage, with and without located changes",
    "",
    "`planetary_pitting`, severe, 0.1 mm of play, errors of 40 um, 30 ms: largest error of any mesh force over its range, and",
    "of any displacement over that of its kind, against DOP853 (rtol 1e-12) between located changes of contact. An earlier",
    "trial, on an earlier machine and without located changes, had 18.5 % at rtol 1e-8 and 5.9 % at 1e-10.",
    "",
    "| integrator | force | displacement | losses of contact |",
    "|---|---|---|---|",
]
SPEED = [
    "",
    "## Speed at that step",
    "",
    "Seconds of one processor per simulated second, the choice of the step and the outputs included, damaged tooth, best of",
    "three; numpy: without numba, over 0.1 s, with the impact law 0.02 s, of which most goes into choosing the step. Wanted:",
    "0.1 with numba and 1.5 without (herringbone), 0.1 (compound), 1 s for 10 s (planetary, 0.1 per second), and 1 s for the",
    "impact law of the planetary stage.",
    "",
    "| machine | step, us | estimate | numba | numpy |",
    "|---|---|---|---|---|",
]


def tooth(curve, loss, eps):
    """A damaged tooth's curve: the healthy one less a smooth dip over its engagement."""
    phase = np.arange(-16, math.ceil((eps + 0.25) * 64) + 1) / 64
    dip = np.where((phase > 0) & (phase < eps), np.sin(math.pi * np.clip(phase / eps, 0, 1)) ** 2, 0.0)
    return Samples(phase, cycle_table(curve)(phase % 1.0) * (1 - loss * dip))


MEMBERS = gf.load_scene("herringbone").machine["bodies"]


def stage(damaged=True, **options):
    """The herringbone stage with a cracked sun tooth; synthetic stiffnesses of the size of a half's."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0, "beta": math.radians(16)}
    sun, planet = gf.Gear(z=18, r_bore=8.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.8, tip_radius=0.2, **rack)
    stiffness = {"sun_planet": 6e8 * WAVE, "planet_ring": 7e8 * WAVE}
    damage = {"sun": (0, {"sun_planet": tooth(stiffness["sun_planet"], 0.3, 1.5)})} if damaged else None
    return herringbone_planetary(gf.PlanetarySet(sun, planet, ring, 3), stiffness, damage=damage, members=MEMBERS, **options)


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


def shaken(made, amplitude=40e-6):
    """The machine with play and errors that open every mesh."""
    meshes = [
        replace(m, backlash=1e-4, zeta=0.05, error=((amplitude, 5 * m.frequency, 1.3 * i),)) for i, m in enumerate(made.meshes)
    ]
    return replace(made, meshes=tuple(meshes))


def article(case="severe"):
    """The planetary stage of S0 under its impact law, with friction and pulses on the carrier."""
    scene = gf.load_scene("planetary_pitting")
    return gf.build_machine(replace(scene, machine=scene.machine | {"contact": "impact"}), case)


def machines():
    """(name, machine, duration [s] of about three mesh cycles) of all four scenes."""
    kinds = (("planetary_pitting", spur, 0.008), ("compound_planetary", compound, 0.008))
    kinds += (("helical_pitting", helical, 0.004), ("herringbone", stage, 0.005))
    for name, made, duration in kinds:
        for case in (False, True):
            yield f"{name}, {'damaged' if case else 'healthy'}", made(case), duration
    for name, made, duration in kinds:
        yield f"{name}, damaged, springs 100 times stiffer", stiff(made(True)), duration / 2
    for name, made, duration in (kinds[0], kinds[1], kinds[3]):
        for case in (False, True):
            yield f"{name}, {'damaged' if case else 'healthy'}, contact loss", shaken(made(case)), duration / 2
    yield "planetary_pitting, impact law, healthy", article(None), 0.004
    yield "planetary_pitting, impact law, friction, pulses", article(), 0.004


def accuracy():
    """Rows: errors of the fast path at its own steps against DOP853 (rtol 1e-10), at all rates; last how many were covered."""
    runs, covered = 0, 0
    for name, made, duration in machines():
        want = simulate(made, duration, rate=RATES[-1], method="DOP853", rtol=1e-10)
        steps, doubts, moved, pushed, inside, lost = [], [], [], [], 0, set()
        for rate in RATES:
            got, every = simulate(made, duration, rate=rate), round(RATES[-1] / rate)
            thin = replace(want, time=want.time[::every], states=want.states[::every])
            moved.append(_moved(got, thin, want))
            pushed.append(_error(got, thin, want))
            steps.append(1e6 * got.stats.get("dt", math.nan))
            doubts.append(got.stats["error"])
            inside += max(moved[-1], pushed[-1]) <= doubts[-1]
            lost.add(got.stats.get("losses", 0))
        runs, covered = runs + len(RATES), covered + inside
        spans = f"{min(steps):.2g} to {max(steps):.2g} | {min(doubts):.1e} to {max(doubts):.1e}"
        losses = " or ".join(map(str, sorted(lost)))
        yield f"| {name} | {spans} | {max(moved):.1e} | {max(pushed):.1e} | {inside} of {len(RATES)} | {losses} |"
    yield ""
    yield f"Covered: {covered} of {runs} runs, {100 * covered / runs:.0f} %."


def chatter():
    """Rows: the chattering stage by the fast path, and by DOP853 with and without located changes of contact."""
    made = shaken(gf.build_machine(gf.load_scene("planetary_pitting"), "severe"))
    span, rate = 0.03, 5e4
    want = simulate(made, span, rate=rate, method="DOP853", rtol=1e-12)
    fast = simulate(made, span, rate=rate)
    runs = {f"fast, step chosen, estimate {fast.stats['error']:.1e}": fast}
    for rtol in (1e-8, 1e-10):
        runs[f"DOP853, rtol {rtol:g}, located changes"] = simulate(made, span, rate=rate, method="DOP853", rtol=rtol)
        runs[f"DOP853, rtol {rtol:g}, changes not located"] = _plain(made, want, rtol)
    for name, got in runs.items():
        yield f"| {name} | {_error(got, want):.1e} | {_moved(got, want):.1e} | {got.stats.get('losses', '')} |"


def _plain(made, like, rtol):
    """A run of scipy's method through all changes of contact, as if the forces were smooth."""
    flat, n = excitation.flatten(made, like.time), len(made.dofs)
    scale = np.abs(like.states).max(axis=0)

    def rate(t, y):
        u = y * scale
        a = acceleration(made, flat, np.asarray(t), u[:n], u[n:])
        return np.concatenate([u[n:], a]) / scale

    options = {"method": "DOP853", "rtol": rtol, "atol": 1e-3 * rtol, "t_eval": like.time}
    found = solve_ivp(rate, (0.0, like.time[-1]), like.states[0] / scale, **options)
    return replace(like, states=(found.y * scale[:, None]).T, stats={})


def speeds():
    """Rows: seconds of the processor per simulated second, with and without numba."""
    for name, made, duration in (
        ("herringbone, 55 degrees of freedom", stage(True), 1.0),
        ("compound_planetary, 39", compound(True), 1.0),
        ("planetary_pitting, 18", spur(True), 10.0),
        ("helical_pitting, 8, impact law", helical(True), 1.0),
        ("planetary_pitting, 18, impact law, friction, pulses", article(), 1.0),
    ):
        cells = []
        for compiled in (*([True] if find_spec("numba") else []), False):
            length = duration if compiled else min(duration / 10, 0.02 if "impact" in name else 0.1)
            taken = []
            for _ in range(4 if compiled else 1):  # the first run compiles
                started = time.process_time()
                got = simulate(made, length, numba=compiled)
                taken.append((time.process_time() - started) / length)
            cells.append(f"{min(taken):.3g}")
        cells = cells if len(cells) == 2 else ["", *cells]
        yield f"| {name} | {1e6 * got.stats['dt']:.2g} | {got.stats['error']:.1e} | {' | '.join(cells)} |"


def run():
    """Write `dynamics.md` and print it."""
    model = stage()
    want, slow = _timed(model, "DOP853", 1e-10)
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
    rows = []
    for compiled in [False, *([True] if find_spec("numba") else [])]:
        name = "fast, numba" if compiled else "fast, numpy"
        simulate(model, DURATION, numba=compiled)  # compile
        for dt in (5e-5, 2.5e-5, 1.25e-5):
            got = simulate(model, DURATION, dt=dt, every=round(1e-4 / dt), numba=compiled)
            started = time.process_time()
            simulate(model, 1.0, dt=dt, numba=compiled)
            seconds = time.process_time() - started
            rows.append((name, f"{name}, {1e6 * dt:g} us", seconds, math.nan, _error(got, want), int(dt == 2.5e-5), ""))
    for method, rtol in (("RK45", 1e-4), ("RK45", 1e-6), ("DOP853", 1e-6), ("LSODA", 1e-4), ("DOP853", 1e-10)):
        got, seconds = (want, slow) if rtol == 1e-10 else _timed(model, method, rtol)
        rows.append((method, f"{method}, rtol {rtol:g}", seconds / DURATION, math.nan, _error(got, want), 0, ""))
    save("speed_dynamics", f"Made by `python -m validation dynamics` on {machine.describe()}.", rows)
    lines += [f"| {method} | {seconds:.3g} | {error:.2g} |" for _, method, seconds, _, error, *_ in rows]
    for head, rows in ((HEAD, accuracy()), (CHATTER, chatter()), (SPEED, speeds())):
        lines += head
        for row in rows:
            lines.append(row)
            print(row, flush=True)
    text = "\n".join([*lines, ""])
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)


def _timed(model, method, rtol):
    """Response of the comparison and the seconds of the processor it took."""
    started = time.process_time()
    got = simulate(model, DURATION, dt=1e-4, method=method, rtol=rtol)
    return got, time.process_time() - started


def _error(got, want, whole=None):
    """Largest error of a mesh force over its range in `whole`, if not in `want`."""
    ranges = np.ptp((whole or want).mesh(), axis=0)
    return float((np.abs(got.mesh() - want.mesh()).max(axis=0) / ranges).max())


def _moved(got, want, whole=None):
    """Largest error of a displacement over the largest range of its kind in `whole`, if not in `want`."""
    away, size = np.abs(got.q - want.q).max(axis=0), np.ptp((whole or want).q, axis=0)
    turns = np.array([name.endswith(("theta", "tilt_x", "tilt_y")) for name in want.machine.dofs])
    return float(max(away[kind].max() / size[kind].max() for kind in (turns, ~turns)))
