"""The loop of `gearfe.motion.exponential` compiled by numba: the same steps, halved at the same places, in scalar arithmetic."""

import numpy as np

from . import compiled_closed as closed
from .compiled_tables import add_columns, lookup, njit
from .exponential import UNSTABLE


def run(plan, machine, flat, z, steps, every, breaks, start=0.0):
    """As `gearfe.motion.exponential.run`."""
    if plan.affine:
        return closed.run(plan, machine, flat, z, steps, every, start)
    law, m = machine.law, len(machine.meshes)
    E, Y = (np.stack([one[i] for one in plan.levels]) for i in (0, 1))
    # columns of the matrices lie one after the other, so that the loops over them run along memory
    S, T, F = (np.stack([np.ascontiguousarray(one[i].T) for one in plan.levels]) for i in (2, 3, 4))
    PF = np.stack([np.ascontiguousarray((plan.P @ one[4]).T) for one in plan.levels])
    laws = np.array([law[key].astype(float) for key in ("power", "damping", "beta", "per_depth", "backlash", "film", "push")])
    states = np.empty((1 + steps // every, z.size))
    counts = np.zeros(3, dtype=np.int64)
    edges = np.append(np.asarray(breaks, dtype=float), np.inf)
    linear = np.stack([plan.k, plan.c])
    done = _run(E, Y, S, T, F, PF, plan.P, laws, linear, flat, edges, z.copy(), plan.h, start, every, states, counts, m)
    if done < steps:
        raise RuntimeError(f"the response grows beyond all bounds before t = {start + plan.h * done:.4g} s: {UNSTABLE}")
    return states, {"steps": int(counts[0]), "rejected": int(counts[1]), "losses": int(counts[2])}


@njit(cache=True, error_model="numpy")
def _cubic(cells, place, count, at):
    cell = min(int(at), count - 1)
    u, row = at - cell, place + cell
    return cells[row, 0] + u * (cells[row, 1] + u * (cells[row, 2] + u * cells[row, 3]))


@njit(cache=True, error_model="numpy")
def _force(x, v, k, law, i):
    """`gearfe.machine.contact_law.force` of one mesh."""
    back, slack = False, law[4, i]
    delta = max(x, 0.0)
    if x < -slack:
        back, delta = True, -slack - x
    c = law[1, i] + law[2, i] * k
    if not back and not x > 0:
        return 0.0 if law[6, i] else c * law[5, i] * v
    if law[3, i] > 0:
        u = min(delta * law[3, i], 1.0)
        c *= u * u * (3 - 2 * u)
    out = k * (delta if law[0, i] == 1.0 else delta ** law[0, i])
    out = c * v - out if back else c * v + out
    if law[6, i]:
        out = min(out, 0.0) if back else max(out, 0.0)
    return out


@njit(cache=True, error_model="numpy")
def _forces(out, x, now, laws, linear, rub_mesh, m, rates):
    """Forces of the meshes and friction rows beyond the linear part, loads; sides of contact into ``now[5]``."""
    k, e, rate, weight, load, side, total = now
    for i in range(m):
        v = x[m + i] if rates else 0.0
        own = x[i] - e[i]
        total[i] = _force(own, v - rate[i], k[i], laws, i)
        side[i] = 1.0 if own > 0 else (-1.0 if own < -laws[4, i] else 0.0)
        out[i] = total[i] - linear[0, i] * x[i] - (linear[1, i] * v if rates else 0.0)
    for j in range(rub_mesh.size):
        out[m + j] = weight[j] * total[rub_mesh[j]]
    for j in range(load.size):
        out[m + rub_mesh.size + j] = load[j]


@njit(cache=True, error_model="numpy")
def _changed(side, seen, laws):
    for i in range(side.size):  # noqa: SIM110 (numba has no generators here)
        if laws[4, i] > 0 and side[i] != seen[i]:
            return True
    return False


@njit(cache=True, error_model="numpy")
def _run(E, Y, S, T, F, PF, P, laws, linear, flat, edges, z, h, start, every, states, counts, m):
    p, f, n2, size = P.shape[0], F.shape[1] // 3, z.size, E.shape[2]
    rates, rub, last = p > m, flat.rub_mesh.size, len(E) - 1
    loads = f - m - rub
    g = np.zeros(4 * f)  # forces of the stages 1, 3, 4, 2
    f1, f3, f4, f2, f13, f134 = g[:f], g[f : 2 * f], g[2 * f : 3 * f], g[3 * f :], g[: 2 * f], g[: 3 * f]
    y, x, x0, new = np.zeros(2 * p), np.zeros(p), np.dot(P, z), np.zeros(n2)
    side, seen, total = np.zeros(m), np.zeros(m), np.zeros(m)
    k, e, rate = np.zeros((3, m)), np.zeros((3, m)), np.zeros((3, m))
    weight, load = np.zeros((3, rub)), np.zeros((3, loads))
    whole = 1 << last
    states[0] = z
    steps = (len(states) - 1) * every
    first, edge = True, 0
    known = -1.0  # time whose values stand in row 2
    for step in range(steps):
        at, level = 0, 0
        while at < whole:
            while at % (whole >> level):
                level += 1
            own = h / (1 << level)
            t = start + h * (step + at / whole)
            if known == t:
                k[0], e[0], rate[0], weight[0], load[0] = k[2], e[2], rate[2], weight[2], load[2]
            else:
                lookup(flat, t, k[0], e[0], rate[0], weight[0], load[0])
            lookup(flat, t + own / 2, k[1], e[1], rate[1], weight[1], load[1])
            _forces(f1, x0, (k[0], e[0], rate[0], weight[0], load[0], seen, total), laws, linear, flat.rub_mesh, m, rates)
            if first:
                side[:] = seen
                first = False
            while edges[edge] <= t + 1e-6 * own:
                edge += 1
            broken = last > 0 and edges[edge] < t + (1 - 1e-6) * own
            if level < last and (broken or _changed(side, seen, laws)):
                if not broken:
                    side[:] = seen  # a change exactly at the start of a step
                else:
                    level += 1
                    counts[1] += 1
                    continue
            upper = start + h * (step + (at + (whole >> level)) / whole)
            lookup(flat, upper, k[2], e[2], rate[2], weight[2], load[2])
            known = upper
            np.dot(Y[level], z, y)
            change = False
            x[:] = y[:p]
            add_columns(x, S[level], f1)
            _forces(f2, x, (k[1], e[1], rate[1], weight[1], load[1], seen, total), laws, linear, flat.rub_mesh, m, rates)
            change = change or _changed(side, seen, laws)
            x[:] = y[:p]
            add_columns(x, S[level], f2)
            _forces(f3, x, (k[1], e[1], rate[1], weight[1], load[1], seen, total), laws, linear, flat.rub_mesh, m, rates)
            change = change or _changed(side, seen, laws)
            x[:] = y[p:]
            add_columns(x, T[level], f13)
            _forces(f4, x, (k[2], e[2], rate[2], weight[2], load[2], seen, total), laws, linear, flat.rub_mesh, m, rates)
            change = change or _changed(side, seen, laws)
            for i in range(f):
                f3[i] += f2[i]
            for i in range(n2):
                value, low = 0.0, i // size * size
                for j in range(size):
                    value += E[level, i // size, i - low, j] * z[low + j]
                new[i] = value
            add_columns(new, F[level], f134)
            x[:] = y[p:]
            add_columns(x, PF[level], f134)
            if last > 0:
                for i in range(m):
                    own_x = x[i] - e[2, i]
                    seen[i] = 1.0 if own_x > 0 else (-1.0 if own_x < -laws[4, i] else 0.0)
                change = change or _changed(side, seen, laws)
                if change and level < last:
                    level += 1
                    counts[1] += 1
                    known = -1.0
                    continue
                for i in range(m):
                    if laws[4, i] > 0 and side[i] != 0.0 and seen[i] == 0.0:
                        counts[2] += 1
                side[:] = seen
            z[:] = new
            x0[:] = x
            at += whole >> level
            counts[0] += 1
            level = max(0, level - 1) if at == whole else max(1, level - 1)
        if not np.isfinite(z[0]) or not np.isfinite(np.sum(z)):
            return step
        if (step + 1) % every == 0:
            states[(step + 1) // every] = z
    return steps
