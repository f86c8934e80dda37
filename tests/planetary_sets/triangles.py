"""Plane bodies of curved triangles with six nodes, assembled by numpy on points of a quadtree that scipy triangulates.

Nothing of gearfe, scikit-fem or gmsh is used.
"""

import numpy as np
from matplotlib.path import Path
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay, cKDTree

GROWTH = 0.25  # growth of the edge length with the distance from outlines and marks


class Mesher:
    """Triangles inside closed outlines, from the centres of a quadtree's cells; edge lengths grow from marks and outlines."""

    def __init__(self, loops, chain, size):
        """`loops` ``(2 n, 2)``: vertices and edge middles in turn. `chain` ``(k, 2)``: a slit after its mouth."""
        corners = [loop[::2] for loop in loops]
        self.outlines, self.chain = [Path(np.vstack([one, one[:1]]), closed=True) for one in corners], chain
        steps = np.concatenate([np.hypot(*(np.roll(one, -1, axis=0) - one).T) for one in corners])
        self.fixed = np.vstack([*corners, chain])
        spread = np.concatenate([steps, _gaps(chain)]) if len(chain) else steps
        self.tree, self.steps, self.wanted = cKDTree(self.fixed), spread, size
        self.edges = self._edges(corners, chain)

    @staticmethod
    def _edges(corners, chain):
        out, start = [], 0
        for one in corners:
            here = np.arange(start, start + len(one))
            out.append(np.stack([here, np.roll(here, -1)], axis=1))
            start += len(one)
        slit = np.arange(start, start + len(chain))
        return np.vstack([*out, np.stack([slit[:-1], slit[1:]], axis=1)]) if len(chain) else np.vstack(out)

    def size(self, points):
        away, nearest = self.tree.query(points)
        return np.minimum(self.wanted(points), self.steps[nearest] + GROWTH * away)

    def inside(self, points):
        return self.outlines[0].contains_points(points) ^ self.outlines[1].contains_points(points)

    def triangles(self):
        """Points and corners ``(n, 3)``, counter-clockwise; the vertices of loops and chain come first."""
        low, high = self.fixed.min(axis=0), self.fixed.max(axis=0)
        side, cells, done = (high - low).max() / 16, [], []
        cells = low + side * (np.stack(np.meshgrid(np.arange(17), np.arange(17)), axis=-1).reshape(-1, 2) + 0.5)
        while len(cells):
            split = side > 1.1 * self.size(cells)
            done.append(cells[~split])
            side /= 2
            cells = (cells[split][:, None] + side / 2 * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])).reshape(-1, 2)
        free = np.vstack(done)
        free = free + 0.05 * self.size(free)[:, None] * np.random.default_rng(0).uniform(-1, 1, free.shape)
        free = self._clear(free[self.inside(free)])
        for _ in range(6):
            free = self._clear(self._smoothed(free))
        points = np.vstack([self.fixed, free])
        corners = self._inner(points)
        have = {tuple(pair) for k in range(3) for pair in np.sort(corners[:, [k, (k + 1) % 3]], axis=1).tolist()}
        missing = [pair for pair in np.sort(self.edges, axis=1).tolist() if tuple(pair) not in have]
        assert not missing, f"{len(missing)} edges of the outline are no edges of triangles: {self.fixed[missing[0]]}"
        return points, corners

    def _clear(self, points):
        """Points that are not too close to edges of the outlines, and inside."""
        middle, length = self.fixed[self.edges].mean(axis=1), np.hypot(*np.diff(self.fixed[self.edges], axis=1)[:, 0].T)
        away, nearest = cKDTree(middle).query(points, k=4)
        return points[(away > 0.7 * length[nearest]).all(axis=1) & self.inside(points)]

    def _inner(self, points):
        corners = Delaunay(points).simplices
        a, b, c = (points[corners[:, k]] for k in range(3))
        area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        good = self.inside((a + b + c) / 3) & (np.abs(area) > 1e-9)
        return np.where((area > 0)[:, None], corners, corners[:, ::-1])[good]

    def _smoothed(self, free):
        points = np.vstack([self.fixed, free])
        corners = self._inner(points)
        total, count = np.zeros_like(points), np.zeros(len(points))
        for k in range(3):
            for a, b in ((k, (k + 1) % 3), ((k + 1) % 3, k)):
                np.add.at(total, corners[:, a], points[corners[:, b]])
                np.add.at(count, corners[:, a], 1)
        moved = total[len(self.fixed) :] / np.maximum(count[len(self.fixed) :], 1)[:, None]
        return np.where(count[len(self.fixed) :, None] > 0, moved, free)


def _gaps(chain):
    steps = np.hypot(*np.diff(chain, axis=0).T)
    return np.append(steps, steps[-1])


POINTS = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])  # of the quadrature on a triangle, all of one weight


