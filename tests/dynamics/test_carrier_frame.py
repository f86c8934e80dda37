"""Size of what a gearbox leaves out: directions of planets that turn with the carrier, by plain matrices in the fixed frame.

In the fixed frame, rows of planets turn and there are no Coriolis terms. Started in the motion that is at rest relative to the
carrier, both models differ by these terms alone.
"""

import copy
import math

import numpy as np
import pytest
from gearboxes import SPACE
from plain_train import Plain
from scipy.integrate import solve_ivp

BETA, DURATION = 2e-6, 0.003


class Turning:
    """Helical train with four planets on pins. `spin` is the angular velocity of the directions [rad/s]."""

    def __init__(self, rpm, turns):
        tables = copy.deepcopy(SPACE)
        tables["machine"]["speed_rpm"] = rpm
        five = [Plain(tables, ahead=2 * math.pi * i / 5).build() for i in range(5)]  # rows have the orders 0, 1 and 2
        rows = [[*(row for _, _, row, _ in one.meshes), *(row for row, *_ in one.pins)] for one in five]
        self.orders = np.fft.fft(rows, axis=0)[:3] / 5 * np.array([1, 2, 2])[:, None, None]
        self.train, self.spin = five[0], five[0].w["out"] * turns
        self.K = self.train.K - sum(k * np.outer(row, row) for row, k, _ in self.train.pins)
        self.C = self.train.C + self.train.G - sum(c * np.outer(row, row) for row, _, c in self.train.pins)
        self.mean = np.concatenate([np.full(len(self.train.meshes), 2.5e8), [k for _, k, _ in self.train.pins]])
        self.damping = np.concatenate([BETA * self.mean[: len(self.train.meshes)], [c for *_, c in self.train.pins]])
        self.rate = np.array([rate for *_, rate in self.train.meshes])

    def rows(self, t):
        waves = np.exp(1j * self.spin * t * np.arange(3))
        slopes = 1j * self.spin * np.arange(3) * waves
        return (np.tensordot(part, self.orders, 1).real for part in (waves, slopes))

    def forces(self, t, q, v):
        rows, slopes = self.rows(t)
        waves = np.ones(self.mean.size)
        waves[: self.rate.size] += 0.15 * np.cos(2 * math.pi * (self.rate * t + 0.37 * np.arange(self.rate.size)))
        return rows, waves * (self.mean * (rows @ q) + self.damping * (rows @ v + slopes @ q))

    def slope(self, t, u):
        q, v = np.split(u, 2)
        rows, force = self.forces(t, q, v)
        return np.concatenate([v, (self.train.f - self.K @ q - self.C @ v - rows.T @ force) / self.train.M])

    def start(self):
        rows, _ = self.rows(0.0)
        q = np.linalg.lstsq(self.K + rows.T @ (self.mean[:, None] * rows), self.train.f, rcond=1e-12)[0]
        v = np.zeros(q.size)
        turning = [self.train.block(shaft, x) for shaft in ("three", "out") for x in self.train.at[shaft]]
        for at in (*turning, *(self.train.lone[f"planet{i}"] + np.arange(6) for i in range(1, 5))):
            for x, y in (at[:2], at[3:5]):
                v[x], v[y] = -self.spin * q[y], self.spin * q[x]
        return np.concatenate([q, v])

    def record(self):
        """Forces of the meshes, and both displacements of the sun's shaft in its first bearing as a complex number."""
        t = np.linspace(0.0, DURATION, 61)
        u = solve_ivp(self.slope, (0, DURATION), self.start(), method="DOP853", t_eval=t, rtol=1e-8, atol=1e-12).y.T
        forces = np.array([self.forces(at, *np.split(row, 2))[1][: self.rate.size] for at, row in zip(t, u, strict=True)])
        x, y = self.train.block("three", 5.0)[:2]
        return t, forces, u[:, x] + 1j * u[:, y]


@pytest.mark.slow
@pytest.mark.parametrize(("rpm", "meshes"), [(1200.0, 0.003), (12_000.0, 0.06)])
def test_turning_directions_change_forces_by_the_carrier_speed(rpm, meshes):
    """Carriers at 2 and 20 Hz. A bearing's motion, turned back with the carrier, is that of the frozen directions."""
    (t, frozen, still), (_, true, moved) = (Turning(rpm, turns).record() for turns in (0.0, 1.0))
    apart = np.abs(true - frozen).max(axis=0) / np.ptp(frozen, axis=0)
    back = moved * np.exp(-1j * Turning(rpm, 1.0).spin * t)
    size = np.abs(still - still.mean()).max()
    as_is, turned = (np.abs(one - still).max() / size for one in (moved, back))
    print(f"meshes {100 * apart.max():.2g} %, bearing {100 * as_is:.2g} %, turned back {100 * turned:.2g} % of the range")
    assert 0.2 * meshes < apart.max() < meshes
    assert turned < as_is
