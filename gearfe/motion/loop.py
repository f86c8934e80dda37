"""The fast path: one step of `gearfe.motion.exponential` after the other, in scalar arithmetic that numba compiles.

A step in which a mesh opens or closes, or a load bends, is halved up to `gearfe.motion.propagator.LEVELS` times about it; under a
law of contact that is not linear so is one whose estimate (`gearfe.motion.propagator.Plan.told`) is above what is allowed: flanks
that come into contact are short, steep ramps of such a machine's coefficients, and all the rest of it is smooth.

Loads that do not change are taken out of the stages and added at the end.
"""

from typing import NamedTuple

import numpy as np

from .excitation import changing
from .exponential import UNSTABLE
from .loop_law import force, records
from .loop_parts import compiled, kept, lookup, secant, stage

GROW = 0.05  # of what is allowed: below it the next step is twice as long (the estimate grows as its fourth power)
CHUNK = 64  # steps whose stiffnesses are looked up at once


class Matrices(NamedTuple):
    """Those of the step by level, columns one after the other so that the loops over them run along memory.

    `PF` is ``P F`` below F: what the forces add to z, and to x at the end of the step. `add` and `push` are what constant loads
    add to y and w, and to z and P z, level after level in one row. `W` is of `gearfe.motion.propagator.Plan.told`.
    """

    E: np.ndarray
    Y: np.ndarray
    S: np.ndarray
    T: np.ndarray
    PF: np.ndarray
    add: np.ndarray
    push: np.ndarray
    W: np.ndarray
    P: np.ndarray


