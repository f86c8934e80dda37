"""Gear as z equal sectors: flexibility between loads on any tooth and on the held edge, solved by Fourier series.

The unknowns of a sector are the polar displacements of its left side and its held edge. Its right side is the left side of the
next sector. With the unknowns v_j of sector j, the gear is a block-circulant system, which Fourier series over the sectors
split into z small systems::

    v_j = 1/z sum_k V_k exp(2 pi i j k / z),    (A + B exp(2 pi i k / z) + B' exp(-2 pi i k / z)) V_k = F_k

Only the influence between different teeth is needed. `gearfe.flexibility.plane` has the flexibility of each tooth itself.

References
----------
P. J. Davis, Circulant Matrices, Wiley, 1979, ch. 5.
"""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.sparse import coo_array

from ..core.material import Material
from ..flexibility.condense import condense
from ..flexibility.finite_elements.elasticity import GAUSS_3, LEAF, HeldSection, edge_nodes, edge_shapes
from ..flexibility.solved import solved_gears
from ..geometry.aliases import Floats
from ..geometry.mesh.periodic_sector import periodic_sector
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import arc_at, flank, flank_normal, roll_at_arc

PLACES = 8  # number of loads on each flank, because their effect on other teeth varies little along it
NULL = 1e-9  # Smaller eigenvalues, relative to the largest, belong to rigid-body motions.


