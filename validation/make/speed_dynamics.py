"""A part of the page `speed`: seconds of the integrators, and of the machines of all scenes."""

import time
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.dynamics.motion.simulate import simulate

from ..shared.stages import article, compound, helical, spur, stage

DURATION = 0.01  # of the comparison; the fast path is timed over one second


def speeds():
    """Seconds of the processor per simulated second of each machine, for the page `speed`."""
    jobs = (
        ("herringbone, 55 degrees of freedom", lambda: stage(True), 1.0),
        ("compound_planetary, 39", lambda: compound(True), 1.0),
        ("planetary_pitting, 18", lambda: spur(True), 10.0),
        ("helical_pitting, 8, impact law", lambda: helical(True), 1.0),
        ("planetary_pitting, 18, impact law, friction, pulses", article, 1.0),
    )
    found = [{"name": name} | speed(build(), duration) for name, build, duration in jobs]
    for name in ("planetary_pitting", "compound_planetary"):
        scene = gf.load_scene(name)
        one, several = gf.build_machine(scene), gf.build_machine(scene, loads=(1 / 16, 1 / 4, 1 / 2, 1, 2))
        kinds = (("not filtered", one, {"filtered": False}), ("one curve", one, {}), ("laws of five loads", several, {}))
        found += [{"name": f"{name}, healthy, {kind}"} | speed(made, 2.0, **options) for kind, made, options in kinds]
    return found


def speed(made, duration, **options):
    """Seconds of the processor per simulated second of a machine, best of three; `options` of `simulate`."""
    taken = []
    for _ in range(4):  # the first run compiles
        started = time.process_time()
        got = simulate(made, duration, **options)
        taken.append((time.process_time() - started) / duration)
    return {"seconds": float(f"{min(taken):.3g}"), "step": 1e6 * got.stats["dt"], "estimate": got.stats["error"]}


def integrators():
    """Integrators on the herringbone stage: rows of `speed_page.table`."""
    names = [f"fast, {1e6 * dt:g} us" for dt in (5e-5, 2.5e-5, 1.25e-5)]
    slow = (("RK45", 1e-4), ("RK45", 1e-6), ("DOP853", 1e-6), ("LSODA", 1e-4), ("DOP853", 1e-10))
    names += [f"{method}, rtol {rtol:g}" for method, rtol in slow]
    rows = []
    for name in names:
        seconds, error = integrated(name)
        rows.append((name.split(", ")[0], name, seconds, None, error, int(name.endswith(" 25 us")), ""))
        print(rows[-1], flush=True)
    return rows


def integrated(name):
    """Seconds per simulated second and error of an integrator on the herringbone stage."""
    model, want = herringbone_exact()[:2]
    if name == "DOP853, rtol 1e-10":
        return herringbone_exact()[2] / DURATION, 0.0
    if not name.startswith("fast"):
        got, seconds = _timed(model, name.split(",")[0], float(name.split()[-1]))
        return seconds / DURATION, _error(got, want)
    dt = 1e-6 * float(name.split()[-2])
    got = simulate(model, DURATION, dt=dt, every=round(1e-4 / dt))
    started = time.process_time()
    simulate(model, 1.0, dt=dt)
    return time.process_time() - started, _error(got, want)


@cache
def herringbone_exact():
    """Return the herringbone stage, its motion by DOP853 (rtol 1e-10) and the seconds of the processor it took."""
    model = stage()
    return model, *_timed(model, "DOP853", 1e-10)


def _timed(model, method, rtol):
    """Response of the comparison and the seconds of the processor it took."""
    started = time.process_time()
    got = simulate(model, DURATION, dt=1e-4, method=method, rtol=rtol)
    return got, time.process_time() - started


def _error(got, want):
    """Largest error of a mesh force over its range."""
    return float((np.abs(got.mesh() - want.mesh()).max(axis=0) / np.ptp(want.mesh(), axis=0)).max())
