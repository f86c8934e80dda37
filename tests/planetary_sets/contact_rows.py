"""Edges with three nodes, their normals, rows of contact between outlines, and the contact problem of all rows."""

from dataclasses import dataclass

import numpy as np


def shapes(x):
    """Shape functions of an edge ``(..., 3)`` for its ends and its middle, and their derivatives; x from -1 to 1."""
    return np.stack([x * (x - 1) / 2, 1 - x**2, x * (x + 1) / 2], -1), np.stack([x - 0.5, -2 * x, x + 0.5], -1)


def project(points, normals, chain):
    """Where rays meet a polyline ``(k, 2)``: signed distances ``(n,)``, inf where none, and the segments and places on them."""
    away = chain - points[:, None]
    side = away[..., 0] * normals[:, None, 1] - away[..., 1] * normals[:, None, 0]
    part = side[:, :-1] / np.where(side[:, :-1] == side[:, 1:], 1.0, side[:, :-1] - side[:, 1:])
    met = away[:, :-1] + part[..., None] * (away[:, 1:] - away[:, :-1])
    distance = np.einsum("nki,ni->nk", met, normals)
    distance = np.where((side[:, :-1] * side[:, 1:] <= 0) & (np.abs(distance) < 0.5), distance, np.inf)
    best = np.argmin(np.abs(distance), axis=1)
    rows = np.arange(len(points))
    return distance[rows, best], best, part[rows, best]


def outward(points, sense):
    """Unit normals out of a tooth's side ``(n, 2)``, whose points go from root to tip; `sense` 1 for the clockwise side."""
    along = np.gradient(points, axis=0)
    normal = sense * np.stack([along[:, 1], -along[:, 0]], axis=-1)
    return normal / np.hypot(*along.T)[:, None]


@dataclass
class Row:
    """Hats of pressure of a pair of teeth: kind of mesh (0 with the sun), planet, nodes of both sides."""

    kind: int
    planet: int
    own: np.ndarray
    met: np.ndarray


def pushing(flexibility, rest, ways, torque, guess):
    """Forces ``(n,)`` >= 0 and motions: gaps ``flexibility @ force + rest + ways @ motion`` are >= 0, and 0 where forces act."""
    active = rest + ways @ guess < 0
    for step in range(200):
        on, m = np.flatnonzero(active), ways.shape[1]
        matrix = np.block([[flexibility[np.ix_(on, on)], ways[on]], [ways[on].T, np.zeros((m, m))]])
        found = np.linalg.solve(matrix, -np.concatenate([rest[on], torque]))
        force, motion = np.zeros(len(rest)), found[len(on) :]
        force[on] = found[: len(on)]
        gap = flexibility @ force + rest + ways @ motion
        wrong = np.where(active, force < 0, gap < -1e-12)
        if not wrong.any():
            return force, motion
        if step > 40:  # one at a time, when all at once go in circles
            wrong &= np.arange(len(rest)) == np.flatnonzero(wrong).max()
        active ^= wrong
    raise RuntimeError("the contact does not settle")
