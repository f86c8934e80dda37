"""Pitch sector of a helical gear as an elastic body: section triangles times polynomials along the width.

In the frame that rotates with the helix, all coefficients are independent of z: with x = R(w z) X, u = R(w z) v(X, Y, z) and R
clockwise,

    d/dz at fixed (x, y) = D v = v_z - w T v,    T v = (Y d_X - X d_Y) v - (v_2, -v_1, 0)
    xx = v1_X, yy = v2_Y, zz = (D v)_3, xy = v1_Y + v2_X, xz = (D v)_1 + v3_X, yz = (D v)_2 + v3_Y

so that the stiffness is exactly ``K00 x M + K01 x C + K01' x C' + K11 x Dz`` of three matrices of the plane section and three of
the axial polynomials f: ``M = int f f'``, ``C = int f df'``, ``Dz = int df df'`` (`axial`). For a crack open over a part of the
width, two facing nodes are replaced by their mean and their difference. The mean has the functions of all other nodes, the
difference those of the opening.
"""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import block_diag

from ....core.material import Material
from ....geometry.mesh.triangle import GAUSS, jacobians, lagrange, table
from ....geometry.tooth.gear import Gear
from ....geometry.tooth.profile import arc_at, flank_normal, roll_at_arc
from .axial import axial
from .bent import bent_triangles
from .crack_faces import face_forces
from .depth import degrees
from .dissection import dissect
from .elimination import LoadedSection, all_nodes, body_of, front, places
from .panel import numbering, panel_of
from .parity import front_by_parity
from .short_edges import ORDER, bind, quadratic_edges

CLOSE = 0.5  # distance from a crack within which nodes have the functions for its ends along the width [m_n]


@dataclass(frozen=True, slots=True)
class SolidModel:
    """Model of a gear of finite width with held bore or rim and free end faces.

    Attributes
    ----------
    gear : Gear
        Its helix angle turns the section clockwise by ``tan(beta) / r`` per height z (negative: the other way).
    material : Material
    order, axial : int
        Orders of the polynomials in the section and along the width.
    refine : float
        Divides the edge lengths of the triangles.
    """

    gear: Gear
    material: Material
    order: int = 3
    axial: int = 0
    refine: float = 1.0


