"""A part of the page `hard`: cases of the dynamics."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

import gearfe as gf
from gearfe.dynamics.machine.gear_mesh import Samples, ToothDamage, cycle_table
from gearfe.dynamics.machine.gear_pair import gear_pair
from gearfe.dynamics.machine.layout import Body
from gearfe.dynamics.machine.member import disc
from gearfe.dynamics.machine.modes import natural_frequencies
from gearfe.dynamics.machine.single_mesh import single_mesh
from gearfe.dynamics.motion.simulate import simulate
from gearfe.dynamics.motion.steady import steady_state
from gearfe.dynamics.motion.step_control import chosen_step, difference

from ..shared.kept_rows import kept

SPEED = 1000 * math.pi / 30  # of the pinion, rad/s
TORQUE = 100.0
RTOL = 1e-10  # of the reference
SCENE = gf.load_scene("planetary_pitting")


def sun_and_planet():
    """Sun and planet of the planetary scene as a pair, and its curve by `ritz`."""
    chosen = SCENE.pairs["sun_planet"]
    return chosen.pair, gf.mesh_stiffness(chosen.case(), phases=64, method="ritz")


def pair(*, stiffness=None, zeta=0.02, torque=TORQUE, **mesh):
    """The 21/31 pair on elastic shafts, 6 degrees of freedom."""
    gears, curve = sun_and_planet()
    bodies = []
    for name, gear in (("pinion", gears.gear_1), ("wheel", gears.gear_2)):
        made = disc(gear, 7850.0, 0.0)
        bodies.append(Body(name, made.mass, made.inertia, "x y theta"))
    options = {"speed": SPEED, "torque": torque, "support": {"x": 1e8, "y": 1e8}, "torsion": (1e4, 0.0), "zeta": zeta}
    return gear_pair(gears, bodies, curve if stiffness is None else stiffness, **options, **mesh).with_meshes(zeta=zeta)


def broken(rest=0.0):
    """Pinion tooth 0 broken off but for a part `rest` of the stiffness where it alone would carry, 0.6 beside another pair."""
    gears, curve = sun_and_planet()
    phase = np.arange(-16, math.ceil((gears.eps_alpha + 0.25) * 64) + 1) / 64
    alone = (phase > gears.eps_alpha - 1) & (phase < 1)
    beside = (phase > 0) & (phase < gears.eps_alpha)
    part = np.where(alone, rest, np.where(beside, 0.6, 1.0))
    return (ToothDamage(0, 0, Samples(phase, part * cycle_table(curve)(phase % 1.0))),)


def planetary(**mesh):
    """The planetary stage of the scene, 18 degrees of freedom, 6 meshes."""
    made = gf.build_machine(SCENE, phases=32, method="ritz")
    return made.with_meshes(**mesh) if mesh else made


def shaken(made, amplitude, share=1.0):
    """The machine with sinusoidal errors of mesh frequency on every mesh, at different phases [m]."""
    meshes = [replace(m, error=((amplitude, share * m.frequency, 1.3 * i),)) for i, m in enumerate(made.meshes)]
    return replace(made, meshes=tuple(meshes))


def bearings(made, factor):
    """The machine with all supports so many times stiffer, at the same damping ratios."""
    return replace(made, springs=tuple(replace(s, k=factor * s.k, c=math.sqrt(factor) * s.c) for s in made.springs))


def cases():
    """(name, callable that makes the machine, duration [s], options of `outcome`) of every hard case."""
    yield "broken tooth: k = 0 where it alone would carry, flanks that also pull", lambda: pair(damage=broken()), 0.01, {}
    yield "broken tooth, play 0.1 mm", lambda: pair(damage=broken(), backlash=1e-4), 0.01, {}
    yield "broken tooth, 1e-3 of k left, play 0.1 mm", lambda: pair(damage=broken(1e-3), backlash=1e-4), 0.01, {}
    yield "k = 0 all around", lambda: pair(stiffness=0.0, backlash=1e-4), 0.01, {}
    yield "zero damping: meshes and supports, pair", lambda: _undamped(pair()), 0.01, {}
    yield "zero damping, play 0.1 mm, errors of 60 um", lambda: _undamped(shaken(pair(backlash=1e-4), 60e-6, 5.0)), 0.01, {}
    yield "zero damping, planetary, 18 degrees of freedom", lambda: _undamped(planetary()), 0.01, {}
    every = {"backlash": 1e-4, "zeta": 0.05}
    yield "contact loss on every mesh: planetary, errors of 40 um", lambda: shaken(planetary(**every), 40e-6, 5.0), 0.01, {}
    yield "back-side contact: play 20 um, errors of 60 um, a tenth of the torque", lambda: _back(), 0.01, {}
    yield "play of 1 nm, errors of 60 um, a tenth of the torque", lambda: _back(backlash=1e-9), 0.01, {}
    jump = np.array([0.0, 0.003, 0.003, 1.0]), np.array([1.0, 1.0, 4.0, 4.0])
    yield "step in torque, 1 to 4", lambda: pair(torque=(jump[0], TORQUE * jump[1]), backlash=1e-4), 0.01, {}
    turned = jump[0], TORQUE * np.array([1.0, 1.0, -1.0, -1.0])
    yield "step in torque, reversed, play 0.1 mm", lambda: pair(torque=turned, backlash=1e-4), 0.01, {}
    yield "torque that opens the mesh, no back flank", lambda: pair(torque=-TORQUE, backlash=math.inf), 0.01, {}
    yield "supports 100 times stiffer, pair", lambda: bearings(pair(), 100), 0.01, {}
    yield "supports 100 times stiffer, planetary", lambda: bearings(planetary(), 100), 0.005, {}
    yield "supports 1e6 times stiffer, pair", lambda: bearings(pair(), 1e6), 0.002, {"reference": "Radau"}
    yield "resonance: error at the highest mesh mode, damping ratios 1e-3", lambda: _resonant(), 0.01, {}
    yield "resonance with play 0.1 mm: contact is lost", lambda: _resonant(backlash=1e-4), 0.01, {}
    yield "parametric resonance, k (1 + 0.3 cos), no play, 2 s", lambda: _parametric(), 2.0, {}
    yield "parametric resonance, play 0.1 mm", lambda: _parametric(backlash=1e-4), 0.01, {}


def _undamped(made):
    return replace(made, springs=tuple(replace(s, c=0.0) for s in made.springs)).with_meshes(zeta=0.0, damping=0.0, beta=0.0)


def _back(backlash=20e-6):
    return shaken(pair(backlash=backlash, torque=0.1 * TORQUE, zeta=0.05), 60e-6, 5.0)


def _resonant(**mesh):
    made = pair(zeta=1e-3, **mesh)
    top = natural_frequencies(made)[0][-1]
    return shaken(made, 1e-6, top / made.meshes[0].frequency)


def _parametric(**mesh):
    k = 1e8 * (1 + 0.3 * np.cos(2 * math.pi * np.arange(64) / 64))
    return single_mesh(1.0, k, 2 * 1e4 / (2 * math.pi), force=1000.0, zeta=0.01, **mesh)


def outcome(build, duration, options):
    """What a case ended in, as cells, and whether the estimate covers; `options`: method of the ``reference``."""
    try:
        made = build()
        got = simulate(made, duration, filtered=False)
    except (ValueError, RuntimeError) as error:
        return {"cells": f"{type(error).__name__}: {error} | | "}
    forces = got.mesh()
    if not (np.isfinite(got.states).all() and np.isfinite(forces).all()):
        raise AssertionError("a response that is not finite came back without an error")
    text = f"step {1e6 * got.stats['dt']:.2g} us, mesh forces {forces.min():.3g} to {forces.max():.3g} N"
    if got.stats["losses"]:
        lost = sum(bool((x <= 0).any()) for x in got.mesh("compression").T)
        back = sum(bool((x < -m.backlash).any()) for x, m in zip(got.mesh("compression").T, made.meshes, strict=True))
        text += f"; contact lost {got.stats['losses']} times, on {lost} of {len(made.meshes)} meshes"
        text += f", back flanks on {back}" if back else ""
    method = options.get("reference", "DOP853")
    run = {"dt": duration / (len(got.time) - 1), "method": method}
    want, coarser = (simulate(made, duration, rtol=rtol, **run) for rtol in (RTOL, 10 * RTOL))
    return judged(text, got.stats["error"], max(difference(got, want)), method, max(difference(coarser, want)))


def judged(text, estimate, error, method, own=0.0):
    """A row: cells, and whether the estimate covers the error, unless the reference's own error is larger than both."""
    out = {"cells": f"{text} | {100 * estimate:.2g} % | {100 * error:.2g} % ({method})"}
    if own > max(error, estimate):
        return {"cells": out["cells"].replace(f"({method})", f"({method}, itself {100 * own:.2g} %)")}
    return out | {"covered": bool(error <= estimate)}


