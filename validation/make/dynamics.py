"""The page `dynamics`: the fast path at its own step on the machines of all scenes, and where contact is lost."""

import math
import time
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.dynamics.motion.simulate import simulate

from ..shared import page
from ..shared.kept_rows import kept, stored
from ..shared.stages import article, compound, helical, machines, spur, stage

DURATION = 0.01  # duration of the comparison; the fast path is timed over one second
RATES = (2e3, 5e3, 1e4, 2.5e4, 5e4)  # rates of the output [Hz]; the last holds all others

HOW = """
`python -m validation dynamics` makes this page from `tables/dynamics_*.jsonl` and computes them.
Seconds of the integrators: [speed.md](speed.md); extreme
cases: [hard.md](hard.md). Both sides integrate the same equations of the same machine; those are held against modes and values
of others in [truth.md](truth.md).
"""
HEAD = [
    """
    ## The step that `simulate` chooses

    Without `step` the fast path halves its step on a short stretch until two runs agree; where contact is lost, whole runs.
    Here against DOP853 (rtol 1e-10) between located changes of contact, from rest, over about three mesh cycles, at five
    output rates, 2 to 50 kHz: the largest error of a displacement over the largest range of a displacement of its kind
    (translation, rotation), and of a mesh force over its range; and the estimate, `stats["error"]`, of the larger of both.
    Wanted: 1e-3, with contact loss 1e-2, and the error below the estimate in 95 of 100 runs. Curves of the spur stages by
    `ritz`; a damaged tooth loses 20 % of the stiffness (planetary), is cracked to 50 % (compound), has a pit of 10 by 2 mm
    under the impact law (helical), or loses 30 % (herringbone). Contact is lost to errors of 40 um with 0.1 mm of play.

    | machine | steps, us | estimates | largest displacement error | largest force error | covered | losses of contact |
    |---|---|---|---|---|---|---|
    """,
]
CHATTER = "A chattering stage, with and without located changes of contact: [dynamics_chatter.md](dynamics_chatter.md)."


def accuracy(again=False):
    """Lines: errors of the fast path at its own steps against DOP853 (rtol 1e-10), at all rates; last how many were covered."""
    runs, covered = 0, 0
    for name, build, duration in machines():
        row = kept("dynamics_steps", name, lambda build=build, duration=duration: errors(build(), duration), again)
        larger = [max(pair) for pair in zip(row["displacement"], row["force"], strict=True)]
        inside = sum(error <= doubt for error, doubt in zip(larger, row["estimate"], strict=True))
        runs, covered = runs + len(larger), covered + inside
        spans = f"{min(row['step']):.2g} to {max(row['step']):.2g} | {min(row['estimate']):.1e} to {max(row['estimate']):.1e}"
        worst = f"{max(row['displacement']):.1e} | {max(row['force']):.1e} | {inside} of {len(larger)}"
        yield f"| {name} | {spans} | {worst} | {' or '.join(str(int(n)) for n in sorted(set(row['losses'])))} |"
    yield ""
    yield f"Covered: {covered} of {runs} runs, {100 * covered / runs:.0f} %."


def errors(made, duration):
    """Steps [us], estimates, errors and losses of contact of a machine at all rates, one list of five each."""
    want = exact(made, duration)
    row = {name: [] for name in ("step", "estimate", "displacement", "force", "losses")}
    for rate in RATES:
        got, every = simulate(made, duration, rate=rate, filtered=False), round(RATES[-1] / rate)
        thin = replace(want, time=want.time[::every], states=want.states[::every])
        cells = 1e6 * got.stats.get("dt", math.nan), got.stats["error"], _moved(got, thin, want), _error(got, thin, want)
        for name, value in zip(row, (*cells, got.stats.get("losses", 0)), strict=True):
            row[name].append(float(f"{value:.3g}"))
    return row


def exact(made, duration):
    """Response by DOP853 (rtol 1e-10) between located changes of contact, at the highest rate."""
    return simulate(made, duration, rate=RATES[-1], method="DOP853", rtol=1e-10, filtered=False)


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
    """The herringbone stage, its motion by DOP853 (rtol 1e-10) and the seconds of the processor it took."""
    model = stage()
    return model, *_timed(model, "DOP853", 1e-10)


def answer():
    """The first line."""
    rows = list(stored("dynamics_steps").values())
    errors = [max(d, f) for row in rows for d, f in zip(row["displacement"], row["force"], strict=True)]
    doubts = [estimate for row in rows for estimate in row["estimate"]]
    covered = sum(error <= doubt for error, doubt in zip(errors, doubts, strict=True))
    return (
        f"At the step that `simulate` chooses itself the largest error of {len(errors)} runs is {100 * max(errors):.2g} %, "
        "contact loss "
        f"included, and its estimate covers the error in {covered} of them."
    )


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    sections = [*HEAD, *accuracy(again)], [CHATTER]
    page.write("dynamics", answer(), HOW, *sections)


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


def cheap():
    """Rows that `validation.check` computes again: the steps that `simulate` chooses, and the losses of contact."""
    known = stored("dynamics_steps")
    for name, build, duration in machines():
        if "law" not in name:
            yield name, {one: known[name][one] for one in ("step", "losses")}, lambda build=build, d=duration: chosen(build(), d)


def chosen(made, duration):
    """Steps [us] and losses of contact of a machine at all rates."""
    stats = [simulate(made, duration, rate=rate, filtered=False).stats for rate in RATES]
    return {"step": [float(f"{1e6 * one['dt']:.3g}") for one in stats], "losses": [float(one.get("losses", 0)) for one in stats]}