class Body:
    """A gear of triangles with six nodes, some of which are `held`, about its `centre`; a straight slit opens from a mouth."""

    def __init__(self, loops, size, material, centre=(0.0, 0.0), slit=None, held=None):
        self.centre = np.array(centre)
        chain = np.zeros((0, 2)) if slit is None else slit[1:]
        points, corners = Mesher(loops, chain, size).triangles()
        count = [len(loop) // 2 for loop in loops]
        same = np.arange(len(points))
        self.faces, self.double = np.zeros((2, 0), dtype=int), {}
        if slit is not None:
            mouth = int(np.argmin(np.hypot(*(points[: count[0]] - slit[0]).T)))
            along = np.append(mouth, sum(count) + np.arange(len(chain)))
            points, corners, same = self._opened(points, corners, along, slit)
        self._middles(points, corners, same, loops, count)
        on = self.number(count[0] + np.arange(count[1]), closed=True)
        self.held = on if held is None else on[held(self.nodes[on])]
        if slit is not None:
            self._face_nodes(along)
        self._factor(*material)

    def _opened(self, points, corners, along, slit):
        """Double the nodes of the slit without its tip, for the triangles on its left."""
        direction = slit[-1] - slit[0]
        away = points[corners].mean(axis=1) - slit[0]
        left = direction[0] * away[:, 1] - direction[1] * away[:, 0] > 0
        new = np.arange(len(points))
        new[along[:-1]] = len(points) + np.arange(len(along) - 1)
        self.double = dict(zip(along[:-1].tolist(), new[along[:-1]].tolist(), strict=True))
        corners = np.where(left[:, None], new[corners], corners)
        return np.vstack([points, points[along[:-1]]]), corners, np.append(np.arange(len(points)), along[:-1])

    def _middles(self, points, corners, same, loops, count):
        """Nodes at the middles of edges, on the curves of the outlines."""
        sides = np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
        edges, at = np.unique(sides, axis=0, return_inverse=True)
        middles = points[edges].mean(axis=1)
        curved, start = {}, 0
        for loop, n in zip(loops, count, strict=True):
            for k in range(n):
                curved[tuple(sorted((start + k, start + (k + 1) % n)))] = loop[2 * k + 1]
            start += n
        for k, pair in enumerate(np.sort(same[edges], axis=1).tolist()):
            if tuple(pair) in curved:
                middles[k] = curved[tuple(pair)]
        self.edge = {tuple(pair): len(points) + k for k, pair in enumerate(edges.tolist())}
        self.nodes = np.vstack([points, middles])
        self.triangles = np.hstack([corners, len(points) + at.reshape(3, -1).T])

    def number(self, chain, closed=False, exact=False):
        """Nodes along vertices: vertex, middle, vertex; `exact`: not those of the other face of a slit."""
        ends = np.roll(chain, -1) if closed else chain[1:]
        pairs = zip(chain.tolist(), ends.tolist(), strict=False)
        middle = [self.edge[min(a, b), max(a, b)] if exact else self._between(a, b) for a, b in pairs]
        out = np.empty(len(chain) + len(middle), dtype=int)
        out[::2], out[1::2] = chain, middle
        return out

    def _between(self, a, b):
        for one in (a, self.double.get(a, a)):
            for other in (b, self.double.get(b, b)):
                if (min(one, other), max(one, other)) in self.edge:
                    return self.edge[min(one, other), max(one, other)]
        raise KeyError((a, b))

    def _face_nodes(self, along):
        left = [self.double.get(a, a) for a in along.tolist()]
        self.faces = np.array([self.number(np.array(one), exact=True)[:-1] for one in (along.tolist(), left)])

    def _factor(self, young, nu):
        """Plane strain, by three points in each triangle."""
        x, y = POINTS.T
        z = 1 - x - y
        # derivatives of the six shapes along the two sides of a triangle ``(q, 6)``
        first = np.stack([1 - 4 * z, 4 * x - 1, 0 * x, 4 * (z - x), 4 * y, -4 * y], -1)
        second = np.stack([1 - 4 * z, 0 * x, 4 * y - 1, -4 * x, 4 * x, 4 * (z - y)], -1)
        place = self.nodes[self.triangles]
        jacobian = np.stack([np.einsum("qa,eai->eqi", one, place) for one in (first, second)], axis=-1)
        volume = np.linalg.det(jacobian) / 6
        assert (volume > 0).all(), f"{(volume <= 0).sum()} triangles fold"
        slope = np.einsum("eqji,qaj->eqai", np.linalg.inv(jacobian), np.stack([first, second], axis=-1))
        shear, bulk = young / (2 * (1 + nu)), young * nu / ((1 + nu) * (1 - 2 * nu))
        # W = bulk/2 (div u)^2 + shear (eps : eps)
        block = bulk * np.einsum("eq,eqai,eqbj->eaibj", volume, slope, slope)
        block += shear * np.einsum("eq,eqaj,eqbi->eaibj", volume, slope, slope)
        block += shear * np.einsum("eq,eqak,eqbk,ij->eaibj", volume, slope, slope, np.eye(2))
        number = (2 * self.triangles[:, :, None] + np.arange(2)).reshape(len(place), 12)
        rows, columns = np.repeat(number, 12, axis=1).ravel(), np.tile(number, 12).ravel()
        whole = coo_matrix((block.reshape(-1), (rows, columns))).tocsc()
        stays = np.ones(2 * len(self.nodes), dtype=bool)
        stays[(2 * self.held[:, None] + [0, 1]).ravel()] = False
        self.free = np.flatnonzero(stays)
        options = {"SymmetricMode": True}
        self.factor = splu(whole[self.free][:, self.free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def solve(self, loads):
        out = np.zeros_like(loads)
        out[self.free] = self.factor.solve(loads[self.free])
        return out
