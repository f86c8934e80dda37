"""Fast path: exponential integrator of order four on the linear part, with the meshes as a forcing of low rank.

``u = (q, v)`` is brought to coordinates z in which the linear part - springs, and meshes at their mean stiffness - is exact,
``z' = A z + B f(t, P z)``: f are the deviations of the mesh forces from the linear part and the loads, P z what they depend on,
the compressions of the meshes. The step is that of Cox and Matthews, whose stages are only needed as P z, so that small matrices
carry
them:

    y = P exp(A h/2) z,  w = P exp(A h) z
    f1 = f(t, P z), f2 = f(t + h/2, y + S f1), f3 = f(t + h/2, y + S f2), f4 = f(t + h, w + R f1 + S (2 f3 - f1))
    z+ = exp(A h) z + F1 f1 + F2 (f2 + f3) + F3 f4

A step in which a mesh opens or closes, or a load bends, is halved up to `gearfe.motion.propagator.LEVELS` times about it.

References
----------
S. M. Cox, P. C. Matthews, J. Comput. Phys. 176 (2002) 430-455, eqs. 26-29; A.-K. Kassam, L. N. Trefethen, SIAM J. Sci. Comput.
26 (2005) 1214-1233.
"""

import numpy as np

from ..machine.contact_law import force
from . import excitation
from .propagator import dense

CHUNK = 1024  # steps whose stiffnesses are looked up at once