def long_run():
    """100 000 steps: the end against the steady state found by shooting."""
    made = pair(zeta=0.05)
    cycle = 1 / made.meshes[0].frequency
    each = math.ceil(cycle / chosen_step(made, 1.0)[0])  # steps in a cycle
    dt, steps = cycle / each, each * math.ceil(1e5 / each)
    got = simulate(made, steps * dt, dt=dt, error=True)
    steady = steady_state(made, dt=dt).response
    n = len(steady.time)
    away = (np.abs(got.q[-n:] - steady.q).max(axis=0) / np.ptp(steady.q, axis=0)).max()
    text = f"{got.stats['steps']} steps; the last cycle against the steady state by shooting"
    return judged(text, got.stats["error"], away, "shooting")


def section(again=False):
    """Lines of the page."""
    lines = [
        "## In the dynamics",
        "",
        "Sun and planet of `planetary_pitting` as a pair (6 degrees of freedom, curve by `ritz`, 100 N m, 1000 rpm), or the",
        "stage (18 degrees of freedom), at the step that `simulate` chooses.",
        'Estimate: `stats["error"]`, on a stretch of 3.5 mesh cycles, or of the whole run where contact is lost. Reference: the',
        "same against DOP853 (rtol 1e-10), or what is named: the larger of displacements and mesh forces over their ranges; both",
        "integrate the same equations. Where ten times the tolerance moves the reference by more than both, it judges nothing.",
        "A response that is not finite would stop the making of this page.",
        "Forces of the broken tooth are those of free gears without the inertia of a motor.",
        "",
        "| case | outcome | estimate | reference |",
        "|---|---|---|---|",
    ]
    jobs = [(name, partial(outcome, *case)) for name, *case in cases()] + [("100 000 steps, pair", long_run)]
    lines += [f"| {name} | {kept('hard_dynamics', name, job, again)['cells']} |" for name, job in jobs]
    return lines
