"""Excitation of a machine over time: as arrays from its meshes and loads, and as flat tables for the fast integrator."""

import math
from typing import NamedTuple

import numpy as np

from ..machine.contact_law import depth


class Flat(NamedTuple):
    """Tables of a machine as arrays for compiled functions.

    - `cells` are the cubic coefficients of all `machine.phase_table.PhaseTable` in sequence.
    - `cycle` (of each mesh), `change` (of each damaged tooth), `shift` (of each tooth with a position error) and `rub` (of
      each friction row) are records. Their fields are `mesh`, the cycles until they recur (`period`), the first of them,
      `start` and `width` of the table, and the position (`place`) and number (`size`) of its cells.
    - `error` has a record for each sinusoid of the errors: `mesh`, `amplitude`, angular frequency `omega` and phase `angle`.
    - `knots` are the times and values of all loads, and `knot_place` the first and last of each load.
    - `twin` is, for each mesh, the first mesh that always has the same stiffness.
    - `pace` are the knots of `machine.speed.Speed`, none at constant speed.
    - `secant` are the tables of all force laws in sequence. `shape` has for each mesh, then for each damaged tooth, the
      position, rows and columns of its table and the reciprocal of its depth [1/m]. Without a law there are no rows.
    """

    cells: np.ndarray
    frequency: np.ndarray
    phase: np.ndarray
    cycle: np.ndarray
    change: np.ndarray
    shift: np.ndarray
    rub: np.ndarray
    error: np.ndarray
    knots: np.ndarray  # (n, 2): time, value
    knot_place: np.ndarray
    twin: np.ndarray
    pace: np.ndarray  # (n, 3): time, speed over the nominal one, angle of rotation
    secant: np.ndarray
    shape: np.ndarray  # (meshes + changes, 4)


def records(**columns):
    """Structured array from arrays of equal length: ``records(k=a, c=b)[i].k`` is ``a[i]``."""
    dtype = np.dtype([(name, values.dtype) for name, values in columns.items()], align=True)
    out = np.empty(len(next(iter(columns.values()))), dtype)
    for name, values in columns.items():
        out[name] = values
    return out


def _columns(rows, **types):
    """Structured array from rows, with the names and types of their columns."""
    columns = list(zip(*rows, strict=True)) or [()] * len(types)
    return records(**{name: np.array(column, kind) for (name, kind), column in zip(types.items(), columns, strict=True)})


def flatten(machine, times):
    """`Flat` of a machine. Loads that are functions are sampled at `times` and linear between."""
    whole, number, meshes = np.int64, float, machine.meshes
    knots = [_knots(load, times) for load in machine.loads]
    errors = [(i, size, 2 * math.pi * f, angle) for i, m in enumerate(meshes) for size, f, angle in m.openings]
    groups = _tables(meshes)
    cells = [np.zeros((1, 4)), *(table.cells for group in groups for *_, table in group)]
    places = iter(np.cumsum([*map(len, cells)]).tolist())
    tables = [_placed(group, places) for group in groups]
    twins = [next(j for j, other in enumerate(meshes) if _twins(m, other)) for m in meshes]
    return Flat(
        np.concatenate(cells),
        np.array([m.frequency for m in meshes], dtype=float),
        np.array([m.phase for m in meshes], dtype=float),
        *tables,
        _columns(errors, mesh=whole, amplitude=number, omega=number, angle=number),
        np.concatenate([*knots, np.zeros((0 if knots else 1, 2))]),
        np.cumsum([0, *map(len, knots)]).astype(whole),
        np.array(twins, dtype=whole),
        np.zeros((0, 3)) if machine.speed is None else machine.speed.knots,
        *_laid_out(meshes),
    )


def _tables(meshes):
    """Return entries (mesh, period, first, table) of cycles, damaged teeth, teeth with position errors and friction rows."""
    numbered = list(enumerate(meshes))
    cycles = [(i, 1.0, 0.0, mesh.cycle) for i, mesh in numbered]
    teeth = [[(i, *one) for i, mesh in numbered for one in getattr(mesh, kind)] for kind in ("changes", "shifts")]
    return cycles, *teeth, [(i, 1.0, 0.0, weight) for i, mesh in numbered for _, weight in mesh.friction]


def _placed(group, places):
    """Return the entries as records. Each record contains the next of the `places` as the start of its cells."""
    kinds = {
        "mesh": np.int64,
        "period": float,
        "first": float,
        "start": float,
        "width": float,
        "place": np.int64,
        "size": np.int64,
    }
    return _columns([(*at, one.start, one.width, next(places), len(one.cells)) for *at, one in group], **kinds)


