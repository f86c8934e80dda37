"""Edges with three nodes, their normals, and rows of contact between outlines."""

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
