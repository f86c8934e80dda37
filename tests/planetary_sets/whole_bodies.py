"""A planetary set of whole bodies, whose solution imports nothing of gearfe, scikit-fem or gmsh.

Hats of pressure act on the outlines of the planets and on their projections on sun and ring. The faces of a crack are separate
nodes. All contacts are one linear complementarity problem without friction. `python whole_bodies.py REFINE POSITION ...` prints
solutions.

Angles count clockwise from +y in the frame of the carrier. The sun turns clockwise and drives. The pads turn with the ring.
"""

import math
import sys
import time
from dataclasses import dataclass

import numpy as np
from contact_rows import Row, outward, project, pushing, shapes
from generated_teeth import COS, FAR, SIN, Tooth, edge, outline, polar, rotated, thinner
from scipy.optimize import brentq
from triangles import GROWTH, Body

NEAR = (0.02, 0.25), (0.03, 0.5)  # edge length at contacts and half length of these zones [mm]: with the sun, with the ring
REACH = 0.06  # gap up to which a pair of teeth is meshed as a contact [mm]
PASSES = 4  # solutions, each with the gaps at the mean pose of the previous one
TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])  # d(x, y) per clockwise angle
GAUSS = tuple(np.array(values) for values in np.polynomial.legendre.leggauss(6))


@dataclass
class Mesh:
    """Pairs of teeth of planet 0 and a mate that come close: teeth, and the place of the least gap ``(n, 2)``."""

    mate: str
    side: int
    teeth: list
    places: np.ndarray