def panel3d(model, sector, knots, *, parts=(), bends=(), tree=None):
    """Reduce the sector of a `SolidModel` (`gearfe.geometry.mesh.sector.Sector`) to its two helicoidal sides.

    Parameters
    ----------
    knots : ndarray, shape (3, n)
        Start, top and end of hat functions of unit area along the arc of the loaded flank [mm]: unit loads per width along the
        inward normal of the helicoid, times each axial mode of `halfspace.modes`.
    parts : tuple
        Where the cracks of the sector are open, see `axial.axial`; default over the whole width.
    bends : tuple of None or (ndarray, Front)
        How the section follows their fronts (`bent.bent`), at most one of them; default: all are parallel to the teeth.
    tree : tuple, optional
        Of `dissection.dissect`.

    Returns
    -------
    Panel
        Unknowns are node by node, polar components (radial, tangential, axial), modes innermost; loads hat function by hat
        function, modes innermost. Its `own` is the full displacement with the sides held, nothing taken out. Faces of cracks
        are pushed apart at the points of `axial.Axial`, pair of nodes by pair; the opening is that in the section.
    """
    gear, degree = model.gear, model.axial
    parts = parts or (None,) * len(sector.faces)
    bends = tuple(bends) or (None,) * len(parts)
    along = axial(gear.b, degree, parts, gear.m_n, [bend and bend[1] for bend in bends])
    bent = None
    for bend in filter(None, bends):
        bent = bent_triangles(sector, *bend, along, partial(_moved_section, model, sector))
    section = section_of(model, sector, knots, bent=bent, cubic=bent is not None)
    every, sides, chain = section.numbers, section.sides, section.chain
    apart, owner = face_forces(sector, chain, section.load.shape[0], model.order, model.order)
    seams = [chain(face)[:-1] for i, pair in enumerate(sector.faces) if parts[i] for face in pair]
    seams = list(zip(seams[::2], seams[1::2], strict=True))
    load = np.concatenate([section.load, apart], axis=2)
    nodes = int(every.max()) + 1
    own_degrees = degrees(gear, sector, every, sides, degree, model.order)
    kinds = np.zeros(nodes + load.shape[2], dtype=int)  # kind of polynomials along the width, by node and load
    kinds[:nodes] = _kinds(gear, sector, every, own_degrees, sides, parts, bends, [right for _, right in seams])
    kinds[nodes + knots.shape[1] :] = [2 + 4 * i for i in owner]
    body = body_of(section._replace(load=load), along, seams=seams, kinds=kinds, bent=bent)
    even = gear.twist_rate == 0 and degree > 0 and not any(parts) and bent is None
    ids, matrix = (front_by_parity if even else front)(body, dissect(sector) if tree is None else tree)
    at = places(body, ids, np.concatenate([sides, np.arange(body.first_load, body.size.size)]))
    matrix = matrix[np.ix_(at, at)]
    sizes = body.size[sides] // 3
    border = int(body.size[sides].sum())
    edge = polar(gear, sizes, polar(gear, sizes, matrix[:border, :border]).T)
    push = polar(gear, sizes, matrix[:border, border:])
    between = -(matrix[border:, border:] + matrix[border:, border:].T) / 2
    n = knots.shape[1] * (degree + 1)
    points = block_diag(np.eye(n), *(along.at[i] for i in owner))
    unknowns = int(body.size[: body.first_load][body.there[: body.first_load]].sum())
    return panel_of(edge, push @ points.T, points @ between @ points.T, n, unknowns)


def section_of(model, sector, knots, *, plane=False, bent=None, cubic=False):
    """Return the `LoadedSection` of a sector. Its short edges are quadratic.

    Parameters
    ----------
    plane : bool
        If True, the section of a spur gear, with its ``K00`` only.
    bent : BentTriangles, optional
        The triangles that move with a front: left out of the stiffness.
    cubic : bool
        Leave short edges cubic. With a sloping front, quadratic edges would lack up to a hundredth of its contribution: the
        correction of cubics at its tip is not known from plane strain, unlike for straight cracks.
    """
    gear, order = model.gear, model.order
    numbers, count, chain = numbering(sector, order)
    load = _hats(gear, sector, chain, count, knots, order, 0.0 if plane else gear.beta_b)
    sides = np.concatenate([chain(side)[1:] for side in (sector.left, sector.right)])
    every, _ = all_nodes(numbers, count, order)
    stiffness = _section(model, sector, 0.0 if plane else gear.twist_rate, 1 if plane else 3)
    if bent is not None:
        stiffness[:, bent.index >= 0] = 0.0
    held = chain(sector.held)
    if order == ORDER and not cubic:
        held = np.append(held, bind(stiffness, load, every, quadratic_edges(gear, sector)))
    return LoadedSection(every, stiffness, load, sides, held, chain)


def _kinds(gear, sector, numbers, degree, sides, parts, bends, right):
    """Return the set of functions (`axial.Axial`) of each node: by its degree, or a special set near cracks of varying depth."""
    whole = 1 + 4 * len(parts) + degree
    out, right = whole.copy(), iter(right)
    for i, (bands, bend) in enumerate(zip(parts, bends, strict=True)):
        if bend:
            moved = (np.abs(bend[0]) > 0).any(axis=0)[sector.triangles].any(axis=0)
            out[np.unique(numbers[:, moved])] = 4 + 4 * i
        if bands:
            out[_near(gear, sector, numbers, sector.faces[i], bands, bend)] = 3 + 4 * i
            out[next(right)] = 1 + 4 * i
    out[sides] = whole[sides]
    return out