@dataclass(frozen=True, slots=True)
class WholeGear:
    """Block-circulant system of a gear per mm of width, by harmonic k = 0 ... z // 2 (h of them).

    Loads are unit line loads on the right flank of a tooth (the loaded one in the gear's frame, `PLACES` of them from root to
    tip), then on the left one. The held edge has r unknowns per sector: radial and tangential (clockwise) displacements of its
    nodes. They begin at the left corner and run clockwise, without the right corner. `stiffness` ``(h, n, n)`` is complex,
    with the unknowns of the held edge first. `push` ``(h, n, 2 PLACES)`` are the loads on the tooth of sector 0. `bed` ``(h,
    r, r)`` is the mass matrix of the held edge [mm], which converts tractions to forces. `angle` ``(r / 2,)`` are the angles
    of the held nodes of sector 0, clockwise from its tooth's centre-line [rad].
    """

    gear: Gear
    material: Material
    stiffness: NDArray[np.complex128]
    push: NDArray[np.complex128]
    bed: NDArray[np.complex128]
    angle: Floats

    @property
    def edge(self) -> int:
        """Number of unknowns of the held edge of a sector."""
        return 2 * self.angle.size

    def between(self, inverse: NDArray[np.complex128]) -> NDArray:
        """Displacement ``(z, 2 PLACES, 2 PLACES)`` [mm per N/mm] of the loads of tooth d due to those of tooth 0.

        `inverse` ``(h, n, n)`` is that of the stiffness with the support of the edge. For tooth 0 itself, only the part that acts
        through the sides of its sector is contained.
        """
        return np.fft.irfft(np.conj(self.push.mT) @ inverse @ self.push, n=self.gear.z, axis=0)

    def held(self) -> Floats:
        """Return `between` for a fixed edge."""
        return self.between(self.held_inverse())

    def moved(self, inverse: NDArray[np.complex128]) -> NDArray:
        """Displacements of the edge by harmonic ``(h, r, 2 PLACES + r)``, due to the loads and to forces on the edge."""
        edge = inverse[:, : self.edge]
        return np.concatenate([edge @ self.push, edge[:, :, : self.edge]], axis=2)

    def held_inverse(self) -> NDArray:
        """Return inverses ``(h, n, n)`` of the stiffness with fixed edge (zero for unknowns of the edge)."""
        out, inner = np.zeros_like(self.stiffness), slice(self.edge, None)
        out[:, inner, inner] = np.linalg.inv(self.stiffness[:, inner, inner])
        return out

    def bedded_inverse(self, stiffness: NDArray) -> NDArray:
        """Return the inverses for an edge on springs, radial and tangential [N/mm per mm of edge, per mm of width]."""
        springs = self.stiffness.copy()
        springs[:, : self.edge, : self.edge] += self.bed * np.tile(stiffness, self.edge // 2)
        return np.linalg.inv(springs)

    def loose_inverse(self) -> NDArray:
        """Return the inverses for a free edge, without rigid motions of the gear.

        Forces on the edge are to be in balance with those on the teeth.
        """
        free = [_pseudo(one) for one in self.stiffness[:2]]
        return np.concatenate([free, np.linalg.inv(self.stiffness[2:])])


def _pseudo(stiffness):
    """Return the inverse of a Hermitian matrix on the complement of its one rigid motion."""
    values, vectors = np.linalg.eigh(stiffness)
    if not abs(values[0]) < NULL * values[-1] < abs(values[1]):
        raise RuntimeError("the mesh of a gear has no exact rigid-body motion: change refine slightly")
    return (vectors[:, 1:] / values[1:]) @ np.conj(vectors[:, 1:].T)


def whole_gear(gear, material, *, refine=1.0, cache=True):
    """Compute the `WholeGear` of a healthy gear in plane strain, by second-order triangles on one sector."""
    case = gear, material, float(refine)
    return solved_gears(cache).get(("whole gear", *case), partial(_solved, *case))


def _solved(gear, material, refine):
    sector = periodic_sector(gear, refine=refine)
    matrix, push, angle = sector_stiffness(sector, material)
    own, next_, to = in_chain(sector)
    n, e = matrix.shape[0], sector_edge(sector)
    wave = np.exp(2j * math.pi / gear.z * np.arange(gear.z // 2 + 1))[:, None, None]
    first = np.zeros((n, own.size))  # maps the unknowns of a sector to those of `matrix`
    first[own, np.arange(own.size)] = 1.0
    second = np.zeros((n, own.size))  # maps the unknowns of the next sector to the right side
    second[next_, to] = 1.0

    def chained(matrix, first, second):
        across, out = first.T @ matrix @ second, np.empty((wave.size, first.shape[1], first.shape[1]), dtype=complex)
        out.real = first.T @ matrix @ first + second.T @ matrix @ second + wave.real * (across + across.T)
        out.imag = wave.imag * (across - across.T)
        return out

    stiffness, m = chained((matrix + matrix.T) / 2, first, second), own.size - e
    at = np.concatenate([[0, 1], np.arange(m, m + e + 2)])
    bed = chained(_mass(sector), first[at, : e + 2], second[at, : e + 2])
    places = np.append(-math.pi / gear.z, angle[m // 2 : -(m // 2)])
    return WholeGear(gear, material, stiffness, first.T @ push + np.conj(wave) * (second.T @ push), bed, places)


def sector_stiffness(sector, material, faces=None):
    """Return stiffness ``(n, n)`` of a sector, forces ``(n, 2 PLACES)`` of its tooth's loads, and angles of its nodes.

    Unknowns are polar components of the nodes of the left side, of the held edge between its corners, of the right side. With
    pairs of nodes ``(2, m)`` that face each other in its cracks, x and y of these follow: m of one face, m of the other.
    A missing tooth has no loads.
    """
    body = HeldSection(sector.mesh, material, held="rim")  # Only the elements are used, not the outline.
    local, dofs = body.local()
    left, right, edge = (np.array(_chain(sector.mesh, way)) for way in (sector.left, sector.right, sector.held))
    ends = np.concatenate([left, edge[1:-1], right])  # Both sides begin at a corner of the held edge.
    rolls = _rolls(sector.gear)
    sides = (0, 1) if sector.roll.size else ()
    flanks = [line_loads(sector.gear, sector.mesh, sector.flank[k], sector.roll, rolls, k) for k in sides]
    load = np.hstack([np.zeros((dofs.max() + 1, 0)), *flanks])
    centre = sector.mesh.doflocs[:, sector.mesh.t[:3]].mean(axis=1)
    kept = ends if faces is None else np.concatenate([ends, *faces])
    stays = (2 * kept[:, None] + np.arange(2)).ravel()
    total = condense(local, dofs, centre, coo_array(load), stays, leaf=LEAF)
    side = np.full(left.size, math.pi / sector.gear.z)
    angle = np.concatenate([-side, np.arctan2(*sector.mesh.doflocs[:, edge[1:-1]]), side])
    turn = block_diag(_polar(angle), np.eye(stays.size - 2 * ends.size))
    return turn.T @ total[: stays.size, : stays.size] @ turn, turn.T @ total[: stays.size, stays.size :], angle


def sector_edge(sector):
    """Unknowns of the held edge of a sector between its corners."""
    return 2 * (2 * sector.held.size - 3)


def in_chain(sector):
    """Return the indices of the unknowns of a chain of sectors among those of `sector_stiffness`.

    They are the sector's (corner, held edge, the rest of the left side), those of the next sector's corner and side, and the
    indices of these among the next sector's unknowns.
    """
    m, e = 2 * (2 * sector.left.size - 1), sector_edge(sector)
    own = np.concatenate([np.arange(2), np.arange(m, m + e), np.arange(2, m)])
    return own, np.arange(m + e, 2 * m + e), np.concatenate([np.arange(2), np.arange(2 + e, m + e)])


def _chain(mesh, vertices):
    """Nodes along a chain of vertices, edge middles included."""
    start, stop, middle = edge_nodes(mesh, vertices)
    return np.append(np.array([start, middle]).T.ravel(), stop[-1])


def _polar(angle):
    """Rotation from radial and tangential (clockwise) to Cartesian components of nodes at `angle`."""
    x = 2 * np.arange(angle.size)
    out = np.zeros((2 * angle.size,) * 2)
    out[x, x], out[x + 1, x], out[x, x + 1], out[x + 1, x + 1] = np.sin(angle), np.cos(angle), np.cos(angle), -np.sin(angle)
    return out


def _mass(sector):
    """Mass matrix of the held edge [mm], equal for radial and tangential components, with nodes from left to right."""
    nodes = edge_nodes(sector.mesh, sector.held)
    points, weights = GAUSS_3
    shapes, slopes = edge_shapes(points)
    length = np.hypot(*np.einsum("dne,np->dep", sector.mesh.doflocs[:, nodes], slopes)) * weights
    block = np.einsum("ap,ep,bp->eab", shapes, length, shapes)
    count = 2 * nodes.shape[1] + 1
    out = np.zeros((count, count))
    for e, one in enumerate(block):
        at = np.array([2 * e, 2 * e + 2, 2 * e + 1])
        out[np.ix_(at, at)] += one
    return np.kron(out, np.eye(2))


def _rolls(gear):
    """Roll lengths of the loads, from root to tip [mm]."""
    return (gear.roll_f + gear.roll_a) / 2 + (gear.roll_a - gear.roll_f) / 2 * chebyshev.chebpts2(PLACES)


def line_loads(gear, mesh, vertices, rolls, roll, side):
    """Nodal forces ``(2 nodes, n)`` of unit line loads into a flank of tooth 0: right (`side` 0) or left (1).

    `vertices` of the flank from root to tip at the roll lengths `rolls` [mm]; `roll` ``(n,)`` are those of the loads [mm].
    """
    rising = rolls * gear.outward
    edge = np.clip(np.searchsorted(rising, roll * gear.outward) - 1, 0, rising.size - 2)
    low, high = rolls[edge], rolls[edge + 1]
    shapes, _ = edge_shapes(np.clip(2 * (roll - low) / (high - low) - 1, -1, 1))
    nodes = edge_nodes(mesh, vertices)[:, edge]
    force = -flank_normal(gear, roll) * np.array([[1 - 2 * side], [1]])
    out, column = np.zeros((2 * mesh.doflocs.shape[1], roll.size)), np.arange(roll.size)
    for shape, node in zip(shapes, nodes, strict=True):
        out[2 * node, column] += shape * force[0]
        out[2 * node + 1, column] += shape * force[1]
    return out


def carry(gear, roll):
    """Matrix ``(n, PLACES)`` from values at the loads to values at roll lengths ``(n,)`` [mm], clamped to the flank."""
    arc, ends = arc_at(gear, np.asarray(roll)), sorted(arc_at(gear, end) for end in (gear.roll_f, gear.roll_a))
    middle, reach = (gear.roll_f + gear.roll_a) / 2, (gear.roll_a - gear.roll_f) / 2
    place = (roll_at_arc(gear, np.clip(arc, *ends)) - middle) / reach
    nodes = chebyshev.chebvander(chebyshev.chebpts2(PLACES), PLACES - 1)
    return np.linalg.solve(nodes.T, chebyshev.chebvander(place, PLACES - 1).T).T


def motion(gear):
    """Displacement ``(3, 2 PLACES)`` of loads of tooth 0 for motions of the gear: along x, y, clockwise rotation [mm]."""
    roll = _rolls(gear)
    radius, angle = flank(gear, roll)
    into = -flank_normal(gear, roll)
    out = []
    for sign in (1, -1):
        x, y, (fx, fy) = sign * radius * np.sin(angle), radius * np.cos(angle), into * np.array([[sign], [1]])
        out.append(np.array([fx, fy, y * fx - x * fy]))
    return np.hstack(out)


def between_teeth(table):
    """Return ``(z, PLACES, z, PLACES)`` between right flanks of all teeth, from a table by the distance of teeth."""
    z = table.shape[0]
    apart = (np.arange(z)[:, None] - np.arange(z)) % z
    return table[apart, :PLACES, :PLACES].transpose(0, 2, 1, 3).copy()
