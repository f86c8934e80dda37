"""A whole gear in plane strain in curved second-order triangles, with held bore or rim and open cracks.

Only the triangulation between given vertices (gmsh) and the doubling of a crack's nodes are taken from `geometry`.
"""

import math

import numpy as np

from gearfe.geometry.damage.seam import open_seam
from gearfe.geometry.mesh.mesher import triangulate

from .cracks import crack_corners, crack_start
from .elements import gradients, solver, stiffness

GROWTH = 0.3  # growth of the edge length with the distance along the outline
FAR, FILLET, FLANK = 0.8, 0.16, 0.3  # edge lengths [m_n]: distant teeth; fillets and flanks near loaded teeth
NEAR = 1  # teeth on either side of a loaded tooth with the same mesh size


class MeshedBody:
    """A gear, meshed and factorised.

    Parameters
    ----------
    side : Side
        Loaded side of its teeth.
    sense : int
        1 or -1: tooth k stands k pitches clockwise or counter-clockwise of tooth 0 in the gear's own frame.
    marks : dict of int to (ndarray, ndarray)
        For loaded teeth places s on the side and the edge lengths wanted there [mm].
    young, nu : float
        [MPa], [-].
    refine : float
        Divides all other edge lengths.
    cracks : sequence of gearfe.Crack
    missing : sequence of int
        Missing teeth: the root circle takes their place.
    """

    def __init__(self, side, sense, marks, young, nu, refine=1.0, cracks=(), missing=()):
        self.side, self.outline, self.sense = side, side.outline, sense
        self.marks, self.refine, self.cracks = marks, refine, cracks
        self.missing = {tooth % side.outline.gear.z for tooth in missing}
        self.unfolded = 0
        # by tooth: abscissae s of the vertices of its loaded side, first vertex number, direction of numbering
        self.vertices = {}
        rim, chains = self._rim()
        held = self._held(rim)
        self.nodes, self.triangles = self._mesh(rim, held, chains)
        on = np.arange(rim.shape[1] // 2, (rim.shape[1] + held.shape[1]) // 2)
        self.fixed = np.unique(np.concatenate([on, [self._middle(a, b) for a, b in zip(on, np.roll(on, -1), strict=True)]]))
        self._unfold()
        self.solve = solver(stiffness(self.nodes, self.triangles, young, nu), self.fixed)

    def _unfold(self):
        """Straighten curved edges where a triangle would be inverted (coarse fillets of distant teeth)."""
        corner = gradients(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
        for _ in range(3):
            jacobian = np.einsum("qia,bie->eqab", corner, self.nodes[:, self.triangles], optimize=True)
            area = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
            bad = np.flatnonzero(area.min(axis=1) <= 0.05 * np.abs(area).max(axis=1))
            self.unfolded += bad.size
            for a, b, middle in ((0, 1, 3), (1, 2, 4), (0, 2, 5)):
                ends = self.nodes[:, self.triangles[[a, b]][:, bad]]
                self.nodes[:, self.triangles[middle, bad]] = ends.mean(axis=1)

    def angle(self, tooth):
        """Angle of a tooth's centre-line in the gear's own frame."""
        return self.sense * 2 * math.pi * tooth / self.outline.gear.z

    def loads(self, tooth, s, weights, directions):
        """Return columns ``(dofs, m)`` of forces: `weights` (n, m) at places `s` of a tooth along `directions` (2, n)."""
        places, numbers = self.vertices[tooth % self.outline.gear.z]
        edge = np.clip(np.searchsorted(places, s, side="right") - 1, 0, places.size - 2)
        x = (s - places[edge]) / (places[edge + 1] - places[edge])
        shapes = (1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)
        ends = numbers[edge], numbers[edge + 1]
        middle = np.array([self._middle(a, b) for a, b in zip(*ends, strict=True)])
        out = np.zeros((2 * self.nodes.shape[1], weights.shape[1]))
        for shape, node in zip(shapes, (ends[0], middle, ends[1]), strict=True):
            for axis in (0, 1):
                np.add.at(out, 2 * node + axis, (shape * directions[axis])[:, None] * weights)
        return out

    def seam_loads(self):
        """Return columns ``(dofs, n)`` of unit forces that push the faces of cracks apart, one column for each pair of nodes."""
        out = [np.zeros((2 * self.nodes.shape[1], 0))]
        for left, right, normal in self.seams:
            columns, number = np.zeros((2 * self.nodes.shape[1], left.size)), np.arange(left.size)
            for nodes, sense in ((left, -1.0), (right, 1.0)):
                for axis in (0, 1):
                    columns[2 * nodes + axis, number] = sense * normal[axis]
            out.append(columns)
        return np.hstack(out)

    def _faces(self, points, chain, double):
        """Return nodes left and right of a crack, except its tip, and normals ``(2, n)`` from left to right."""
        along = np.diff(points[:, chain], axis=1)
        along /= np.hypot(*along)
        at_ends = along + np.hstack([along[:, :1], along[:, :-1]])
        along = np.hstack([at_ends / np.hypot(*at_ends), along])
        sides = [
            np.concatenate([nodes[:-1], [self._middle(*ends) for ends in zip(nodes[:-1], nodes[1:], strict=True)]])
            for nodes in (chain.tolist(), double.tolist())
        ]
        return (*(np.array(side, dtype=int) for side in sides), np.array([along[1], -along[0]]))

    def _middle(self, a, b):
        return self._edges[min(a, b), max(a, b)]

    def _size(self, tooth, points, base):
        """Return edge lengths at points ``(2, n)`` in the frame of a tooth."""
        if tooth not in self.marks:
            return base
        s, h = self.marks[tooth]
        radius, angle = self.side.place(s)
        away = np.hypot(points[0][:, None] - radius * np.sin(angle), points[1][:, None] - radius * np.cos(angle))
        return np.minimum(base, (h + GROWTH * away).min(axis=1))

    def _divided(self, tooth, place, first, last, base, known=()):
        """Return places of vertices and edge middles on a smooth curve ``place(s)``, according to the edge lengths."""
        s = np.linspace(first, last, 41)
        if len(known):
            spread = np.concatenate(
                [np.array(known) + d for d in (0.0, *(x * g for g in 1e-4 * 2.0 ** np.arange(14) for x in (1, -1)))]
            )
            s = np.unique(np.concatenate([s, spread[(spread > first) & (spread < last)]]))
        radius, angle = place(s)
        size = self._size(tooth, (radius * np.sin(angle), radius * np.cos(angle)), np.full(s.size, base))
        steps = np.diff(s) * (1 / size[1:] + 1 / size[:-1]) / 2
        total = np.concatenate([[0.0], np.cumsum(steps)])
        count = max(1, math.ceil(total[-1] - 1e-9))
        vertices = np.interp(np.linspace(0, total[-1], count + 1), total, s)
        vertices[[0, -1]] = first, last
        out = np.empty(2 * count + 1)
        out[::2], out[1::2] = vertices, (vertices[1:] + vertices[:-1]) / 2
        return out

    def _rim(self):
        """Return the loop of vertices and edge middles around all teeth ``(2, 2 n)``, and the chains of the cracks."""
        gear, side = self.outline.gear, self.side
        z, m = gear.z, gear.m_n / max(self.refine, 0.7)
        loaded = {tooth % z for tooth in self.marks}
        near = {(tooth + k) % z for tooth in loaded for k in range(-NEAR, NEAR + 1)}
        self.marks = {tooth % z: mark for tooth, mark in self.marks.items()}
        cracked = {(crack.tooth % z, crack.side): crack for crack in self.cracks}
        radius, angle, at, starts = [], [], 0, {}
        for step in range(z):
            tooth = (self.sense * step) % z
            behind, centre = float(self.outline.pitch(tooth)), 2 * math.pi * step / z
            fillet, flank = (FILLET * m, FLANK * m) if tooth in near else (FAR * m / 2, FAR * m)
            if tooth in self.missing:  # The gap extends from where this tooth would begin to the start of the next tooth.
                first = centre + float(self._other(np.array([0.0]))[1][0])
                count = math.ceil(2 * math.pi / z * self.outline.r_f / (FILLET * m))
                radius.append(np.full(2 * count, self.outline.r_f))
                angle.append(first + 2 * math.pi / z * np.arange(2 * count) / (2 * count))
                at += 2 * count
                continue
            for loaded_side in (False, True):
                place = side.place if loaded_side else self._other
                joints = side.joints if loaded_side else side.joints[[0, 1, -2, -1]]
                crack = cracked.get((tooth, "loaded" if loaded_side else "unloaded"))
                known = self.marks[tooth][0] if loaded_side and tooth in self.marks else ()
                lists = []
                for number, (first, last) in enumerate(zip(joints[:-1], joints[1:], strict=True)):
                    base = fillet if number == 0 else flank
                    if crack is not None and number == 0:
                        begin = crack_start(side, crack)
                        base = min(base, math.dist(*crack_corners(side, crack)[:, :2].T) / 4)
                        lists += [self._divided(tooth, place, first, begin, base, known)[:-1]]
                        starts[crack] = sum(map(len, lists))
                        first = begin
                    lists.append(
                        self._divided(tooth, place, first, last, base, known)[: None if number == len(joints) - 2 else -1]
                    )
                s = np.concatenate(lists)
                r, a = place(s)
                if loaded_side:
                    # The order is from tip to root. The other side already contains the point on the centre-line.
                    s, r, a = s[::-1], r[::-1], a[::-1] - behind
                    numbers = at // 2 + np.arange((s.size + 1) // 2)
                    self.vertices[tooth] = s[::2][::-1], numbers[::-1]
                    if crack is not None:
                        starts[crack] = at // 2 + (s.size - 1 - starts[crack]) // 2
                    # Without a root arc, the last point is the first point of the next tooth.
                    shut = self._root_arc(behind) < 1e-4 * gear.m_n
                    keep = s.size - 1 if shut else s.size
                else:
                    keep = s.size - 1
                    if crack is not None:
                        starts[crack] = at // 2 + starts[crack] // 2
                radius.append(r[:keep])
                angle.append(centre + a[:keep])
                at += keep
            # The root arc starts at the last point of the loaded side and ends at the next tooth.
            if shut:
                continue
            here, there = angle[-1][-1], centre + 2 * math.pi / z + float(self._other(np.array([0.0]))[1][0])
            count = max(1, math.ceil((there - here) * self.outline.r_f / (fillet * 2)))
            arc = np.linspace(here, there, 2 * count + 1)[1:-1]
            radius.append(np.full(arc.size, self.outline.r_f))
            angle.append(arc)
            at += arc.size
        for _, numbers in self.vertices.values():
            numbers %= at // 2
        radius, angle = np.concatenate(radius), np.concatenate(angle)
        rim = np.array([radius * np.sin(angle), radius * np.cos(angle)])
        return rim, [(starts[crack], self._crack_path(crack, m)) for crack in self.cracks]

    def _root_arc(self, behind):
        """Return the length of the root circle between two teeth [mm]. One loaded side is `behind` its nominal place [rad]."""
        loaded, other = (float(place(np.array([0.0]))[1][0]) for place in (self.side.place, self._other))
        return (2 * math.pi / self.outline.gear.z + other - loaded + behind) * self.outline.r_f

    def _other(self, s):
        """Return the unloaded side at the arc lengths of the loaded side. It may be unmodified."""
        radius = self.side.place(np.asarray(s, dtype=float))[0]
        last = self.side.joints[-2]
        tip = np.asarray(s) >= last
        full = -float(self.outline.unloaded(self.outline.r_a))
        middle = float(self.side.place(np.array([self.side.joints[-1]]))[1][0])
        part = (np.asarray(s) - last) / (self.side.joints[-1] - last)
        return radius, np.where(tip, -full + part * (full + middle), self.outline.unloaded(radius))

    def _held(self, rim):
        gear = self.outline.gear
        radius = gear.r_rim if gear.internal else gear.r_bore
        size = (0.3 * abs(radius - self.outline.r_f) + 0.1 * gear.m_n) / max(self.refine, 0.7)
        count = max(24, math.ceil(2 * math.pi * radius / size))
        angle = 2 * math.pi * np.arange(2 * count) / (2 * count)
        return radius * np.array([np.sin(angle), np.cos(angle)])

    def _crack_path(self, crack, m):
        """Return the vertices of a crack after its mouth, closer towards its tip and bend."""
        corners = crack_corners(self.side, crack)
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(corners, axis=1))))
        length, coarse, steps = along[-1], FILLET * m, []
        for last, end in zip(along[:-1], along[1:], strict=True):
            fine, at, part = min(length, end - last) / 40, end, [end]
            while at > last:
                at -= min(max(fine, 0.35 * (end - at)), coarse, max((end - last) / 4, fine))
                part.append(at)
            steps += [x for x in part if x - last > 0.3 * min(coarse, (end - last) / 4)][::-1]
        turn = self.angle(crack.tooth)
        x, y = (np.interp(steps, along, row) for row in corners)
        return np.array([x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn)])

    def _mesh(self, rim, held, chains):
        loops = [rim[:, ::2], held[:, ::2]]
        points, triangles = triangulate(loops, chains, self.outline.gear.internal)
        first, doubles, tips, seams = sum(loop.shape[1] for loop in loops), {}, [], []
        for start, inner in chains:
            chain = np.append(start, first + np.arange(inner.shape[1]))
            first += inner.shape[1]
            points, triangles, double = open_seam(points, triangles, chain)
            doubles[start] = int(double[0])
            tips.append(int(chain[-1]))
            seams.append((chain, double))
        corners = points[:, triangles]
        (ax, ay), (bx, by) = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = ax * by - ay * bx
        triangles[1:] = np.where(area > 0, triangles[1:], triangles[:0:-1])
        pairs = np.sort(np.concatenate([triangles[[0, 1]], triangles[[1, 2]], triangles[[0, 2]]], axis=1), axis=0)
        edges, number = np.unique(pairs, axis=1, return_inverse=True)
        number = number.reshape(3, -1) + points.shape[1]
        middles = points[:, edges].mean(axis=1)
        self._edges = {(a, b): points.shape[1] + i for i, (a, b) in enumerate(edges.T.tolist())}
        self.seams = [self._faces(points, chain, double) for chain, double in seams]
        at = 0
        for loop in (rim, held):
            count = loop.shape[1] // 2
            ring = (at + np.arange(count)).tolist()
            for i, (a, b) in enumerate(zip(ring, ring[1:] + ring[:1], strict=True)):
                key = next(
                    (min(p, q), max(p, q))
                    for p in (a, doubles.get(a, a))
                    for q in (b, doubles.get(b, b))
                    if (min(p, q), max(p, q)) in self._edges
                )
                self._edges[min(a, b), max(a, b)] = self._edges[key]
                middles[:, self._edges[key] - points.shape[1]] = loop[:, 2 * i + 1]
            at += count
        for tip in tips:  # Displacements vary with the square root of the distance from a crack tip.
            for (a, b), node in list(self._edges.items()):
                if tip in (a, b):
                    middles[:, node - points.shape[1]] = 0.75 * points[:, tip] + 0.25 * points[:, a + b - tip]
        return np.hstack([points, middles]), np.vstack([triangles, number])
