"""The step of `gearfe.motion.exponential` and the halving of `gearfe.motion.numpy_loop` in scalar arithmetic, for numba.

Loads that do not change are taken out of the stages and added at the end.
"""

from typing import NamedTuple

import numpy as np

from ..machine.contact_law import LAW, contact_force
from .exponential import UNSTABLE
from .numba_lookup import add_columns, lookup, njit

_force = njit(cache=True, error_model="numpy")(contact_force)


class Matrices(NamedTuple):
    """Those of the step by level, columns one after the other so that the loops over them run along memory.

    `PF` is ``P F`` below F: what the forces add to z, and to x at the end of the step. `add` and `push` are what constant loads
    add to y and w, and to z and P z.
    """

    E: np.ndarray
    Y: np.ndarray
    S: np.ndarray
    T: np.ndarray
    PF: np.ndarray
    add: np.ndarray
    push: np.ndarray
    P: np.ndarray


def run(plan, machine, flat, z, steps, every, breaks, start=0.0):
    """As `gearfe.motion.numpy_loop.run`."""
    count = np.diff(flat.knot_place)
    other = len(machine.meshes) + len(flat.rub_mesh)
    kept = np.concatenate([np.arange(other), other + np.flatnonzero(count > 1)]).astype(int)
    still = np.concatenate([np.zeros(other), np.where(count > 1, 0.0, flat.knots[flat.knot_place[:-1], 1][: count.size])])
    matrices = _matrices(plan, kept, still)
    changing = [
        flat.knots[low:high] for low, high in zip(flat.knot_place[:-1], flat.knot_place[1:], strict=True) if high > low + 1
    ]
    flat = flat._replace(
        knots=np.concatenate(changing) if changing else np.zeros((1, 2)), knot_place=np.cumsum([0, *map(len, changing)])
    )
    laws = np.array([machine.law[key].astype(float) for key in LAW]).T.copy()
    kind = plan.affine, bool((machine.law["power"] != 1).any()), len(plan.P) > len(machine.meshes)
    linear = np.stack([plan.k, plan.c])
    edges = np.append(np.asarray(breaks, dtype=float), np.inf)
    states, counts = np.empty((1 + steps // every, z.size)), np.zeros(3, dtype=np.int64)
    done = _run(matrices, laws, kind, linear, flat, edges, z.copy(), plan.h, start, every, states, counts)
    if done < steps:
        raise RuntimeError(f"the response grows beyond all bounds before t = {start + plan.h * done:.4g} s: {UNSTABLE}")
    return states, {"steps": int(counts[0]), "rejected": int(counts[1]), "losses": int(counts[2])}


def _matrices(plan, kept, still):
    """`Matrices` of a plan with the columns `kept` of the forces, those that are constant having the values `still`."""
    wide = still.size

    def columns(matrix):
        index = wide * np.arange(matrix.shape[1] // wide)[:, None] + kept
        return matrix[:, index.ravel()].T

    parts = []
    for E, Y, S, T, F in plan.levels:
        PF = np.concatenate([F, plan.P @ F])
        add = np.concatenate([S @ still, T @ np.concatenate([still, still])])
        push = PF @ np.concatenate([still, 2 * still, still])
        parts.append((E, Y.T, columns(S), columns(T), columns(PF), add, push))
    return Matrices(*(np.stack([np.ascontiguousarray(part) for part in one]) for one in zip(*parts, strict=True)), plan.P)


@njit(cache=True, error_model="numpy")
def _forces(out, x, now, laws, kind, linear, rub_mesh, total):
    """Forces of the meshes and friction rows beyond the linear part, and loads that change."""
    k, e, rate, weight, load = now
    affine, bent, rates = kind
    m, rub = k.size, rub_mesh.size
    for j in range(load.size):
        out[m + rub + j] = load[j]
    if affine:  # every mesh stays closed: the same, without asking where it is
        for i in range(m):
            out[i] = (k[i] - linear[0, i]) * x[i] - k[i] * e[i] - (laws[i, 1] + laws[i, 2] * k[i]) * rate[i]
        return
    for i in range(m):
        v, law = x[m + i] if rates else 0.0, laws[i]
        whole = _force(x[i] - e[i], v - rate[i], k[i], law[0], law[1], law[2], law[3], law[4], law[5], law[6], bent)
        out[i] = whole - linear[0, i] * x[i] - linear[1, i] * v
        total[i] = whole
    for j in range(rub):
        out[m + j] = weight[j] * total[rub_mesh[j]]


@njit(cache=True, error_model="numpy")
def _sides(side, x, e, laws):
    """1 where the front flanks touch, -1 the back ones, 0 none."""
    for i in range(side.size):
        own = x[i] - e[i]
        side[i] = 1.0 if own > 0 else (-1.0 if own < -laws[i, 4] else 0.0)


@njit(cache=True, error_model="numpy")
def _changed(side, x, e, laws):
    """Whether a mesh that can open is not on the side given."""
    for i in range(side.size):
        own = x[i] - e[i]
        if laws[i, 4] > 0 and side[i] != (1.0 if own > 0 else (-1.0 if own < -laws[i, 4] else 0.0)):
            return True
    return False


@njit(cache=True, error_model="numpy")
def _stage(x, base, columns, f):
    """``x = base + columns.T @ f``."""
    for i in range(x.size):
        x[i] = base[i]
    add_columns(x, columns, f)


@njit(cache=True, error_model="numpy")
def _run(matrices, laws, kind, linear, flat, edges, z, h, start, every, states, counts):
    E, Y, S, T, PF, add, push, P = matrices
    m, p, f, n, size, last = len(laws), P.shape[0], S.shape[1], z.size, E.shape[2], len(E) - 1
    rub, whole, opens = flat.rub_mesh, 1 << last, last > 0
    g = np.zeros(4 * f)  # forces of the stages 1, 3, 4, 2
    f1, f3, f4, f2, f13, f134 = g[:f], g[f : 2 * f], g[2 * f : 3 * f], g[3 * f :], g[: 2 * f], g[: 3 * f]
    y, x, x0, new, total = np.zeros(2 * p), np.zeros(p), np.dot(P, z), np.zeros(n + p), np.zeros(m)
    before, after, end = y[:p], y[p:], new[n:]
    side, seen = np.zeros(m), np.zeros(m)
    k, e, rate = np.zeros((3, m)), np.zeros((3, m)), np.zeros((3, m))
    weight, load = np.zeros((3, rub.size)), np.zeros((3, f - m - rub.size))
    low = (k[0], e[0], rate[0], weight[0], load[0])
    middle = (k[1], e[1], rate[1], weight[1], load[1])
    high = (k[2], e[2], rate[2], weight[2], load[2])
    lookup(flat, start, low)
    _sides(side, x0, e[0], laws)
    known, edge = start, 0  # time whose values stand in `low`
    states[0] = z
    steps = (len(states) - 1) * every
    for step in range(steps):
        at, level = 0, 0
        while at < whole:
            while at & ((whole >> level) - 1):
                level += 1
            part = whole >> level
            own, t = h * part / whole, start + h * (step + at / whole)
            if known != t:
                lookup(flat, t, low)
                known = t
            while edges[edge] <= t + 1e-6 * own:
                edge += 1
            broken = opens and edges[edge] < t + (1 - 1e-6) * own
            if level < last and broken:
                level += 1
                counts[1] += 1
                continue
            lookup(flat, t + own / 2, middle)
            lookup(flat, start + h * (step + (at + part) / whole), high)
            _stage(y, add[level], Y[level], z)
            _forces(f1, x0, low, laws, kind, linear, rub, total)
            _stage(x, before, S[level], f1)
            change = opens and _changed(side, x, middle[1], laws)
            _forces(f2, x, middle, laws, kind, linear, rub, total)
            _stage(x, before, S[level], f2)
            change = change or (opens and _changed(side, x, middle[1], laws))
            _forces(f3, x, middle, laws, kind, linear, rub, total)
            _stage(x, after, T[level], f13)
            change = change or (opens and _changed(side, x, high[1], laws))
            _forces(f4, x, high, laws, kind, linear, rub, total)
            for i in range(f):
                f3[i] += f2[i]
            _stage(new, push[level], PF[level], f134)
            for i in range(p):  # the loads in y are those of x4, in new those of the end
                end[i] += after[i] - add[level, p + i]
            if level < last and (change or _changed(side, end, high[1], laws)):
                level += 1
                counts[1] += 1
                continue
            _propagate(new, E[level], z, size)
            if opens:
                _sides(seen, end, high[1], laws)
                for i in range(m):
                    if laws[i, 4] > 0 and side[i] != 0.0 and seen[i] == 0.0:
                        counts[2] += 1
                side[:] = seen
            for i in range(n):
                z[i] = new[i]
            for i in range(p):
                x0[i] = end[i]
            at += part
            counts[0] += 1
            level = max(0, level - 1) if at == whole else max(1, level - 1)
            known = start + h * (step + at / whole)
            for i in range(m):
                k[0, i], e[0, i], rate[0, i] = k[2, i], e[2, i], rate[2, i]
            for i in range(rub.size):
                weight[0, i] = weight[2, i]
            for i in range(load.shape[1]):
                load[0, i] = load[2, i]
        if step % 64 == 0 and not np.isfinite(np.sum(z)):
            return step
        if (step + 1) % every == 0:
            states[(step + 1) // every] = z
    return steps if np.isfinite(np.sum(z)) else steps - 1


@njit(cache=True, error_model="numpy")
def _propagate(new, E, z, size):
    """``new[:n] += E z`` of blocks along a diagonal."""
    if size == 2:
        for j in range(len(E)):
            a, b = z[2 * j], z[2 * j + 1]
            new[2 * j] += E[j, 0, 0] * a + E[j, 0, 1] * b
            new[2 * j + 1] += E[j, 1, 0] * a + E[j, 1, 1] * b
    else:
        for i in range(z.size):
            for j in range(z.size):
                new[i] += E[0, i, j] * z[j]
