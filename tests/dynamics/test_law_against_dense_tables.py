"""A force law against contact solved under 65 loads at 1024 phases, straight between, by an integrator of its own.

Both share the contact solver; what it is worth stands elsewhere. Twelve cases: three mesh frequencies by four loads.
"""

import math

import numpy as np
import pytest
from usual import PAIR

import gearfe as gf

STEEL = gf.Material(E=207e3, nu=0.25)
MASS, DAMPING, STEP, STEPS, SWING = 0.15, 2 * 0.02 * math.sqrt(3.12e8 * 0.15), 1e-6, 100_000, 47.0
CASES = [(f, low, high) for f in (280.0, 2500.0, 7000.0) for low, high in ((300, 300), (1600, 1600), (200, 400), (200, 3200))]


def dense(start):
    """Accelerations and displacements of all cases by Runge-Kutta-Nystroem steps, ``(steps, cases)``."""
    loads = np.concatenate([np.geomspace(5, 50, 6)[:-1], np.geomspace(50, 12000, 60)])
    deep = np.array([one.deflection for one in gf.mesh_stiffness(PAIR, loads, STEEL, phases=1024)]).T
    grid = np.linspace(0, 30e-6, 601)
    table = np.array([np.interp(grid, np.append(0, row), np.append(0, loads)) for row in deep])
    table = np.vstack([table, table[:1]])
    frequency, low, high = np.array(CASES).T

    def rate(t, x, v):
        at, place = (frequency * t % 1) * 1024, np.clip(x, 0, 29.9e-6) / grid[1]
        i, j = at.astype(int), place.astype(int)
        u, w = at - i, place - j
        force = (1 - u) * ((1 - w) * table[i, j] + w * table[i, j + 1])
        force = force + u * ((1 - w) * table[i + 1, j] + w * table[i + 1, j + 1])
        load = (low + high) / 2 + (high - low) / 2 * math.sin(2 * math.pi * SWING * t)
        return (load - force - DAMPING * v) / MASS

    x, v, h = start, 0 * start, STEP
    moved, pushed = np.empty((2, STEPS, len(CASES)))
    for i in range(STEPS):
        t = i * h
        a = rate(t, x, v)
        moved[i], pushed[i] = x, a
        b = rate(t + h / 2, x + h / 2 * v, v + h / 2 * a)
        c = rate(t + h / 2, x + h / 2 * v + h * h / 4 * a, v + h / 2 * b)
        d = rate(t + h, x + h * v + h * h / 2 * b, v + h * c)
        x, v = x + h * v + h * h / 6 * (a + b + c), v + h / 6 * (a + 2 * b + 2 * c + d)
    return pushed, moved


@pytest.mark.slow
def test_accelerations_within_two_percent_and_time_open_within_a_hundredth():
    law = gf.converged_force_law(PAIR, 50.0, 12800.0, STEEL, force=1600.0)

    def load(low, high):
        swing = (high - low) / 2
        return (lambda t: low + swing + swing * np.sin(2 * math.pi * SWING * np.asarray(t))) if swing else float(low)

    given = {"damping": DAMPING, "backlash": math.inf}
    machines = [gf.single_mesh(MASS, law, f, force=load(low, high), **given) for f, low, high in CASES]
    start = np.array([one.rest()[0] for one in machines])
    pushed, moved = (part[STEPS // 5 :] for part in dense(start))
    options = {"rate": 1 / STEP}
    found = [gf.simulate(one, STEPS * STEP, initial=([x], [0.0]), **options) for one, x in zip(machines, start, strict=True)]
    for i, (case, got) in enumerate(zip(CASES, found, strict=True)):
        a, x = got["pair.x acceleration"][STEPS // 5 : STEPS], got["pair.x"][STEPS // 5 : STEPS]
        off = math.sqrt(np.mean(a**2) / np.mean(pushed[:, i] ** 2)) - 1
        away = np.mean(x <= 0) - np.mean(moved[:, i] <= 0)
        print(case, f"acceleration {100 * off:+.2f} %, time open {away:+.4f}")
        assert abs(off) < 0.02, case
        assert abs(away) < 0.01, case