def _near(gear, sector, numbers, face, bands, bend):
    """Return the nodes of triangles near a crack: closer than `CLOSE`, or than the crack depth if the front runs out."""
    points, reach = sector.points, CLOSE * gear.m_n
    if bend:
        shift, front = bend
        inside = [end for end in np.ravel(bands).tolist() if 0 < end < front.width]
        if all(front.runs_out(end) for end in inside):
            points = points + (front.least - 1) * shift
            reach = min(reach, np.hypot(*np.diff(points[:, face[0]])).sum())
    line = points[:, face[0]]
    part = np.arange(8) / 8
    line = (line[:, :-1, None] + np.diff(line, axis=1)[..., None] * part).reshape(2, -1)
    away = np.hypot(*(points[:, :, None] - line[:, None, :])).min(axis=1)
    close = (away < reach)[sector.triangles].any(axis=0)
    return np.unique(numbers[:, close])


def polar(gear, sizes, matrix, components=3):
    """Transform rows of side nodes, `sizes` for each component, from Cartesian to polar components."""
    angle = np.repeat([-math.pi / gear.z, math.pi / gear.z], sizes.size // 2)
    before = np.cumsum(sizes) - sizes
    x = np.repeat((components - 1) * before, sizes) + np.arange(sizes.sum())
    y = x + np.repeat(sizes, sizes)
    sin, cos = np.repeat(np.sin(angle), sizes)[:, None], np.repeat(np.cos(angle), sizes)[:, None]
    out = matrix.copy()
    out[x], out[y] = sin * matrix[x] + cos * matrix[y], cos * matrix[x] - sin * matrix[y]
    return out


def _section(model, sector, twist, count=3):
    """Return the first `count` of ``K00, K01, K11`` of all triangles ``(count, m, 3 nodes, 3 nodes)``."""
    gram = _gram(sector, model.order, slice(None), sector.points)
    return _energies(gram, _between(model.material, twist)[:count, ..., :4, :4])


def _moved_section(model, sector, triangles, points, shift):
    """Return the matrices A_0, A_1, A_2, B_0, B_1, C of `bent` of some triangles with vertices at `points`."""
    gram = _gram(sector, model.order, triangles, points, shift)
    return _energies(gram, _between(model.material, model.gear.twist_rate)[[0, 3, 4, 1, 5, 2]])


def _gram(sector, order, triangles, points, shift=None):
    """Integrals ``(k, k, m, nodes, nodes)`` of products of N_X, N_Y, Y N_X - X N_Y, N and, with a `shift`, -shift . grad N.

    N are the functions of the `triangles`, with their vertices at `points`.
    """
    basis, corners = table(order), sector.triangles[:, triangles]
    bulges = sector.edge_bulges[..., triangles]
    (xx, xy), (yx, yy) = jacobians(points, corners, bulges, order).transpose(1, 2, 0, 3)
    area = xx * yy - xy * yx
    first, second = basis.slope
    dx = (yy / area)[:, None] * first - (yx / area)[:, None] * second
    dy = (xx / area)[:, None] * second - (xy / area)[:, None] * first
    place = np.einsum("cq,dcm->dmq", basis.corner, points[:, corners])
    x, y = place + np.einsum("kqg,kdgm->dmq", basis.bulge, bulges, optimize=True)
    parts = [dx, dy, y[:, None] * dx - x[:, None] * dy, np.broadcast_to(basis.value, dx.shape)]
    if shift is not None:
        p, q = np.einsum("cq,dcm->dmq", basis.corner, shift[:, corners])
        parts.append(-(p[:, None] * dx + q[:, None] * dy))
    weight = np.sqrt(area * basis.weight)[:, None]
    base = np.stack([part * weight for part in parts], axis=1).reshape(area.shape[0], len(parts) * basis.count, -1)
    gram = (base @ base.mT).reshape(-1, len(parts), basis.count, len(parts), basis.count)
    return gram.transpose(1, 3, 0, 2, 4)


def _energies(gram, between):
    """Return the matrices ``(n, m, 3 nodes, 3 nodes)`` from the integrals of `_gram` and n energies of `_between`."""
    n, k, (_, _, m, nodes, _) = len(between), len(gram), gram.shape
    out = (between.reshape(9 * n, k**2) @ gram.reshape(k**2, -1)).reshape(n, 3, 3, m, nodes, nodes)
    return out.transpose(0, 3, 4, 1, 5, 2).reshape(n, m, 3 * nodes, 3 * nodes)


def _between(material, twist):
    """Return energies ``(6, 3, 3, 5, 5)`` between components, in products of the functions of `_gram`.

    Strains are those of v, of v_z, and of the part c that a front's slope adds. The energies are v-v, v-v_z (K01), v_z-v_z, v-c
    with c-v, c-c, and c-v_z.
    """
    dx, dy, around, value, carries = np.eye(5)
    flat, along, carried = np.zeros((3, 6, 3, 5))  # strains xx, yy, zz, xy, xz, yz from gradients
    flat[0, 0] = flat[3, 1] = flat[4, 2] = dx
    flat[1, 1] = flat[3, 0] = flat[5, 2] = dy
    flat[2, 2] = flat[4, 0] = flat[5, 1] = -twist * around
    flat[4, 1], flat[5, 0] = twist * value, -twist * value
    along[2, 2] = along[4, 0] = along[5, 1] = value
    carried[2, 2] = carried[4, 0] = carried[5, 1] = carries
    stiffness = material.shear_modulus * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    stiffness[:3, :3] += material.lame("plane strain")[0]

    def energy(one, two):
        return np.einsum("ij,icf,jdg->cdfg", stiffness, one, two)

    mixed = energy(flat, carried) + energy(carried, flat)
    plain = energy(flat, flat), energy(flat, along), energy(along, along)
    return np.array([*plain, mixed, energy(carried, carried), energy(carried, along)])


def _hats(gear, sector, chain, count, knots, order, tilt):
    """Return the nodal forces ``(count, 3, n)`` of hat function pressures in the section at z = 0. `tilt` is beta_b.

    The forces rotate with the section along z. The inward normal of the helicoid is ``(-cos(beta_b) n, sin(beta_b))``, with n
    the outward normal of the section. It is perpendicular to the profile's tangent and to the helix ``(w Y, -w X, 1)``.
    """
    if not knots.size:  # A missing tooth has no flank.
        return np.zeros((count, 3, 0))
    gauss, weight = GAUSS
    arcs = arc_at(gear, sector.roll)
    clipped = np.clip(knots[:, :, None], arcs[:-1], arcs[1:])  # (knots, hat functions, edges)
    side, hat, edge = np.nonzero(clipped[1:] > clipped[:-1])  # parts of edges on which a hat function is linear
    a, b = (ends[side, hat, edge, None] for ends in (clipped[:-1], clipped[1:]))
    start, top, stop = knots[:, hat, None]
    arc = (a + b) / 2 + (b - a) / 2 * gauss
    roll = roll_at_arc(gear, arc)
    low, high = sector.roll[edge, None], sector.roll[edge + 1, None]
    height = 2 / (stop - start) * np.minimum((arc - start) / (top - start), (stop - arc) / (stop - top))
    normal = np.concatenate([-math.cos(tilt) * flank_normal(gear, roll), np.full((1, *arc.shape), math.sin(tilt))])
    shapes = lagrange(order, tuple((2 * (roll - low) / (high - low) - 1).ravel().tolist())).reshape(-1, *arc.shape)
    force = np.einsum("npg,pg,cpg->pnc", shapes, weight * (b - a) / 2 * height, normal)
    out = np.zeros((count, knots.shape[1], 3))
    np.add.at(out, (chain(np.array([sector.flank[edge], sector.flank[edge + 1]])).T, hat[:, None]), force)
    return out.mT
