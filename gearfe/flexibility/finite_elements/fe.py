"""Flexibility of one gear between its contacts, by finite elements (plane strain or plane stress).

Each loaded flank carries *hat function pressures* of unit resultant along the involute normal; the displacement of a contact is
the same hat function average, so the influence matrix ``C = B' K^-1 B`` is symmetric. On one tooth it is split::

    C(i, j) = S(s_i, s_j) + c * mean(-ln |s_i - s_j|)

into the half-plane's logarithm, known exactly, and a smooth rest S, which splines interpolate.

The discretisation error at the kinks of a hat function is independent of the resolution if the number of edges per hat function
is constant. With `SPAN` edges on either side it is 0.5 to 1 % of c. It is proportional to the sum of (change of slope)**2 over
the kinks: 6 for the kinks (1, -2, 1) of a hat function, 6 / 16 for (1, 0, -2, 0, 1) / 4 of a hat function twice as wide on the
same edges. S(s, s) is therefore computed from wide hat functions, which are sums of three (`gearfe.flexibility.hats.wider`).
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_matrix, hstack

from ...geometry.cubic import Bicubic, Cubic, through
from ...geometry.damage.chip import loaded_side
from ...geometry.damage.missing import missing_teeth
from ...geometry.mesh.outline import GROWTH, stations
from ...geometry.mesh.section_mesh import section
from ...geometry.tooth.profile import arc_at, flank_normal, turned
from ..hats import SPAN, hat_knots, wider
from ..hertz import half_plane, hat_logarithm
from ..plane import BELOW, TILT, Flexibility, SeamFaces, glued, leaning, reached_teeth
from .elasticity import GAUSS_3, HeldSection, edge_nodes, edge_shapes

# default edge lengths in modules: loaded flank, its tip corner and lower end, flanks that are only read, fillets, the
# three next teeth, all other teeth
EDGES = {"flank": 0.04, "tip": 0.0005, "low": 0.01, "read": 0.2, "fillet": 0.1, "near": 0.4, "far": 0.9}


@dataclass(frozen=True, slots=True)
class Hats:
    """Unit hat function pressures on one flank: knots along the arc ``(3, n)`` [mm] and load columns."""

    knots: np.ndarray
    load: object

    @property
    def arc(self):
        """Arc lengths of the centroids of the hat functions [mm]."""
        return self.knots.mean(axis=0)


def hats(section_, tooth, *, corner=False, tilt=0.0):
    """Return hat function pressures of unit resultant along the loaded flank of `tooth`, with tops on every second inner vertex.

    With `corner`, a last, one-sided hat function has its top at the tip corner. With `tilt`, the angle [rad] from the normal
    away from the gear's centre, only the hat functions of `_leans` are returned.
    """
    gear, roll = section_.gear, section_.roll[tooth % section_.gear.z]
    arc = arc_at(gear, roll)
    knots = hat_knots(arc, corner=corner)
    first = np.minimum(SPAN * np.arange(knots.shape[1]), roll.size - 1 - 2 * SPAN)
    if tilt:
        numbers = _leans(gear, knots)
        knots, first = knots[:, numbers], first[numbers]

    def height(s):
        start, top, stop = knots[:, :, None, None]
        fall = np.where(stop > top, (stop - s) / np.where(stop > top, stop - top, 1.0), 1.0)
        return np.maximum(np.minimum((s - start) / (top - start), fall), 0.0) * 2 / (stop - start)

    return Hats(knots, flank_load(section_, tooth, height, first, 2 * SPAN, tilt))


def flank_load(section_, tooth, pressure, first, count, tilt=0.0):
    """Consistent nodal forces ``(2 nodes, n)`` [N/mm] of pressures on the loaded flank of `tooth`.

    Parameters
    ----------
    pressure : callable
        Maps arcs ``(n, count, points)`` from the base circle [mm] to pressures [MPa], row by row.
    first, count
        First flank edge each pressure acts on ``(n,)``, and the number of edges it does.
    tilt : float
        Of the pressures from the normal towards the outside of the gear [rad].
    """
    gear, mesh = section_.gear, section_.mesh
    tooth %= gear.z
    roll = section_.roll[tooth]
    points, weights = GAUSS_3
    shapes, slopes = edge_shapes(points)
    nodes = edge_nodes(mesh, section_.flank[tooth])
    length = np.hypot(*np.einsum("dne,np->dep", mesh.doflocs[:, nodes], slopes)) * weights
    rolls = (roll[:-1, None] + roll[1:, None]) / 2 + (roll[1:, None] - roll[:-1, None]) / 2 * points
    normal = turned(flank_normal(gear, rolls), 2 * np.pi * tooth / gear.z + tilt)
    edge = np.asarray(first)[:, None] + np.arange(count)
    height = pressure(arc_at(gear, rolls[edge]))
    force = -np.einsum("np,hep,hep,dhep->nhed", shapes, height, length[edge], normal[:, edge])
    rows = 2 * nodes[:, edge][..., None] + np.arange(2)
    columns = np.broadcast_to(np.arange(edge.shape[0])[:, None, None], force.shape)
    shape = (2 * mesh.doflocs.shape[1], edge.shape[0])
    return coo_matrix((force.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsc()


def mesh_gear(gear, *, loaded=(0,), read=(), refine=1.0, teeth=None, cracks=(), broken=()):
    """Mesh a section of `gear` for loads on the teeth `loaded` and for displacements read on the teeth `read`.

    `refine` divides every edge length of `EDGES`. It is the section of the whole gear, or of a number of `teeth` on a plain rim,
    with `cracks` and `broken` teeth, as in `gearfe.geometry.mesh.section_mesh.section`.
    """
    if not (math.isfinite(refine) and refine > 0):
        raise ValueError(f"refine = {refine}, but it divides the edge lengths: give refine > 0, 1 is the default mesh")
    edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
    even = {"span": SPAN, "growth": GROWTH / refine}  # The graded ends are refined too.

    def vertices(tooth, size, **ends):
        end = loaded_side(gear, broken, tooth)
        # a bicubic spline needs a minimum number of hat functions
        longest = abs(arc_at(end, end.roll_a) - arc_at(end, end.roll_f)) / (8 * SPAN)
        return stations(end, min(edge[size], longest), **ends, **even)

    rolls = {tooth: vertices(tooth, "flank", tip=edge["tip"], low=edge["low"]) for tooth in loaded}
    rolls |= {tooth: vertices(tooth, "read", tip=0.025 * gear.m_n / refine) for tooth in read}
    return section(
        gear,
        rolls,
        fillet_size=edge["fillet"],
        size=edge["near"],
        far_size=edge["far"],
        teeth=teeth,
        cracks=cracks,
        broken=broken,
    )


def flexibility(gear, material, *, neighbours=1, state="plane strain", refine=1.0, teeth=None):
    """Compute the `Flexibility` of a healthy gear by finite elements: one factorisation, one loaded tooth.

    All teeth of a healthy gear are equal, so the displacement of tooth k under a load on tooth 0 holds for any two teeth at
    this distance.

    Parameters
    ----------
    neighbours : int
        How many following teeth may carry load at the same time.
    state : {"plane strain", "plane stress"}
    refine, teeth
        See `mesh_gear`.
    """
    mesh = mesh_gear(gear, read=range(1, neighbours + 1), refine=refine, teeth=teeth)
    body = HeldSection(mesh.mesh, material, state=state)
    on = {0: hats(mesh, 0, corner=True)} | {tooth: hats(mesh, tooth) for tooth in range(1, neighbours + 1)}
    tilted = _tilted(mesh, 0)
    influence, at = _between(body, [part.load for part in (*on.values(), *tilted)])
    loaded, c = on[0], half_plane(material, state)
    near, block = own_tooth(loaded, influence[at[0], at[0]], c)
    leans = _leaning(gear, loaded, influence, at[0], at[-2:], c)
    base, limits = through(loaded.arc), (loaded.arc[0], loaded.arc[-1])
    far = {(0, k): Bicubic(base, influence[at[0], at[k]], through(on[k].arc)) for k in on if k}
    return Flexibility(
        gear, {0: near}, far, {0: block}, limits, refine, 2 * mesh.mesh.doflocs.shape[1], basis=base, leans={0: leans}
    )


def _tilted(mesh, tooth):
    """Return the hat functions of `_leans` of a flank, tilted towards either side."""
    return [hats(mesh, tooth, corner=True, tilt=tilt) for tilt in (TILT, -TILT)]


def _leans(gear, knots):
    """Return the numbers of the hat functions at the foot of a flank, half-way up, `BELOW` the tip, and at the tip."""
    away = knots[1, -1] - knots.mean(axis=0)
    below = min(BELOW * gear.m_n, away[0] / 2)
    inner = [int(np.argmin(np.abs(away[1:-1] - place))) + 1 for place in ((away[0] + below) / 2, below)]
    return [0, *inner, knots.shape[1] - 1]


def _leaning(gear, on, influence, plain, tilted, coefficient):
    """Return `leaning` of a tooth with hat functions `on`, from the influence of all loads and the places of the loads."""
    numbers = _leans(gear, on.knots)
    local, diagonal = coefficient * np.diag(hat_logarithm(on.knots[:, numbers], on.knots[:, numbers])), np.diag(influence)
    return leaning(on.arc[numbers], diagonal[plain][numbers] - local, *(diagonal[part] - local for part in tilted))


def _between(body, loads):
    """Displacements between all columns of `loads`, and the rows and columns that belong to each load."""
    ends = np.cumsum([0, *(load.shape[1] for load in loads)]).tolist()
    return body.between(hstack(loads, format="coo")), [slice(a, b) for a, b in pairwise(ends)]


def damaged_flexibility(
    gear, material, cracks, healthy, *, broken=(), neighbours=1, state="plane strain", refine=1.0, teeth=None
):
    """Return the `Flexibility` of a gear with cracks and `broken` teeth. Each tooth of `reached_teeth` is loaded and read.

    Tooth numbers of `broken` refer to the loaded side of this gear. `healthy` is that of the same gear without cracks, for teeth
    further away. `flexibility` describes the other arguments.
    """
    gone = missing_teeth(gear, broken)
    solved = [tooth for tooth in reached_teeth(gear, (*cracks, *broken), neighbours) if tooth not in gone]
    mesh = mesh_gear(gear, loaded=solved, refine=refine, teeth=teeth, cracks=cracks, broken=broken)
    body = HeldSection(mesh.mesh, material, state=state)
    on = {tooth: hats(mesh, tooth, corner=True) for tooth in solved}
    faces = face_columns(mesh)
    tilted = [part for tooth in solved for part in _tilted(mesh, tooth)]
    influence, at = _between(body, [*(on[tooth].load for tooth in solved), faces, *(part.load for part in tilted)])
    leaned = dict(zip(solved, zip(at[len(solved) + 1 :: 2], at[len(solved) + 2 :: 2], strict=True), strict=True))
    at, opened = dict(zip(solved, at, strict=False)), at[len(solved)]
    opening = {tooth: influence[opened, at[tooth]] for tooth in solved}
    apart = influence[opened, opened]
    stiffness = np.linalg.inv(apart)
    leans = {}
    for tooth in solved:
        shut = influence.copy()
        for part in (at[tooth], *leaned[tooth]):
            shut[part, part] -= influence[opened, part].T @ stiffness @ influence[opened, part]
        leans[tooth] = _leaning(gear, on[tooth], shut, at[tooth], leaned[tooth], half_plane(material, state))
    own, ahead = glued(gear, solved, lambda i, j: influence[at[i], at[j]], opening, stiffness)
    parts = {tooth: own_tooth(on[tooth], own[tooth], half_plane(material, state)) for tooth in solved}
    near, blocks = ({tooth: part[k] for tooth, part in parts.items()} for k in (0, 1))
    bases = {tooth: through(on[tooth].arc) for tooth in solved}
    far = {(i, j): Bicubic(bases[i], one, bases[j]) for (i, j), one in ahead.items()}
    seam = SeamFaces({t: Cubic(on[t].arc, opening[t].T) for t in solved}, apart, stiffness) if cracks else None
    tips = {
        tooth: _shortened(mesh, tooth, on[tooth], bases[tooth])
        for tooth in solved
        if loaded_side(gear, broken, tooth) is not gear
    }
    whole = next(tooth for tooth in solved if tooth not in tips)
    limits = on[whole].arc[0], on[whole].arc[-1]
    options = {"basis": bases[whole], "leans": leans, "missing": gone, "tips": tips}
    return Flexibility(gear, near, far, blocks, limits, refine, faces.shape[0], healthy, seam, **options)


def _shortened(mesh, tooth, on, base):
    """Return the last roll length, the ends and the `base` of the flank of a chipped tooth with hat functions `on`."""
    return float(mesh.roll[tooth][-1]), (on.arc[0], on.arc[-1]), base


def face_columns(mesh):
    """Return columns of unit forces that push apart facing crack nodes, except tips and quarter points."""
    columns = []
    for seam in mesh.seams:
        ahead = np.gradient(mesh.mesh.doflocs[:, seam.faces[0]], axis=1)[:, :-2]
        normal = np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead)
        columns += list(zip(*seam.faces[:, :-2].tolist(), normal.T, strict=True))
    at = np.arange(len(columns))
    left, right = (np.array([column[side] for column in columns], dtype=int) for side in (0, 1))
    normal = np.array([column[2] for column in columns]).reshape(-1, 2).T
    rows = [2 * nodes + d for nodes in (left, right) for d in (0, 1)]
    forces = np.concatenate([*normal, *-normal])
    return coo_matrix((forces, (np.concatenate(rows), np.tile(at, 4))), shape=(2 * mesh.mesh.doflocs.shape[1], at.size)).tocsc()


def own_tooth(on, influence, coefficient):
    """Return splines S(s, s) of one tooth and S(s, s') between its hat functions, from their influence matrix.

    S(s, s) is computed from hat functions twice as wide (see the module). At both ends of the flank there is no room for them.
    There the value of the single hat function is used, plus the difference of both at the nearest wide hat.
    """
    smooth = influence - coefficient * hat_logarithm(on.knots, on.knots)
    arc, wide, single = on.arc[:-1], wider(on.knots[:, :-1]), np.diag(smooth)[:-1]  # The corner's hat function is excluded.
    middle, values = wide @ arc, np.einsum("ij,jk,ik->i", wide, smooth[:-1, :-1], wide)
    inner = Cubic(middle[1:-1], values[1:-1])
    values[[0, -1]] = single[[0, -1]] + inner(arc[[1, -2]]) - single[[1, -2]]
    near = Cubic(middle, values)
    excess = near(arc) - single
    return near, (smooth + smooth.T) / 2 + np.diag(np.append(excess, excess[-1]))