def run(plan, machine, flat, z, steps, every, breaks, start=0.0, acting=None):
    """Integrate `steps` steps from `z` at time `start`; states after each `every` steps, and counts.

    Parameters
    ----------
    acting : ndarray, shape (1 + steps, f + m or f + 2m), optional
        Filled with what acts before each step and after the last: the f forces that change
        (`gearfe.motion.excitation.changing`), the stiffnesses of the meshes, and their errors if there is room.

    Returns
    -------
    states : ndarray, shape (1 + steps // every, 2n)
    stats : dict
        ``steps`` done, ``rejected`` for a change of contact, ``losses`` of contact.
    """
    matrices = _matrices(plan, *changing(machine, flat))
    bends = [flat.knots[low:high] for low, high in zip(flat.knot_place[:-1], flat.knot_place[1:], strict=True) if high > low + 1]
    flat = flat._replace(knots=np.concatenate(bends) if bends else np.zeros((1, 2)), knot_place=np.cumsum([0, *map(len, bends)]))
    laws = records(machine.law)
    kind = plan.affine, len(plan.P) > len(machine.meshes)
    linear = np.stack([plan.k, plan.c])
    edges = np.append(np.asarray(breaks, dtype=float), np.inf)
    states, counts = np.empty((1 + steps // every, z.size)), np.zeros(3, dtype=np.int64)
    local = plan.allowed, plan.scale
    acting = np.zeros((0, 0)) if acting is None else acting
    done = _run(matrices, laws, kind, linear, flat, edges, z.copy(), plan.h, start, every, states, counts, local, acting)
    if done < steps:
        raise RuntimeError(f"the response grows beyond all bounds before t = {start + plan.h * done:.4g} s: {UNSTABLE}")
    return states, {"steps": int(counts[0]), "rejected": int(counts[1]), "losses": int(counts[2])}


def _matrices(plan, kept, still):
    """`Matrices` of a plan with the columns `kept` of the forces, those that are constant having the values `still`."""
    wide = max(still.size, 1)  # nothing acts

    def columns(matrix):
        index = wide * np.arange(matrix.shape[1] // wide)[:, None] + kept
        return matrix[:, index.ravel()].T

    parts = []
    for (E, Y, S, T, F), told in zip(plan.levels, plan.told, strict=True):
        PF = np.concatenate([F, plan.P @ F])
        add = np.concatenate([S @ still, T @ np.concatenate([still, still])])
        push = PF @ np.concatenate([still, 2 * still, still])
        parts.append((E, Y.T, columns(S), columns(T), columns(PF), add, push, columns(told)))
    E, Y, S, T, PF, add, push, W = (np.stack([np.ascontiguousarray(part) for part in one]) for one in zip(*parts, strict=True))
    return Matrices(E, Y, S, T, PF, add.ravel(), push.ravel(), W, plan.P)


@compiled
def _forces(g, first, x, now, row, laws, kind, linear, rub_mesh, total, stiff, table, shape, change_mesh):
    """Forces of the meshes and friction rows beyond the linear part, and loads that change, into ``g[first:]``.

    Whole forces and stiffnesses of the meshes go into `total` (where it is needed) and `stiff`.
    """
    affine, rates = kind
    m, rub, lawful = total.size, rub_mesh.size, table.size > 0
    at = now.shape[1] - (2 * shape.shape[0] if lawful else 0)
    for j in range(at - 3 * m - rub):
        g[first + m + rub + j] = now[row, 3 * m + rub + j]
    if affine:  # every mesh stays closed: the same, without asking where it is
        for i in range(m):
            k, e, rate = now[row, i], now[row, m + i], now[row, 2 * m + i]
            g[first + i] = (k - linear[0, i]) * x[i] - k * e - (laws[i].damping + laws[i].beta * k) * rate
            stiff[i] = k
        return
    for i in range(m):
        v = x[m + i] if rates else 0.0
        k, e, rate = now[row, i], now[row, m + i], now[row, 2 * m + i]
        if lawful and now[row, at + 2 * i] >= 0:
            deep = max(x[i] - e, 0.0) + max(-laws[i].backlash - (x[i] - e), 0.0)
            k = secant(table, shape, i, now[row, at + 2 * i], now[row, at + 2 * i + 1], deep)
            for j in range(change_mesh.size):
                own = at + 2 * (m + j)
                if change_mesh[j] == i and now[row, own] >= 0:
                    k += secant(table, shape, m + j, now[row, own], now[row, own + 1], deep)
            k = max(k, 0.0)
        whole = force(x[i] - e, v - rate, k, laws[i])
        g[first + i] = whole - linear[0, i] * x[i] - linear[1, i] * v
        total[i], stiff[i] = whole, k
    for j in range(rub):
        g[first + m + j] = now[row, 3 * m + j] * total[rub_mesh[j]]


@compiled
def _note(acting, step, g, stiff, now, row, f):
    """Write the forces that change, the stiffnesses, and the errors if there is room, into a row of `acting`."""
    m = stiff.size
    for i in range(f):
        acting[step, i] = g[i]
    for i in range(m):
        acting[step, f + i] = stiff[i]
    for i in range(acting.shape[1] - f - m):
        acting[step, f + m + i] = now[row, m + i]


@compiled
def _side(own, backlash):
    """1 where the front flanks touch, -1 the back ones, 0 none."""
    return 1.0 if own > 0 else (-1.0 if own < -backlash else 0.0)


@compiled
def _changed(side, x, now, row, laws):
    """Whether a mesh that can open is not on the side given."""
    m = side.size
    for i in range(m):  # noqa: SIM110 (numba has no generators here)
        if laws[i].backlash > 0 and side[i] != _side(x[i] - now[row, m + i], laws[i].backlash):
            return True
    return False


@compiled
def _losses(side, x, now, row, laws):
    """Bring the sides up to date; how many meshes that can open have opened."""
    m, lost = side.size, 0
    for i in range(m):
        seen = _side(x[i] - now[row, m + i], laws[i].backlash)
        lost += laws[i].backlash > 0 and side[i] != 0.0 and seen == 0.0
        side[i] = seen
    return lost


@compiled
def _turned(first, middle, last):
    """How far a stiffness turns off its straight line within a step, part of it."""
    return (first - 2 * middle + last) / middle if middle > 0 else 0.0


@compiled
def _propagate(new, E, level, z):
    """``new[:n] += E[level] z`` of blocks along a diagonal."""
    if E.shape[2] == 2:
        for j in range(E.shape[1]):
            a, b = z[2 * j], z[2 * j + 1]
            new[2 * j] += E[level, j, 0, 0] * a + E[level, j, 0, 1] * b
            new[2 * j + 1] += E[level, j, 1, 0] * a + E[level, j, 1, 1] * b
    else:
        for i in range(z.size):
            for j in range(z.size):
                new[i] += E[level, 0, i, j] * z[j]


@kept
def _run(matrices, laws, kind, linear, flat, edges, z, h, start, every, states, counts, local, acting):
    """Inside the loops no array is cut or taken out of a tuple: counting its references costs as much as the arithmetic."""
    E, Y, S, T, PF, add, push, W, P = matrices
    m, p, f, n, last, rub = len(laws), P.shape[0], S.shape[1], z.size, len(E) - 1, flat.rub_mesh
    table, shape, change_mesh = flat.secant, flat.shape, flat.change_mesh
    whole, opens, own = 1 << last, last > 0, 2 * CHUNK + 1  # the row of `now` where parts of a step begin
    now = np.zeros((own + 3, 3 * m + f - m + (2 * len(shape) if table.size > 0 else 0)))
    g, last_g, apart = np.zeros(4 * f), np.zeros(f), np.zeros(f)  # forces of the stages 1, 3, 4, 2; at the end; it less stage 4
    none, doubt, fresh = np.zeros(m), np.zeros(m), False  # `fresh`: the first forces are those of the end before
    y, x, x0, new, end = np.zeros(2 * p), np.zeros(p), np.dot(P, z), np.zeros(n + p), np.zeros(p)
    total, stiff, side, edge, level, silent = np.zeros(m), np.zeros(m), np.zeros(m), 0, 0, len(acting) == 0
    nil, one = np.int64(0), np.int64(1)  # numba compiles a function anew for every number written out
    allowed, scale = local
    held = allowed < np.inf
    lookup(flat, now, nil, one, start, h, 0.0, 0.0)
    _losses(side, x0, now, nil, laws)
    for i in range(n):  # written out: numba takes 2 s to compile what it says of arrays that do not fit
        states[0, i] = z[i]
    steps = (len(states) - 1) * every
    for step in range(steps):
        if step % CHUNK == 0:
            if not np.isfinite(np.sum(z)):
                return step
            lookup(flat, now, nil, 2 * min(CHUNK, steps - step) + 1, start, h, float(step), 0.5)
        at, known = 0, -1  # `known`: the part whose end stands in the last row
        if not held:
            level = 0
        noted = silent
        while at < whole:
            while at & ((whole >> level) - 1):
                level += 1
            part = whole >> level
            low, high = step + at / whole, step + (at + part) / whole
            while edges[edge] <= start + h * (low + 1e-6 * (high - low)):
                edge += 1
            if level < last and edges[edge] < start + h * (high - 1e-6 * (high - low)):
                level += 1
                counts[1] += 1
                continue
            row = 2 * (step % CHUNK)
            if level > 0:
                row = own
                if known == at:
                    for i in range(now.shape[1]):
                        now[own, i] = now[own + 2, i]
                else:
                    lookup(flat, now, own, own + 1, start, h, low, 0.0)
                lookup(flat, now, own + 1, own + 3, start, h, (low + high) / 2, (high - low) / 2)
                known = at + part
            stage(y, add, 2 * p * level, Y, level, z, nil)
            if fresh:
                for j in range(m + rub.size, f):  # a load may jump here
                    g[j] = now[row, 2 * m + j]
            else:
                _forces(g, nil, x0, now, row, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
            fresh = True
            if not noted:
                _note(acting, step, g, stiff, now, row, f)
                noted = True
            stage(x, y, nil, S, level, g, nil)
            change = opens and _changed(side, x, now, row + 1, laws)
            _forces(g, 3 * f, x, now, row + 1, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
            stage(x, y, nil, S, level, g, 3 * f)
            change = change or (opens and _changed(side, x, now, row + 1, laws))
            _forces(g, f, x, now, row + 1, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
            stage(x, y, p, T, level, g, nil)
            change = change or (opens and _changed(side, x, now, row + 2, laws))
            _forces(g, 2 * f, x, now, row + 2, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
            for i in range(f):
                g[f + i] += g[3 * f + i]
            stage(new, push, (n + p) * level, PF, level, g, nil)
            for i in range(p):  # the loads in y are those of x4, in new those of the end
                end[i] = new[n + i] + y[p + i] - add[2 * p * level + p + i]
            away = 0.0
            if held:
                _forces(last_g, nil, end, now, row + 2, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
                for i in range(f):
                    apart[i] = last_g[i] - g[2 * f + i]
                stage(doubt, none, nil, W, level, apart, nil)
                for i in range(m):
                    scale = max(scale, abs(total[i]))
                    away = max(away, abs(doubt[i]))
                    apart[i] = _turned(now[row, i], now[row + 1, i], now[row + 2, i]) * total[i]
                for i in range(m, f):
                    apart[i] = 0.0
                stage(doubt, none, nil, W, level, apart, nil)
                for i in range(m):
                    away = max(away, abs(doubt[i]))
                away = away / scale if scale > 0 else 0.0
            if level < last and (change or away > allowed or _changed(side, end, now, row + 2, laws)):
                level += 1
                counts[1] += 1
                continue
            _propagate(new, E, level, z)
            if opens:
                counts[2] += _losses(side, end, now, row + 2, laws)
            for i in range(n):
                z[i] = new[i]
            for i in range(p):
                x0[i] = end[i]
            fresh = held
            if held:
                for i in range(f):
                    g[i] = last_g[i]
            at += part
            counts[0] += 1
            if not held or away <= GROW * allowed:
                level = max(0, level - 1)
        if (step + 1) % every == 0:
            for i in range(n):
                states[(step + 1) // every, i] = z[i]
    if not silent:
        lookup(flat, now, nil, one, start, h, float(steps), 0.0)
        _forces(g, nil, x0, now, nil, laws, kind, linear, rub, total, stiff, table, shape, change_mesh)
        _note(acting, steps, g, stiff, now, nil, f)
    return steps if np.isfinite(np.sum(z)) else steps - 1
