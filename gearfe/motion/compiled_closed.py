"""The loop of `gearfe.motion.exponential` for meshes that stay closed, compiled by numba: no laws, constant loads taken out."""

import numpy as np

from .compiled_tables import add_columns, lookup, njit
from .exponential import UNSTABLE


def run(plan, machine, flat, z, steps, every, start=0.0):
    """As `gearfe.motion.exponential.run`."""
    m, law = len(machine.meshes), machine.law
    E, Y, S, T, F = plan.levels[0]
    count = np.diff(flat.knot_place)
    loads, wide = np.array([flat.knots[i, 1] for i in flat.knot_place[:-1]]), S.shape[1]
    kept = np.concatenate([np.arange(m), m + np.flatnonzero(count > 1)]).astype(int)
    still = np.concatenate([np.zeros(m), np.where(count > 1, 0.0, loads)])

    def columns(matrix):  # one after the other, so that loops over them run along memory
        index = wide * np.arange(matrix.shape[1] // wide)[:, None] + kept
        return np.ascontiguousarray(matrix[:, index.ravel()].T)

    F = np.concatenate([F, plan.P @ F])  # what the forces add to z, and to x at the end of the step
    push = F @ np.concatenate([still, 2 * still, still])
    parts = np.ascontiguousarray(Y.T), columns(S), columns(T), columns(F), plan.P
    add = np.concatenate([S @ still, T @ np.concatenate([still, still])])
    states = np.empty((1 + steps // every, z.size))
    damping = np.stack([law["damping"], law["beta"]])
    done = _run(E, *parts, add, push, plan.k, damping, flat, z.copy(), plan.h, start, every, states)
    if done < steps:
        raise RuntimeError(f"the response grows beyond all bounds before t = {start + plan.h * done:.4g} s: {UNSTABLE}")
    return states, {"steps": steps, "rejected": 0, "losses": 0}


@njit(cache=True, error_model="numpy")
def _lines(slope, shift, k0, damping, k, e, rate, load):
    """``f = slope x + shift`` of meshes, and the loads that change."""
    m = k.size
    for i in range(m):
        slope[i] = k[i] - k0[i]
        shift[i] = -k[i] * e[i] - (damping[0, i] + damping[1, i] * k[i]) * rate[i]
    for i in range(shift.size - m):
        shift[m + i] = load[i]


@njit(cache=True, error_model="numpy")
def _affine(out, slope, x, shift):
    m = slope.size
    for i in range(m):
        out[i] = slope[i] * x[i] + shift[i]
    for i in range(m, out.size):
        out[i] = shift[i]


@njit(cache=True, error_model="numpy")
def _run(E, Y, S, T, F, P, add, push, k0, damping, flat, z, h, start, every, states):
    m, f, n2, blocks, size = P.shape[0], S.shape[0], z.size, E.shape[0], E.shape[1]
    g = np.zeros(4 * f)  # forces of the stages 1, 3, 4, 2
    f1, f3, f4, f2, f13, f134 = g[:f], g[f : 2 * f], g[2 * f : 3 * f], g[3 * f :], g[: 2 * f], g[: 3 * f]
    y, x, x0, new = np.zeros(2 * m), np.zeros(m), np.dot(P, z), push.copy()
    k, e, rate, weight = np.zeros(m), np.zeros(m), np.zeros(m), np.zeros(0)
    every_load, load = np.zeros(flat.knot_place.size - 1), np.zeros(f - m)
    slope, shift, before, after = np.zeros(m), np.zeros(f), y[:m], y[m:]
    new_z, new_x, added = new[:n2], new[n2:], add[m:]
    lookup(flat, start, k, e, rate, weight, every_load)
    _changing(load, flat, every_load)
    _lines(slope, shift, k0, damping, k, e, rate, load)
    states[0] = z
    for step in range((len(states) - 1) * every):
        _set(y, add)
        add_columns(y, Y, z)
        _affine(f1, slope, x0, shift)  # still those of the end of the step before
        lookup(flat, start + h * (step + 0.5), k, e, rate, weight, every_load)
        _changing(load, flat, every_load)
        _lines(slope, shift, k0, damping, k, e, rate, load)
        _set(x, before)
        add_columns(x, S, f1)
        _affine(f2, slope, x, shift)
        _set(x, before)
        add_columns(x, S, f2)
        _affine(f3, slope, x, shift)
        lookup(flat, start + h * (step + 1), k, e, rate, weight, every_load)
        _changing(load, flat, every_load)
        _lines(slope, shift, k0, damping, k, e, rate, load)
        _set(x, after)
        add_columns(x, T, f13)
        _affine(f4, slope, x, shift)
        for i in range(f):
            f3[i] += f2[i]
        _set(new, push)
        add_columns(new, F, f134)
        if size == 2:
            for j in range(blocks):
                a, b = z[2 * j], z[2 * j + 1]
                new[2 * j] += E[j, 0, 0] * a + E[j, 0, 1] * b
                new[2 * j + 1] += E[j, 1, 0] * a + E[j, 1, 1] * b
        else:
            for i in range(n2):
                for j in range(n2):
                    new[i] += E[0, i, j] * z[j]
        _set(z, new_z)
        for i in range(m):  # the loads in y are those of x4, in new those of the end
            x0[i] = new_x[i] + after[i] - added[i]
        if step % 64 == 0 and not np.isfinite(np.sum(z)):
            return step
        if (step + 1) % every == 0:
            _set(states[(step + 1) // every], z)
    return (len(states) - 1) * every if np.isfinite(np.sum(z)) else (len(states) - 1) * every - 1


@njit(cache=True, error_model="numpy")
def _set(out, values):
    for i in range(out.size):
        out[i] = values[i]


@njit(cache=True, error_model="numpy", inline="always")
def _changing(load, flat, values):
    """Loads with more than one knot."""
    place = 0
    for j in range(values.size):
        if flat.knot_place[j + 1] - flat.knot_place[j] > 1:
            load[place] = values[j]
            place += 1
