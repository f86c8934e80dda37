"""Time integration by steps of `gearfe.dynamics.motion.propagator`, in scalar arithmetic compiled by numba.

A step in which a mesh opens or closes, or a load has a kink, is halved up to `motion.propagator.LEVELS` times around this time.
Under a nonlinear contact law, a step is also halved if its estimated error (`motion.propagator.RunMatrices.told`) is too large.
The coefficients of such a machine change steeply where flanks come into contact, and smoothly elsewhere. Constant loads are not
part of the stages and are added at the end.
"""

from typing import NamedTuple

import numpy as np

from .excitation import changing, records
from .loop_forces import changed, forces, loads, losses, note
from .loop_parts import compiled, kept, lookup, stage
from .propagator import UNSTABLE

GROW = 0.05  # part of the allowed estimate below which the next step is twice as long (the estimate grows as its fourth power)
TINY = 1e-300  # least scale of the estimate [N], for unloaded meshes
CHUNK = 64  # number of steps whose stiffnesses are interpolated together


class Matrices(NamedTuple):
    """Matrices of the step by level, stored by columns, so that loops run along consecutive memory.

    `PF` is ``P F`` below F: the contribution of the forces to z, and to x at the end of the step. `add` and `push` are the
    contributions of constant loads to y and w, and to z and P z, level after level in one row. `W` is described in
    `gearfe.dynamics.motion.propagator.RunMatrices.told`.
    """

    E: np.ndarray
    Y: np.ndarray
    S: np.ndarray
    T: np.ndarray
    PF: np.ndarray
    add: np.ndarray
    push: np.ndarray
    W: np.ndarray


