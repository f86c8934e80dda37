"""All stiffnesses, errors and loads of a machine at given times, laid out flat for few array operations per step."""

import math
from typing import NamedTuple

import numpy as np

from ..machine.contact_law import depth
from ..machine.speed import turned


class Flat(NamedTuple):
    """The tables of a machine as arrays.

    `cells` holds the coefficients of all tables one after the other. Of each mesh: place and number of its cycle's cells. Of each
    damaged tooth: its mesh, number of teeth, first cycle, and start, width, place and number of cells of the change. Of each
    sinusoid of an error: mesh, amplitude, angular frequency, phase. Of each tooth off its place the same as of a damaged one. Of
    each friction row: mesh, place and number of cells. Of each load: where its knots start and end.
    `twin` is the first mesh whose stiffness is always that of a mesh. `pace` are the knots of `machine.speed.Speed`, none
    at a constant speed.
    `secant` holds the tables of all laws of force one after the other; `shape` is, of each mesh and then of each damaged tooth,
    the place, rows and columns of its table and one over its depth [1/m], no rows where it has no law.
    """

    cells: np.ndarray
    frequency: np.ndarray
    phase: np.ndarray
    place: np.ndarray
    count: np.ndarray  # type: ignore[assignment]  # a tuple's own method of this name is not needed
    change_mesh: np.ndarray
    change: np.ndarray  # (n, 4): teeth, first, start, width
    change_place: np.ndarray
    change_count: np.ndarray
    error_mesh: np.ndarray
    error: np.ndarray  # (n, 3): amplitude, angular frequency, phase
    shift_mesh: np.ndarray
    shift: np.ndarray  # (n, 4): teeth, first, start, width
    shift_place: np.ndarray
    shift_count: np.ndarray
    rub_mesh: np.ndarray
    rub_place: np.ndarray
    rub_count: np.ndarray
    knots: np.ndarray  # (n, 2): time, value
    knot_place: np.ndarray
    twin: np.ndarray
    pace: np.ndarray  # (n, 3): time, speed over the nominal one, turned time
    secant: np.ndarray
    shape: np.ndarray  # (meshes + changes, 4)


def flatten(machine, times):
    """`Flat` of a machine; loads that are functions are sampled at `times` and linear between."""
    cells, place = [], [0]

    def add(one):
        cells.append(one.cells)
        place.append(place[-1] + len(one.cells))
        return place[-2], len(one.cells)

    meshes = machine.meshes
    cycles = [add(m.cycle) for m in meshes]
    changes, shifts = (
        [(i, z, first, change, *add(change)) for i, m in enumerate(meshes) for z, first, change in getattr(m, name)]
        for name in ("changes", "shifts")
    )
    errors = [(i, a, 2 * math.pi * f, p) for i, m in enumerate(meshes) for a, f, p in m.openings]
    rubs = [(i, *add(weight)) for i, m in enumerate(meshes) for _, weight in m.friction]
    knots = [_knots(load, times) for load in machine.loads]
    laws = [m.secants[0] if m.secants else None for m in meshes]
    laws += [m.secants[1 + j] if m.secants else None for m in meshes for j in range(len(m.changes))]
    whole = np.int64
    return Flat(
        np.concatenate(cells) if cells else np.zeros((1, 4)),
        np.array([m.frequency for m in meshes], dtype=float),
        np.array([m.phase for m in meshes], dtype=float),
        np.array([c[0] for c in cycles], dtype=whole),
        np.array([c[1] for c in cycles], dtype=whole),
        *_passing(changes),
        np.array([e[0] for e in errors], dtype=whole),
        np.array([e[1:] for e in errors], dtype=float).reshape(-1, 3),
        *_passing(shifts),
        np.array([r[0] for r in rubs], dtype=whole),
        np.array([r[1] for r in rubs], dtype=whole),
        np.array([r[2] for r in rubs], dtype=whole),
        np.concatenate(knots) if knots else np.zeros((1, 2)),
        np.cumsum([0, *map(len, knots)]).astype(whole),
        np.array([next(j for j, other in enumerate(meshes) if _twins(m, other)) for m in meshes], dtype=whole),
        np.zeros((0, 3)) if machine.speed is None else machine.speed.knots,
        *_laid_out(laws),
    )


def _passing(changes):
    """Meshes, ``(n, 4)`` numbers, places and counts of cells of what comes with a tooth."""
    whole = np.int64
    return (
        np.array([c[0] for c in changes], dtype=whole),
        np.array([(c[1], c[2], c[3].start, c[3].width) for c in changes], dtype=float).reshape(-1, 4),
        np.array([c[4] for c in changes], dtype=whole),
        np.array([c[5] for c in changes], dtype=whole),
    )


def _laid_out(laws):
    """`Flat.secant` and `Flat.shape` of laws; one that several meshes share is laid out once."""
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
    """Whether two meshes have the same stiffness at all times, as those of both halves of a herringbone gear."""
    ahead = one.phase - two.phase
    ahead = ahead if one.changes else ahead - round(ahead)  # only damaged teeth ask for whole cycles
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
    if np.ndim(load.value) == 0:
        return np.array([[0.0, float(load.value)]])
    return np.stack([np.asarray(part, dtype=float) for part in load.value], axis=1)


