"""The fast path on arrays: one exponential step after the other, halved about changes of contact and bends of the loads.

A step in which a mesh opens or closes, or a load bends, is halved up to `gearfe.motion.propagator.LEVELS` times about it; under a
law of contact that is not linear so is one whose estimate (`gearfe.motion.propagator.Plan.told`) is above what is allowed: flanks
that come into contact are short, steep ramps of such a machine's coefficients, and all the rest of it is smooth.
"""

import numpy as np
from numpy import add, multiply

from ..machine.contact_law import LAW, branches, contact_force
from . import excitation
from .exponential import UNSTABLE, Step

GROW = 0.05  # of what is allowed: below it the next step is twice as long (the estimate grows as its fourth power)
CHUNK = 1024  # steps whose stiffnesses are looked up at once


def run(plan, machine, flat, z, steps, every, breaks, start=0.0):
    """Integrate `steps` steps from `z` at time `start`; states after each `every` steps, and counts.

    Returns
    -------
    states : ndarray, shape (1 + steps // every, 2n)
    stats : dict
        ``steps`` done, ``rejected`` for a change of contact, ``losses`` of contact.
    """
    step, forces = Step(plan), (_AffineForces if plan.affine else _Forces)(plan, machine, flat)
    fill, whole = forces.fill, len(plan.levels) == 1  # nothing opens or bends
    states = np.empty((1 + steps // every, z.size))
    states[0] = z
    stats = {"steps": 0, "rejected": 0, "losses": 0}
    parts = None if whole else _Parts(plan, machine, flat, step, breaks, stats)
    side = None if whole else parts.sides(z, start)
    for first in range(0, steps, CHUNK):
        count = min(CHUNK, steps - first)
        grid = start + plan.h * (first + np.arange(2 * count + 1) / 2)
        forces.at(grid)
        for i in range(count):
            if whole:
                z = step(z, 0, fill, 2 * i)
                stats["steps"] += 1
            else:
                z, side = parts(z, side, forces, 2 * i, grid[2 * i])
            if (first + i + 1) % every == 0:
                states[(first + i + 1) // every] = z
        if not np.isfinite(z).all():
            raise RuntimeError(
                f"the response grows beyond all bounds before t = {start + plan.h * (first + count):.4g} s: {UNSTABLE}"
            )
    return states, stats


def _broken(breaks, low, high):
    """Whether a load bends inside a step (ends excluded by a millionth of it)."""
    edge = 1e-6 * (high - low)
    return bool(len(breaks)) and np.searchsorted(breaks, low + edge) < np.searchsorted(breaks, high - edge)


class _Parts:
    """Steps taken whole or in halves, quarters...: about changes of contact and bends of loads, and as `Plan.allowed` asks."""

    def __init__(self, plan, machine, flat, step, breaks, stats):
        self.plan, self.step, self.breaks, self.stats = plan, step, breaks, stats
        self.sides, self.inner = _Sides(plan, machine, flat), _Forces(plan, machine, flat)
        self.level, self.scale, self.local = 0, plan.scale, plan.allowed < np.inf

    def __call__(self, z, side, forces, j, start):
        """State one step after `z`, and the flanks in touch; `forces` know the times of the step from number `j` on."""
        plan, last, at = self.plan, len(self.plan.levels) - 1, 0
        whole, level = 1 << last, self.level if self.local else 0
        while at < whole:
            while at % (whole >> level):
                level += 1
            low = start + plan.h * at / whole
            high = low + plan.h / 2**level
            broken = level < last and _broken(self.breaks, low, high)
            if not broken:
                acting, i = (self.inner, 0) if level else (forces, j)
                if level:
                    acting.at(np.array([low, (low + high) / 2, high]))
                new = self.step(z, level, acting.fill, i)
                away = self._away(new, level, acting, i + 2)
            e = () if broken else acting.e[i + 1 : i + 3]
            if broken or (level < last and (away > plan.allowed or self.sides.changed(side, self.step, new, *e))):
                level += 1
                self.stats["rejected"] += 1
                continue
            z, at, before = new, at + (whole >> level), side
            side = self.sides(z, high)
            self.stats["losses"] += int(((side == 0) & (before != 0) & self.sides.opens).sum())
            self.stats["steps"] += 1
            if not self.local or away <= GROW * plan.allowed:
                level = max(0, level - 1)
        self.level = level
        return z, side

    def _away(self, new, level, forces, i):
        """How far the step just taken is from one of lower order, as a mesh force over the largest so far."""
        if not self.local:
            return 0.0
        end = np.empty(self.step.width)
        forces.fill(self.plan.P @ new, end, i)
        self.scale = max(self.scale, np.abs(forces.total).max())
        told, (first, middle, last) = self.plan.told[level], forces.k[i - 2 : i + 1]
        turned = np.where(middle > 0, (first - 2 * middle + last) / np.where(middle > 0, middle, 1.0), 0.0) * forces.total
        force = np.abs(np.concatenate([told @ (end - self.step.forces[3]), told[:, : turned.size] @ turned]))
        return force.max() / self.scale if self.scale > 0 else 0.0


class _Forces:
    """Forces of meshes and friction rows beyond the linear part, and loads, by the contact law."""

    def __init__(self, plan, machine, flat):
        self.plan, self.flat, self.law, self.m = plan, flat, machine.law, len(machine.meshes)
        self.values = *(self.law[key] for key in LAW), *branches(self.law)
        self.rub, self.rates = len(flat.rub_mesh), len(plan.P) > len(machine.meshes)

    def at(self, times):
        """Look up all that acts at `times`."""
        self.k, phase = excitation.stiffness(self.flat, times)
        self.e, self.rate = excitation.errors(self.flat, times)
        self.weight = excitation.rubbing(self.flat, phase) if self.rub else None
        self.load = excitation.loads(self.flat, times)

    def fill(self, x, out, i):
        """Forces `out` at x, at the time of number i; for `gearfe.motion.exponential.Step`."""
        m, plan, rub = self.m, self.plan, self.rub
        v = x[m:] if self.rates else 0.0
        self.total = total = contact_force(x[:m] - self.e[i], v - self.rate[i], self.k[i], *self.values)
        out[:m] = total - plan.k * x[:m] - (plan.c * v if self.rates else 0.0)
        if rub:
            out[m : m + rub] = self.weight[i] * total[self.flat.rub_mesh]
        out[m + rub :] = self.load[i]


class _AffineForces(_Forces):
    """The same where every mesh stays closed, ``f = slope x + shift``: two array calls for each force."""

    def at(self, times):
        super().at(times)
        m, k = self.m, self.k
        slope, shift = np.zeros((2, len(k), m + self.load.shape[1]))
        slope[:, :m] = k - self.plan.k
        shift[:, :m] = -k * self.e - (self.law["damping"] + self.law["beta"] * k) * self.rate
        shift[:, m:] = self.load
        self.slope, self.shift = list(slope), list(shift)  # rows of lists are found sooner than those of arrays

    def fill(self, x, out, i):
        multiply(self.slope[i], x, out)
        add(out, self.shift[i], out)


class _Sides:
    """On which side each mesh touches: 1 its front flanks, -1 the back ones, 0 none."""

    def __init__(self, plan, machine, flat):
        self.m, self.flat, self.slack = len(machine.meshes), flat, machine.law["backlash"]
        self.P, self.opens = plan.P[: self.m], self.slack > 0

    def __call__(self, z, t):
        return self._of(self.P @ z - excitation.errors(self.flat, t)[0])

    def _of(self, x):
        return (x > 0).astype(np.int8) - (x < -self.slack)

    def changed(self, side, step, new, middle, end):
        """Whether any mesh that can open changes side in the step just taken to `new`; errors in its middle and at its end."""
        if not self.opens.any():
            return False
        x2, x3, x4 = (x[: self.m] for x in step.stages)
        ends = ((x2, middle), (x3, middle), (x4, end), (self.P @ new, end))
        return any(((self._of(x - e) != side) & self.opens).any() for x, e in ends)