def run(plan, machine, flat, z, steps, every, start=0.0, acting=None):
    """Integrate `steps` steps from `z` at time `start`. Return the state after each `every` steps, and counts.

    Parameters
    ----------
    acting : ndarray, shape (1 + steps, f + m or f + 2m), optional
        Filled with what acts before each step and after the last: the f forces that change
        (`gearfe.dynamics.motion.excitation.changing`), the stiffnesses of the meshes, and their errors if there is room.

    Returns
    -------
    states : ndarray, shape (1 + steps // every, 2n)
    stats : dict
        ``steps`` done, ``rejected`` for a change of contact, ``losses`` of contact.
    """
    matrices = _matrices(plan, *changing(machine, flat))
    bends = [flat.knots[low:high] for low, high in zip(flat.knot_place[:-1], flat.knot_place[1:], strict=True) if high > low + 1]
    flat = flat._replace(knots=np.concatenate(bends) if bends else np.zeros((1, 2)), knot_place=np.cumsum([0, *map(len, bends)]))
    m, rubs = len(machine.meshes), len(flat.rub)
    extra = {"k_linear": plan.k, "c_linear": plan.c, "total": plan.k, "stiff": plan.k, "lawful": flat.shape[:m, 1] > 0}
    laws = records(**machine.law, **extra, affine=np.full(m, plan.affine), rubs=np.full(m, rubs))
    _, rows, columns, per_depth = np.insert(flat.shape, [m] * rubs, 0.0, axis=0).T
    mesh = np.concatenate([np.arange(m), flat.rub["mesh"], flat.change["mesh"]])
    parts = records(mesh=mesh, rows=rows, columns=columns, per_depth=per_depth)
    edges = np.append(np.unique(np.concatenate([np.empty(0), *(load.breaks for load in machine.loads)])), np.inf)
    states, counts = np.empty((1 + steps // every, z.size)), np.zeros(3, dtype=np.int64)
    clock = float(start), plan.h, every, plan.allowed, plan.scale
    acting = np.zeros((0, 0)) if acting is None else acting
    p, f = len(plan.P), matrices.S.shape[1]
    now = np.zeros((2 * CHUNK + 4, 2 * m + f + (2 * len(flat.shape) if flat.secant.size else 0)))
    work = now, *(np.zeros(size) for size in (5 * f, f, m, m, m, 2 * p, p, z.size + p, p))
    done = _run((matrices, laws, parts, flat, edges, work), z.copy(), plan.P @ z, clock, states, counts, acting)
    if done < steps:
        raise RuntimeError(f"the response grows beyond all bounds before t = {start + plan.h * done:.4g} s: {UNSTABLE}")
    return states, {"steps": int(counts[0]), "rejected": int(counts[1]), "losses": int(counts[2])}


def _matrices(plan, kept, still):
    """Return the `Matrices` of a plan with the force columns `kept`. Constant forces have the values `still`."""
    wide = max(still.size, 1)  # no load acts

    def columns(matrix):
        index = wide * np.arange(matrix.shape[1] // wide)[:, None] + kept
        return matrix[:, index.ravel()].T

    parts = []
    for (E, Y, S, T, F), estimate in zip(plan.levels, plan.told, strict=True):
        PF = np.concatenate([F, plan.P @ F])
        add = np.concatenate([S @ still, T @ np.concatenate([still, still])])
        push = PF @ np.concatenate([still, 2 * still, still])
        parts.append((E, Y.T, columns(S), columns(T), columns(PF), add, push, columns(estimate)))
    E, Y, S, T, PF, add, push, W = (
        np.stack([np.ascontiguousarray(part) for part in by_level]) for by_level in zip(*parts, strict=True)
    )
    return Matrices(E, Y, S, T, PF, add.ravel(), push.ravel(), W)


@compiled
def _largest(out, none, W, level, apart, size):
    """Return the largest mesh force caused by the forces `apart` at the end of a step, or `size` if that is larger."""
    stage(out, none, np.int64(0), W, level, apart, np.int64(0))
    for i in range(out.size):
        size = max(size, abs(out[i]))
    return size


@compiled
def _turned(apart, now, row, laws, scale):
    """Write the curvature of stiffnesses in a step times the forces into `apart`. Return the largest force (or `scale`)."""
    for i in range(apart.size):
        apart[i] = 0.0
    for i in range(laws.size):
        first, middle, last = now[row, i], now[row + 1, i], now[row + 2, i]
        apart[i] = (first - 2 * middle + last) / middle * laws[i].total if middle > 0 else 0.0
        scale = max(scale, abs(laws[i].total))
    return scale


@compiled
def _propagate(new, E, level, z):
    """Add ``E[level] z`` of diagonal blocks to ``new[:n]``."""
    if E.shape[2] == 2:
        for j in range(E.shape[1]):
            a, b = z[2 * j], z[2 * j + 1]
            new[2 * j] += E[level, j, 0, 0] * a + E[level, j, 0, 1] * b
            new[2 * j + 1] += E[level, j, 1, 0] * a + E[level, j, 1, 1] * b
    else:
        for i in range(z.size):
            for j in range(z.size):
                new[i] += E[level, 0, i, j] * z[j]


@compiled
def _copy(out, values, first):
    """Copy ``values[first:]`` to `out`, as many numbers as both arrays have."""
    for i in range(min(out.size, values.size - first)):
        out[i] = values[first + i]


@compiled
def _write(states, row, z):  # written as a loop, because numba needs 2 s to compile the error message of an array assignment
    for i in range(z.size):
        states[row, i] = z[i]


@compiled
def _finite(z):
    """Return whether all numbers are finite."""
    for i in range(z.size):  # noqa: SIM110 (numba has no generators here)
        if not abs(z[i]) < np.inf:
            return False
    return True


@compiled
def _add(g, first, second):
    """Add the forces of one stage to those of another. Each stage occupies a fifth of `g`."""
    for i in range(g.size // 5):
        g[first + i] += g[second + i]


@compiled
def _aligned(at, whole, level):
    """Return the lowest level, from `level` on, whose parts can begin at `at` of `whole`: at multiples of their length."""
    while at & ((whole >> level) - 1):
        level += 1
    return level


@compiled
def _ended(end, new, y, add, at):
    """Write the inputs of the forces at the end of a step into `end`. Loads of the last stage are replaced by new ones."""
    for i in range(end.size):
        end[i] = new[new.size - end.size + i] + y[end.size + i] - add[at + end.size + i]


@compiled
def _less(apart, g):
    """Return the forces at the end of a step minus the forces of its last stage."""
    f = apart.size
    for i in range(f):
        apart[i] = g[4 * f + i] - g[2 * f + i]


@compiled
def _edge(edges, edge, t):
    """Return the index of the first edge after time `t`, searched from `edge` on."""
    while edges[edge] <= t:
        edge += 1
    return edge


@compiled
def _of_part(flat, now, follows, start, h, low, high):
    """Evaluate the excitation of a part of a step into the last three rows.

    `follows`: it starts where the part before ended.
    """
    begin = now.shape[0] - 3
    if follows:
        for i in range(now.shape[1]):
            now[begin, i] = now[begin + 2, i]
    else:
        lookup(flat, now, begin, begin + 1, start, h, low, 0.0)
    lookup(flat, now, begin + 1, begin + 3, start, h, (low + high) / 2, (high - low) / 2)


@kept
def _run(given, z, x0, clock, states, counts, acting):
    """Integrate all steps into `states`, `counts` and `acting`. Return the number of steps with a finite state.

    The state `z` and the inputs `x0` of its forces are changed in place. Inside the loops no array is sliced or taken from a
    tuple, because reference counting costs as much as the arithmetic. Functions of numpy are avoided, because each takes 0.1 to
    0.5 s to compile.
    """
    matrices, laws, parts, flat, edges, work = given
    E, Y, S, T, PF, add, push, W = matrices
    # `g`: forces of the stages 1, 3, 4, 2 and at the end; `apart`: their difference from stage 4
    now, g, apart, none, doubt, side, y, x, new, end = work
    start, h, every, allowed, scale = clock
    m, p, f, n, last, rubs, table = laws.size, x.size, apart.size, z.size, len(E) - 1, flat.rub.size, flat.secant
    whole, opens, begin, held = 1 << last, last > 0, 2 * CHUNK + 1, allowed < np.inf  # `begin`: first row of a part of a step
    fresh = False  # whether the first forces equal those at the end of the previous step
    nil, one = np.int64(0), np.int64(1)  # typed constants, because numba compiles a function for every literal
    edge, level = nil, nil
    lookup(flat, now, nil, one, start, h, 0.0, 0.0)
    losses(side, x0, now, nil, laws)
    _write(states, nil, z)
    steps = (len(states) - 1) * every
    for step in range(steps):
        if step % CHUNK == 0:
            if not _finite(z):
                return step
            lookup(flat, now, nil, 2 * min(CHUNK, steps - step) + 1, start, h, float(step), 0.5)
        at, known, noted = nil, -one, len(acting) == 0  # `known`: the part of the step whose end is in the last row
        level = level if held else nil
        while at < whole:
            level = _aligned(at, whole, level)
            part = whole >> level
            low, high = step + at / whole, step + (at + part) / whole
            edge = _edge(edges, edge, start + h * (low + 1e-6 * (high - low)))
            if level < last and edges[edge] < start + h * (high - 1e-6 * (high - low)):
                level += 1
                counts[1] += 1
                continue
            row = begin if level > 0 else 2 * (step % CHUNK)
            if level > 0:
                _of_part(flat, now, known == at, start, h, low, high)
                known = at + part
            stage(y, add, 2 * p * level, Y, level, z, nil)
            if fresh:
                loads(g, now, row, m, rubs)
            else:
                forces(g, nil, x0, now, row, laws, parts, table)
            fresh = True
            if not noted:
                note(acting, step, g, now, row, laws)
                noted = True
            stage(x, y, nil, S, level, g, nil)
            change = opens and changed(side, x, now, row + 1, laws)
            forces(g, 3 * f, x, now, row + 1, laws, parts, table)
            stage(x, y, nil, S, level, g, 3 * f)
            change = change or (opens and changed(side, x, now, row + 1, laws))
            forces(g, f, x, now, row + 1, laws, parts, table)
            stage(x, y, p, T, level, g, nil)
            change = change or (opens and changed(side, x, now, row + 2, laws))
            forces(g, 2 * f, x, now, row + 2, laws, parts, table)
            _add(g, f, 3 * f)
            stage(new, push, (n + p) * level, PF, level, g, nil)
            _ended(end, new, y, add, 2 * p * level)
            change = change or (opens and changed(side, end, now, row + 2, laws))
            away = 0.0
            if held:
                forces(g, 4 * f, end, now, row + 2, laws, parts, table)
                _less(apart, g)
                away = _largest(doubt, none, W, level, apart, away)
                scale = _turned(apart, now, row, laws, scale)
                away = _largest(doubt, none, W, level, apart, away) / max(scale, TINY)
            if level < last and (change or away > allowed):
                level += 1
                counts[1] += 1
                continue
            _propagate(new, E, level, z)
            if opens:
                counts[2] += losses(side, end, now, row + 2, laws)
            _copy(z, new, nil)
            _copy(x0, end, nil)
            if held:
                _copy(g, g, 4 * f)
            fresh = held
            at += part
            counts[0] += 1
            level = level - 1 if level > 0 and away <= GROW * allowed else level
        if (step + 1) % every == 0:
            _write(states, (step + 1) // every, z)
    if len(acting):
        lookup(flat, now, nil, one, start, h, float(steps), 0.0)
        forces(g, nil, x0, now, nil, laws, parts, table)
        note(acting, steps, g, now, nil, laws)
    return steps if _finite(z) else steps - 1