def stiffness(flat, t):
    """Stiffness of all meshes at times `t` ``(..., m)`` and the running phases; of laws of force that under the law's `force`."""
    phase = flat.phase + flat.frequency * _paced(flat, t)[0][..., None]
    k = _value(flat, phase - np.floor(phase), flat.place, flat.count)
    for mesh, c, u, _ in _passed(flat, phase, flat.change_mesh, flat.change, flat.change_place, flat.change_count):
        k[..., mesh] += c[..., 0] + u * (c[..., 1] + u * (c[..., 2] + u * c[..., 3]))
    return (np.maximum(k, 0.0) if len(flat.change_mesh) else k), phase


def _passed(flat, phase, meshes, teeth, places, counts):
    """What comes with a tooth at running phases: mesh, coefficients (0 where it is out of mesh), place in its cell and width."""
    for mesh, (z, first, start, width), place, count in zip(meshes, teeth, places, counts, strict=True):
        tooth_phase = phase[..., mesh] - first - start
        tooth_phase = (tooth_phase - z * np.floor(tooth_phase / z)) / width
        inside = tooth_phase < count
        if inside.any():
            cell = np.minimum(tooth_phase, count - 1).astype(np.int64)
            yield mesh, np.where(inside[..., None], flat.cells[place + cell], 0.0), tooth_phase - cell, width


def stiffness_at(machine, flat, t, x):
    """Stiffness of all meshes at times `t` and compressions `x` ``(..., m)``, its derivative by the depth, the running phases."""
    k, phase = stiffness(flat, t)
    if not flat.secant.size:
        return k, np.zeros_like(k), phase
    deep, bend = depth(x, machine.law), np.zeros_like(k)
    for i, mesh in enumerate(machine.meshes):
        if not mesh.secants:
            continue
        healthy, *hurt = mesh.secants
        k[..., i], bend[..., i] = healthy(phase[..., i] % 1.0, deep[..., i])
        for (z, first, _), change in zip(mesh.changes, hurt, strict=True):
            start, end = change.start + change.width, change.end - change.width
            tooth_phase = phase[..., i] - first - start
            tooth_phase = tooth_phase - z * np.floor(tooth_phase / z) + start
            beyond = change(tooth_phase, deep[..., i])
            inside = tooth_phase < end
            k[..., i] += np.where(inside, beyond[0], 0.0)
            bend[..., i] += np.where(inside, beyond[1], 0.0)
    return np.maximum(k, 0.0), np.where(k > 0, bend, 0.0), phase


def changing(machine, flat):
    """Which of the forces of meshes, friction rows and loads change, and the values of those that do not (0 for the others)."""
    count = np.diff(flat.knot_place)
    other = len(machine.meshes) + len(flat.rub_mesh)
    kept = np.concatenate([np.arange(other), other + np.flatnonzero(count > 1)]).astype(int)
    still = np.where(count > 1, 0.0, flat.knots[flat.knot_place[:-1], 1][: count.size])
    return kept, np.concatenate([np.zeros(other), still])


def _paced(flat, t):
    """Turned times at times `t`, and the speed over the nominal one."""
    t = np.asarray(t, dtype=float)
    return (turned(flat.pace, t), np.interp(t, flat.pace[:, 0], flat.pace[:, 1])) if len(flat.pace) else (t, 1.0)


def _value(flat, part, place, count):
    at = part * count
    cell = np.minimum(at.astype(np.int64), count - 1)
    c, u = flat.cells[place + cell], at - cell
    return c[..., 0] + u * (c[..., 1] + u * (c[..., 2] + u * c[..., 3]))


def errors(flat, t):
    """Errors [m] of all meshes at times `t` and their rates [m/s], ``(..., m)`` each."""
    t, pace = _paced(flat, t)
    e, rate = np.zeros((*t.shape, len(flat.phase))), np.zeros((*t.shape, len(flat.phase)))
    for mesh, (amplitude, omega, angle) in zip(flat.error_mesh, flat.error, strict=True):
        e[..., mesh] += amplitude * np.sin(omega * t + angle)
        rate[..., mesh] += amplitude * omega * pace * np.cos(omega * t + angle)
    phase = flat.phase + flat.frequency * t[..., None]
    for mesh, c, u, width in _passed(flat, phase, flat.shift_mesh, flat.shift, flat.shift_place, flat.shift_count):
        e[..., mesh] += c[..., 0] + u * (c[..., 1] + u * (c[..., 2] + u * c[..., 3]))
        rate[..., mesh] += (c[..., 1] + u * (2 * c[..., 2] + 3 * u * c[..., 3])) * flat.frequency[mesh] * pace / width
    return e, rate


def rubbing(flat, phase):
    """Weights of the friction rows at running phases ``(..., m)``: ``(..., rows)``."""
    part = phase[..., flat.rub_mesh]
    return _value(flat, part - np.floor(part), flat.rub_place, flat.rub_count)


def loads(flat, t):
    """Values of all loads at times `t` ``(..., loads)``."""
    t = np.asarray(t, dtype=float)
    out = np.empty((*t.shape, len(flat.knot_place) - 1))
    for i, (low, high) in enumerate(zip(flat.knot_place[:-1], flat.knot_place[1:], strict=True)):
        out[..., i] = np.interp(t, flat.knots[low:high, 0], flat.knots[low:high, 1])
    return out