def _laid_out(meshes):
    """Return `Flat.secant` and `Flat.shape` of the force laws of meshes. A law shared by several meshes is stored once."""
    laws = [m.secants[0] if m.secants else None for m in meshes]
    laws += [m.secants[1 + j] if m.secants else None for m in meshes for j in range(len(m.changes))]
    places, parts, shape, end = {}, [np.zeros(0)], [], 0
    for law in laws:
        if law is None:
            shape.append((0, 0, 0, 0))
            continue
        if id(law.k) not in places:
            places[id(law.k)] = end
            parts.append(law.k.T.ravel())
            end += law.k.size
        shape.append((places[id(law.k)], *law.k.shape, 1 / law.deepest))
    return np.concatenate(parts), np.array(shape, dtype=float).reshape(-1, 4)


def _twins(one, two):
    """Return whether two meshes always have the same stiffness, as both halves of a herringbone gear do."""
    ahead = one.phase - two.phase
    ahead = ahead if one.changes else ahead - round(ahead)  # Whole cycles matter only with damaged teeth.
    if (one.frequency, len(one.changes)) != (two.frequency, len(two.changes)) or abs(ahead) > 1e-12:
        return False
    pairs = list(zip(one.changes, two.changes, strict=True))
    tables = [(one.cycle, two.cycle), *((a[2], b[2]) for a, b in pairs)]
    alike = all((a.start, a.width) == (b.start, b.width) and np.array_equal(a.cells, b.cells) for a, b in tables)
    same = len(one.secants) == len(two.secants) and all(
        a is b or (a.deepest == b.deepest and np.array_equal(a.k, b.k)) for a, b in zip(one.secants, two.secants, strict=True)
    )
    return same and alike and all(a[:2] == b[:2] for a, b in pairs)


def _knots(load, times):
    if callable(load.value):
        return np.stack([times, load(times)], axis=1)
    return np.stack(load.value, axis=1) if isinstance(load.value, tuple) else np.array([[0.0, load.value]])


def changing(machine, flat):
    """Return the indices of varying forces of meshes, friction rows and loads, and the values of constant ones (else 0)."""
    count = np.diff(flat.knot_place)
    other = len(machine.meshes) + len(flat.rub)
    kept = np.concatenate([np.arange(other), other + np.flatnonzero(count > 1)]).astype(int)
    still = np.where(count > 1, 0.0, flat.knots[flat.knot_place[:-1], 1][: count.size])
    return kept, np.concatenate([np.zeros(other), still])


def turned(machine, t):
    """Return the times at which gears at nominal speed reach the same rotation as at times `t`, and the relative speed."""
    t = np.asarray(t, dtype=float)
    return (t, 1.0) if machine.speed is None else (machine.speed.turned(t), machine.speed(t))


def stiffness(machine, t, x):
    """Return mesh stiffnesses at times `t` and compressions `x` ``(..., m)``, their derivatives by depth, and running phases."""
    time, deep = turned(machine, t)[0], depth(x, machine.law)
    phase, k, bend = np.zeros((3, *np.shape(x)))
    for i, mesh in enumerate(machine.meshes):
        phase[..., i] = mesh.phase + mesh.frequency * time
        k[..., i], bend[..., i] = mesh.pressed(phase[..., i], deep[..., i])
    return k, bend, phase


def errors(machine, t):
    """Errors [m] of all meshes at times `t` and their rates [m/s], ``(..., m)`` each."""
    time, pace = turned(machine, t)
    e, rate = np.zeros((2, *time.shape, len(machine.meshes)))
    for i, mesh in enumerate(machine.meshes):
        if mesh.openings or mesh.shifts:
            e[..., i], rate[..., i] = mesh.e(time)
    return e, rate * np.asarray(pace)[..., None]


def rubbing(machine, phase):
    """Return friction rows ``(rows, n)``, their meshes ``(rows,)``, and their weights at running phases ``(..., m)``."""
    friction = [(row, i, weight) for i, mesh in enumerate(machine.meshes) for row, weight in mesh.friction]
    weights = [weight(phase[..., i] % 1.0) for _, i, weight in friction]
    rows = np.array([row for row, *_ in friction]).reshape(-1, len(machine.dofs))
    return rows, [i for _, i, _ in friction], np.moveaxis(np.reshape(weights, (-1, *phase.shape[:-1])), 0, -1)