def run(plan, machine, flat, z, steps, every, breaks, start=0.0):
    """Integrate `steps` steps from `z` at time `start`; states after each `every` steps, and counts.

    Returns
    -------
    states : ndarray, shape (1 + steps // every, 2n)
    stats : dict
        ``steps`` done, ``rejected`` for a change of contact, ``losses`` of contact.
    """
    step = _Step(plan, machine, flat)
    if plan.affine:
        return _run_affine(step, z, steps, every, start)
    opens, free = machine.law["backlash"] > 0, not (machine.law["backlash"] > 0).any() and not len(breaks)
    states = np.empty((1 + steps // every, z.size))
    states[0] = z
    stats = {"steps": 0, "rejected": 0, "losses": 0}
    side = step.side(z, start)
    for first in range(0, steps, CHUNK):
        count = min(CHUNK, steps - first)
        grid = step.lookup(start + plan.h * (first + np.arange(2 * count + 1) / 2))
        for i in range(count):
            new, seen = step(z, 0, grid, 2 * i)
            t = start + plan.h * (first + i)
            if not free and (_changed(side, seen, opens) or _broken(breaks, t, t + plan.h)):
                new, side = _halve(step, z, side, t, opens, breaks, stats)
            else:
                stats["steps"] += 1
            z = new
            if (first + i + 1) % every == 0:
                states[(first + i + 1) // every] = z
        if not np.isfinite(z).all():
            raise RuntimeError(
                f"the response grows beyond all bounds before t = {start + plan.h * (first + count):.4g} s: {UNSTABLE}"
            )
    return states, stats


def _run_affine(step, z, steps, every, start):
    """`run` where every mesh stays closed and its force is affine: ``f = slope x + shift``, with as few array calls as can be."""
    plan, m = step.plan, step.m
    E, Y, S, T, F = plan.levels[0]
    wide, p, n = S.shape[1], len(plan.P), z.size

    def pad(rows):  # compressions beside zeros for the loads, so that f, x, slope and shift have one shape
        return np.concatenate([rows, np.zeros((wide - p, rows.shape[1]))])

    whole = np.concatenate([dense(E), pad(plan.P), pad(Y[:p]), pad(Y[p:])])
    S, T = pad(S), pad(T)
    # z, x1, x2 and x4 without their forces, in one product; f of the stages 1, 3, 4, 2
    both, g, x = np.empty(len(whole)), np.zeros(4 * wide), np.empty(wide)
    new, x1, y, w = both[:n], both[n : n + wide], both[n + wide : n + 2 * wide], both[n + 2 * wide :]
    f1, f3, f4, f2 = g.reshape(4, wide)
    f13, f134 = g[: 2 * wide], g[: 3 * wide]
    z, add, times = z.copy(), np.add, np.multiply
    extra = np.empty(n)
    states = np.empty((1 + steps // every, n))
    states[0] = z
    for first in range(0, steps, CHUNK):
        count = min(CHUNK, steps - first)
        k, e, rate, _, load = step.lookup(start + plan.h * (first + np.arange(2 * count + 1) / 2))
        slope, shift = np.zeros((len(k), wide)), np.empty((len(k), wide))
        slope[:, :m] = k - plan.k
        shift[:, :m] = -k * e - (step.law["damping"] + step.law["beta"] * k) * rate
        shift[:, m:] = load
        for i in range(count):
            j = 2 * i
            whole.dot(z, both)
            times(slope[j], x1, f1)
            add(f1, shift[j], f1)
            S.dot(f1, x)
            add(x, y, x)
            a, b = slope[j + 1], shift[j + 1]
            times(a, x, f2)
            add(f2, b, f2)
            S.dot(f2, x)
            add(x, y, x)
            times(a, x, f3)
            add(f3, b, f3)
            T.dot(f13, x)
            add(x, w, x)
            times(slope[j + 2], x, f4)
            add(f4, shift[j + 2], f4)
            add(f3, f2, f3)
            F.dot(f134, extra)
            add(new, extra, z)
            if (first + i + 1) % every == 0:
                states[(first + i + 1) // every] = z
        if not np.isfinite(z).all():
            raise RuntimeError(
                f"the response grows beyond all bounds before t = {start + plan.h * (first + count):.4g} s: {UNSTABLE}"
            )
    return states, {"steps": steps, "rejected": 0, "losses": 0}


UNSTABLE = "the machine is unstable (a parametric resonance without enough damping), or the step is too long"


def _changed(side, seen, opens):
    return any(((sides != side) & opens).any() for sides in seen)


def _broken(breaks, low, high):
    """Whether a load bends inside a step (ends excluded by a millionth of it)."""
    edge = 1e-6 * (high - low)
    return bool(len(breaks)) and np.searchsorted(breaks, low + edge) < np.searchsorted(breaks, high - edge)


def _halve(step, z, side, start, opens, breaks, stats):
    """One full step in halves, quarters... about the changes."""
    last = len(step.plan.levels) - 1
    whole, at, level = 1 << last, 0, 1
    stats["rejected"] += 1
    while at < whole:
        while at % (whole >> level):
            level += 1
        h = step.plan.h / 2**level
        t = start + step.plan.h * at / whole
        grid = step.lookup(t + h * np.array([0.0, 0.5, 1.0]))
        new, seen = step(z, level, grid, 0)
        if level < last and (_changed(side, seen, opens) or _broken(breaks, t, t + h)):
            level += 1
            stats["rejected"] += 1
            continue
        z, at = new, at + (whole >> level)
        after = step.side(z, t + h)
        stats["losses"] += int(((after == 0) & (side != 0) & opens).sum())
        stats["steps"] += 1
        side, level = after, max(1, level - 1)
    return z, side


class _Step:
    """A step on arrays; see the head of the module."""

    def __init__(self, plan, machine, flat):
        law = machine.law
        self.plan, self.flat, self.law, self.m = plan, flat, law, len(machine.meshes)
        self.rub, self.rates = len(flat.rub_mesh), len(plan.P) > len(machine.meshes)
        self.fronts = not (law["backlash"] > 0).any()
        self.f = np.zeros((4, plan.levels[0][2].shape[1]))  # of the stages 1, 3, 4, 2
        self.flat_f = self.f.ravel()
        self.E = [dense(one[0]) for one in plan.levels]

    def lookup(self, t):
        """Stiffnesses, errors, their rates, friction weights and loads at times `t`."""
        k, phase = excitation.stiffness(self.flat, t)
        e, rate = excitation.errors(self.flat, t)
        weight = excitation.rubbing(self.flat, phase) if self.rub else None
        return k, e, rate, weight, excitation.loads(self.flat, t)

    def side(self, z, t):
        """1 where the front flanks touch, -1 the back ones, 0 none."""
        x = self.plan.P[: self.m] @ z - excitation.errors(self.flat, t)[0]
        return _side(x, self.law["backlash"])

    def __call__(self, z, level, grid, j):
        """New z, and the sides of contact on the way."""
        _, Y, S, T, F = self.plan.levels[level]
        f, p, wide = self.f, len(S), self.f.shape[1]
        if len(grid[4][j]):
            f[:, self.m + self.rub :] = grid[4][[j, j + 1, j + 2, j + 1]]
        y = Y @ z
        w, y = y[p:], y[:p]
        x1 = self.plan.P @ z
        self._forces(f[0], x1, grid, j)
        x2 = y + S @ f[0]
        self._forces(f[3], x2, grid, j + 1)
        x3 = y + S @ f[3]
        self._forces(f[1], x3, grid, j + 1)
        x4 = w + T @ self.flat_f[: 2 * wide]
        self._forces(f[2], x4, grid, j + 2)
        f[1] += f[3]
        new = self.E[level] @ z + F @ self.flat_f[: 3 * wide]
        if self.fronts:
            return new, ()
        m, slack = self.m, self.law["backlash"]
        ends = ((x2, j + 1), (x3, j + 1), (x4, j + 2), (self.plan.P[:m] @ new, j + 2))
        return new, [_side(x[:m] - grid[1][i], slack) for x, i in ends]

    def _forces(self, out, x, grid, j):
        """Fill in the forces of meshes and friction rows beyond the linear part."""
        m, plan = self.m, self.plan
        k, e, rate = grid[0][j], grid[1][j], grid[2][j]
        v = x[m:] if self.rates else rate * 0.0
        total = force(x[:m] - e, v - rate, k, self.law)
        out[:m] = total - plan.k * x[:m] - (plan.c * v if self.rates else 0.0)
        if self.rub:
            out[m : m + self.rub] = grid[3][j] * total[self.flat.rub_mesh]


def _side(x, slack):
    return (x > 0).astype(np.int8) - (x < -slack)