class WholeSet:
    """Sun, planet and ring at a position (the sun's turn in pitches), with a slit in a tooth of the ring.

    Parameters
    ----------
    gears : dict of str to Tooth
    position, load : float
        [pitches], [N/mm] for each mesh.
    pads : (int, float, float)
        Number, width [mm], angle of the first from the ring's tooth 0 [rad].
    crack : (int, float, float) or None
        Tooth of the ring, length [mm], angle to its centre-line [rad]; from the root of the loaded side.
    refine : float
    """

    def __init__(self, gears, position, load, pads, crack, material, refine=1.0, planets=3):
        self.gears, self.load, self.planets, self.refine = gears, load, planets, refine
        sun, planet, ring = (gears[name] for name in ("sun", "planet", "ring"))
        self.radii = sun.r_b, planet.r_b, ring.r_b
        self.centre = np.array([0.0, (sun.z + planet.z) * sun.m / 2])
        self.turns = self._turns(position)
        self.meshes = [self._mesh("sun", 1), self._mesh("ring", -1)]
        self._bodies(pads, crack, material)

    def _turns(self, position):
        """Angles of the teeth 0 of sun, planet 0 and ring. In the frame of the carrier the ring turns backwards."""
        sun, planet, ring = (self.gears[name] for name in ("sun", "planet", "ring"))
        a = self.centre[1]
        line = np.array([COS, SIN])  # of action with the sun, from the planet's tip circle on
        pitch = np.array([0.0, a * sun.z / (sun.z + planet.z)])
        start = brentq(lambda s: np.hypot(*(pitch - s * line - self.centre)) - planet.r_a, 0, 30)
        point = pitch - start * line
        at_sun = np.arctan2(*point) - sun.half(np.hypot(*point))
        at_planet = np.arctan2(*(point - self.centre)) - planet.half(planet.r_a)
        working = math.acos((ring.r_b - planet.r_b) / a)
        line, pitch = np.array([-math.cos(working), math.sin(working)]), np.array([0.0, a * ring.z / (ring.z - planet.z)])
        step = 2 * math.pi * planet.r_b / planet.z
        begin = brentq(lambda s: np.hypot(*(pitch + s * line)) - ring.r_a, -30, 0)

        def behind(s):
            """Angle of the planet's tooth that touches at s on the line."""
            point = pitch + s * line - self.centre
            return np.arctan2(*point) + planet.half(np.hypot(*point))

        # the planet's tooth turns back by one pitch for each base pitch; the newest pair is the first after the begin
        off = (behind(begin) - at_planet) / (2 * math.pi / planet.z)
        newest = begin + (off - math.floor(off)) * step
        point = pitch + newest * line
        at_ring = np.arctan2(*point) - ring.half(np.hypot(*point))
        turn = 2 * math.pi * position
        return at_sun + turn / sun.z, at_planet - turn / planet.z, at_ring - turn / ring.z

    def _side(self, name, tooth, side, rotate=0.0):
        """Fine points of a tooth's side, root to tip."""
        at = ("sun", "planet", "ring").index(name)
        gear = self.gears[name]
        curve, last = thinner(*gear.side())
        points = rotated(curve[last - 1 :: 5] * [side, 1], self.turns[at] + 2 * math.pi * tooth / gear.z + rotate)
        return points + (self.centre if name == "planet" else 0)

    def _mesh(self, mate, side):
        teeth, places = [], []
        aim = math.pi if mate == "sun" else 0.0
        for tooth in range(self.gears["planet"].z):
            if abs(_wrapped(self.turns[1] + 2 * math.pi * tooth / self.gears["planet"].z - aim)) > 0.9:
                continue
            points = self._side("planet", tooth, side)
            normals = outward(points, side)
            for other in range(self.gears[mate].z):
                at = self.turns[0 if mate == "sun" else 2] + 2 * math.pi * other / self.gears[mate].z
                if abs(_wrapped(at)) > (0.9 if mate == "sun" else 0.3):
                    continue
                gap = project(points, normals, self._side(mate, other, 1))[0]
                best = int(np.argmin(gap))
                if gap[best] < REACH:
                    teeth.append((tooth, other))
                    places.append(points[best])
        return Mesh(mate, side, teeth, np.array(places))

    def _bodies(self, pads, crack, material):
        sun, planet, ring = (self.gears[name] for name in ("sun", "planet", "ring"))
        marks, sizes = [], []
        for mesh, near in zip(self.meshes, NEAR, strict=True):
            marks.append(mesh.places)
            sizes += [(near[0] / self.refine, near[1])] * len(mesh.places)
        slit, more = None, []
        if crack is not None:
            slit = self._slit(ring, *crack)
            more = [(slit[-1], (0.02 / self.refine, 0.0))]
        spread = {
            "planet": [(p, s) for p, s in zip(np.vstack(marks), sizes, strict=True)],
            "sun": self._around(marks[0], sizes[: len(marks[0])]),
            "ring": self._around(marks[1], sizes[len(marks[0]) :]) + more,
        }
        count, width, first = pads
        middles = self.turns[2] + first + 2 * math.pi * np.arange(count) / count
        ends = np.concatenate([middles - width / 2 / ring.edge, middles + width / 2 / ring.edge])
        spread["ring"] += [(p, (0.03 / self.refine, 0.0)) for p in polar(ring.edge, ends)]

        def on_pads(points):
            away = _wrapped(np.arctan2(*points.T)[:, None] - middles)
            return (np.abs(away) <= width / 2 / ring.edge + 1e-9).any(axis=1)

        self.bodies = {}
        for at, (name, gear) in enumerate((("sun", sun), ("planet", planet), ("ring", ring))):
            places, wanted = (list(one) for one in zip(*spread[name], strict=True))
            size = _size_of(places, wanted, self.refine)
            centre = self.centre if name == "planet" else np.zeros(2)
            teeth = outline(gear, self.turns[at], centre, size)
            loop = teeth.loop
            held = edge(gear.edge, centre, ends if name == "ring" else (), size)
            if name == "ring" and slit is not None:  # the mouth is the vertex where fillet and root circle meet
                vertex = np.argmin(np.hypot(*(loop[::2] - slit[0]).T))
                assert np.hypot(*(loop[2 * vertex] - slit[0])) < 1e-6
                slit = np.vstack([loop[2 * vertex], slit[1:]])
            body = Body(
                [loop, held], size, material, centre,
                slit if name == "ring" else None, on_pads if name == "ring" else None,
            )  # fmt: skip
            body.sides = teeth.sides
            self.bodies[name] = body

    def _hats(self):
        """Hats `Row` of all meshes, planet by planet."""
        rows, planet = [], self.bodies["planet"]
        for i in range(self.planets):
            for kind, mesh in enumerate(self.meshes):
                z, mate = self.gears[mesh.mate].z, self.bodies[mesh.mate]
                assert z % self.planets == 0
                for (tooth, other), place in zip(mesh.teeth, mesh.places, strict=True):
                    chain = planet.sides[tooth, mesh.side]
                    on = np.flatnonzero(np.hypot(*(planet.nodes[chain] - place).T) < NEAR[kind][1])
                    theirs = mate.sides[(other + i * z // self.planets) % z, 1]
                    rows.append(Row(kind, i, planet.number(chain[on[0] : on[-1] + 1]), mate.number(theirs)))
        return rows

    def _posed(self, row, closing):
        """Nodes of planet and mate of a row, turned into each other by the approach `closing`."""
        mesh, step = self.meshes[row.kind], closing[row.kind, row.planet] / 2
        at = 0 if row.kind == 0 else 2
        planet, mate = self.bodies["planet"], self.bodies[mesh.mate]
        mine = rotated(planet.nodes[row.own], mesh.side * step / self.radii[1], self.centre)
        return self._to_place(mine, row), rotated(mate.nodes[row.met], step / self.radii[at])

    def _to_place(self, points, row):
        return rotated(points, 2 * math.pi * row.planet / self.planets)

    def _hat(self, row, closing):
        """Gaps ``(n,)`` of a row's hats, and their loads on planet and mate ``(nodes, 2, n)`` for unit pressure."""
        mine, theirs = self._posed(row, closing)
        edges = len(mine) // 2
        value, slope = shapes(GAUSS[0])
        place = np.array([mine[2 * k : 2 * k + 3] for k in range(edges)])
        x, along = np.einsum("qa,kai->kqi", value, place), np.einsum("qa,kai->kqi", slope, place)
        length = np.hypot(*np.moveaxis(along, -1, 0))
        normal = self.meshes[row.kind].side * np.stack([along[..., 1], -along[..., 0]], -1) / length[..., None]
        weight = (GAUSS[1] * length).ravel()
        x, normal = x.reshape(-1, 2), normal.reshape(-1, 2)
        away, segment, part = project(x, normal, theirs)
        on, met = segment // 2, shapes(segment % 2 - 1 + part)[0]
        nodes = 2 * on[:, None] + np.arange(3)
        gap = np.where(np.isfinite(away), np.einsum("qai,qi->q", theirs[nodes] * met[..., None] - x[:, None] / 3, normal), 0.2)
        hats = np.zeros((weight.size, edges + 1))
        number, q = np.repeat(np.arange(edges), GAUSS[0].size), np.arange(weight.size)
        hats[q, number], hats[q, number + 1] = np.tile((1 - GAUSS[0]) / 2, edges), np.tile((1 + GAUSS[0]) / 2, edges)
        hats *= weight[:, None]
        own, other = np.zeros((len(mine), 2, edges + 1)), np.zeros((len(theirs), 2, edges + 1))
        for a in range(3):
            shape = np.tile(value[:, a], edges)
            np.add.at(own, 2 * number + a, -(shape[:, None] * normal)[..., None] * hats[:, None])
            np.add.at(other, nodes[:, a], (met[:, a, None] * normal * np.isfinite(away)[:, None])[..., None] * hats[:, None])
        return hats.T @ gap, own, other

    def _gaps(self, rows, closing):
        """Gaps ``(n,)`` and their change with the turns of sun and planets ``(n, 1 + planets)`` [mm on base circles]."""
        gaps, ways = [], []
        for row in rows:
            gap, own, other = self._hat(row, closing)
            mine, theirs = self._posed(row, closing)
            way = np.zeros((gap.size, 1 + self.planets))
            centre = self._to_place(self.centre, row)
            way[:, 1 + row.planet] = np.einsum("kin,ki->n", own, (mine - centre) @ TURN.T) / self.radii[1]
            if row.kind == 0:
                way[:, 0] = np.einsum("kin,ki->n", other, theirs @ TURN.T) / self.radii[0]
            gaps.append(gap)
            ways.append(way)
        return np.concatenate(gaps), np.vstack(ways)

    def _flexibility(self, rows, closing):
        """Flexibility ``(n + faces, n + faces)`` of all hats and of the faces of the slit."""
        made = [self._hat(row, closing)[1:] for row in rows]
        stops = np.cumsum([0, *(one[0].shape[2] for one in made)])
        faces = self.bodies["ring"].faces
        total = stops[-1] + faces.shape[1]
        out, alike = np.zeros((total, total)), None
        for name, i in (("sun", 0), ("ring", 0), *(("planet", i) for i in range(self.planets))):
            body, columns, at = self.bodies[name], [], []
            for row, (own, other), start, stop in zip(rows, made, stops[:-1], stops[1:], strict=True):
                if (name == "planet" and row.planet != i) or name not in ("planet", self.meshes[row.kind].mate):
                    continue
                loads = np.zeros((len(body.nodes), 2, stop - start))
                # in the frame of planet 0, whose mesh all planets share
                load = np.moveaxis(self._back(np.moveaxis(own, 1, 2), row), 2, 1) if name == "planet" else other
                np.add.at(loads, row.own if name == "planet" else row.met, load)
                columns.append(loads.reshape(-1, stop - start))
                at += range(start, stop)
            if name == "ring" and faces.size:
                columns.append(self._face_loads(body))
                at += range(stops[-1], total)
            if name != "planet" or alike is None:  # planets are equal in their own frames
                loads = np.hstack(columns)
                alike = loads.T @ body.solve(loads)
            out[np.ix_(at, at)] += alike
            alike = alike if name == "planet" else None
        return out

    def _back(self, vectors, row):
        return rotated(vectors, -2 * math.pi * row.planet / self.planets)

    @staticmethod
    def _face_loads(body):
        """Unit forces that push the faces of the slit apart, one column for each pair of nodes."""
        right, left = body.faces
        along = body.nodes[right[-1]] - body.nodes[right[0]]
        normal = np.array([-along[1], along[0]]) / np.hypot(*along)
        loads = np.zeros((len(body.nodes), 2, len(left)))
        for k, (a, b) in enumerate(zip(right, left, strict=True)):
            loads[b, :, k], loads[a, :, k] = normal, -normal
        return loads.reshape(-1, len(left))

    def _around(self, places, sizes):
        return [
            (p, s)
            for i in range(self.planets)
            for p, s in zip(rotated(places, 2 * math.pi * i / self.planets), sizes, strict=True)
        ]

    def _slit(self, ring, tooth, length, angle):
        """Points of the slit, finer towards its tip."""
        mouth = ring.side()[0][0]
        steps, at = [0.0], 0.0
        while at < length:
            at += min(0.02 / self.refine + GROWTH * at, 0.2, length)
            steps.append(min(at, length))
        if steps[-1] - steps[-2] < 0.3 * (steps[-2] - steps[-3]):
            del steps[-2]
        along = (length - np.array(steps))[::-1]
        points = mouth + along[:, None] * np.array([-math.sin(angle), math.cos(angle)])
        return rotated(points, self.turns[2] + 2 * math.pi * tooth / ring.z)

    def solved(self):
        """Turns of sun and planets [mm on base circles], loads ``(2, planets)`` and the force on the slit's faces [N/mm]."""
        closing, rows = np.full((2, self.planets), 0.015), self._hats()
        flexibility = self._flexibility(rows, closing)
        faces = len(flexibility) - len(self._gaps(rows, closing)[0])
        torque = np.append(self.planets * self.load, np.zeros(self.planets))
        for _ in range(PASSES):
            gap, ways = self._gaps(rows, closing)
            guess = np.append(closing.sum(axis=0).mean(), -closing[1])
            rest = np.append(gap - ways @ guess, np.zeros(faces))
            force, motion = pushing(flexibility, rest, np.vstack([ways, np.zeros((faces, ways.shape[1]))]), torque, guess)
            closing = np.array([motion[0] + motion[1:], -motion[1:]])
        kinds = np.concatenate([np.full(row.own.size // 2 + 1, 2 * row.planet + row.kind) for row in rows])
        pushed = -ways * force[: len(gap), None]
        loads = np.array([[abs(pushed[kinds == 2 * i + kind, 1 + i].sum()) for i in range(self.planets)] for kind in (0, 1)])
        return motion, loads, force[len(gap) :].sum()


def _wrapped(angle):
    return (np.asarray(angle) + math.pi) % (2 * math.pi) - math.pi


def _size_of(places, wanted, refine):
    places, least, reach = np.array(places), np.array([w[0] for w in wanted]), np.array([w[1] for w in wanted])

    def size(points):
        away = np.hypot(*np.moveaxis(points[:, None] - places, -1, 0))
        return np.minimum(FAR / refine**0.5, (least + GROWTH * np.maximum(away - reach, 0)).min(axis=1))

    return size


GEARS = {
    "sun": Tooth(21, 2.0, 7.4),
    "planet": Tooth(31, 2.0, 11.4),
    "ring": Tooth(84, 2.0, 90.6, x=-0.4617, addendum=0.85, tip=0.3, internal=True),
}


def whole_set(position, refine=1.0):
    """k of planet 0 and ring [N/(mm um)], load of planet 0 [N/mm], turn of the sun [um], force on the crack's faces [N/mm]."""
    made = WholeSet(GEARS, position, 100.0, (6, 4.8, math.pi / 6), (-3, 3.0, math.radians(20)), (207e3, 0.3), refine)
    motion, loads, faces = made.solved()
    return 1e-3 * loads[1, 0] / -motion[1], loads[0, 0], 1e3 * motion[0], faces


if __name__ == "__main__":
    for at in map(float, sys.argv[2:]):
        start = time.process_time()
        print(
            at,
            *(f"{value:.6g}" for value in whole_set(at, float(sys.argv[1]))),
            f"{time.process_time() - start:.0f} s",
            flush=True,
        )
