"""Transverse section of a whole gear as curved second-order triangles, with opened cracks.

gmsh meshes the inside. Every vertex of the outline and the middle of every boundary edge is on the exact profile, computed from
the parameter of the curve and not by projection.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from skfem import MeshTri, MeshTri2

from ..damage.crack import check_apart, check_through, meshed_path, mirrored, start_arc
from ..damage.seam import open_seam
from ..tooth.gear import Gear
from ..tooth.profile import cartesian, fillet_length, lengths, root_curve, turned
from .mesher import triangulate
from .outline import along, held_circle, inside, outline

CRACK_EDGE = 0.2  # edge length at a crack tip relative to that of the fillet; at most a fifth of the crack's last straight part


@dataclass(frozen=True, slots=True)
class Seam:
    """The two faces of a crack: node numbers ``(2, n)`` (left, right) of vertices and edge middles from mouth to tip.

    The last column is the tip, with the same node twice. The column before it is the quarter-point node of the edge at the
    tip.
    """

    faces: np.ndarray


@dataclass(frozen=True, slots=True)
class Section:
    """A meshed gear section.

    `mesh` is a `skfem.MeshTri2` [mm] with boundaries ``held`` (bore, or outside of a ring) and ``rim`` (the whole toothed
    outline). `flank[k]` holds the vertices of the loaded flank of tooth k from root to tip and `roll[k]` their roll lengths
    [mm]; `fillet[k]` those of the fillet below it, from the flank to the root; `seams` the cracks.
    """

    gear: Gear
    mesh: MeshTri2
    flank: dict
    roll: dict
    fillet: dict
    seams: tuple = ()


def section(gear, rolls, *, fillet_size, size, far_size, teeth=None, cracks=(), broken=(), slots=()):
    """Mesh the whole section of `gear` with all teeth and the true rim.

    Parameters
    ----------
    gear : Gear
    rolls : dict of int to ndarray
        Roll lengths [mm] of the loaded-flank vertices of the teeth that are loaded or read, by tooth number (tooth 1 is
        the neighbour on the loaded side); they run from the form point to the tip.
    fillet_size : float
        Edge length on the fillets of those teeth [mm].
    size : float
        Edge length on the three next teeth to either side [mm].
    far_size : float
        Edge length on all other teeth [mm].
    teeth : int, optional
        Keep only this many teeth around each loaded one and replace the others by a plain root circle: cheaper, softer
        (0.3 % in double contact with 5 teeth). Default: all teeth.
    cracks : sequence of Crack
        Their `tooth` is the number used in `rolls`.
    broken : sequence of (MissingTooth or Chip)
        Missing teeth and chipped tips, in the same numbers.
    slots : sequence of Slot
        Holes in the body, with edges of at most `size` and of a third of the material next to them.

    Returns
    -------
    Section
    """
    if len({tooth % gear.z for tooth in rolls}) != len(rolls):
        raise ValueError(f"teeth {sorted(rolls)} are not distinct on a gear of z = {gear.z}")
    rolls = {tooth % gear.z: np.asarray(roll, dtype=float) for tooth, roll in rolls.items()}
    marks, lines = crack_lines(gear, cracks, fillet_size, slots)
    rim, flanks, fillets, starts = outline(
        gear, rolls, fillet_size=fillet_size, size=size, far_size=far_size, teeth=teeth, marks=marks, broken=broken
    )
    chains = crack_chains(gear, cracks, lines, rim, starts)
    holes = [slot.outline(min(size, slot.ligament(gear) / 3)) for slot in slots]
    mesh, faces = fill(rim, held_circle(gear), chains, ring=gear.internal, holes=holes)
    return Section(gear, mesh, flanks, rolls, fillets, tuple(map(Seam, faces)))


def crack_lines(gear, cracks, fillet_size, slots=()):
    """Return the starts and the paths of cracks, both by tooth and side.

    The former are `marks` of `gearfe.geometry.mesh.outline.outline`, the latter points ``(2, n)`` from mouth to tip [mm].
    """
    check_through(cracks, "a mesh of the section")
    check_apart(gear, cracks)
    marks, lines = {}, {}
    for crack in cracks:
        place = crack.tooth % gear.z, crack.side
        corners = turned(meshed_path(gear, crack), 2 * math.pi * crack.tooth / gear.z)
        length = lengths(corners)[-1]
        marks[place] = start_arc(gear, crack), min(fillet_size, length / 4)
        tip = min(CRACK_EDGE * fillet_size, math.dist(corners[:, -2], corners[:, -1]) / 5)
        # The crack approaches the centre-line, so the mesh is refined as the ligament shrinks.
        if crack.turning and crack.level > 0.5:
            left = math.dist(corners[:, -1], turned(mirrored(gear, crack), 2 * math.pi * crack.tooth / gear.z))
            opposite = "unloaded" if crack.side == "loaded" else "loaded"
            marks.setdefault((crack.tooth % gear.z, opposite), (marks[place][0], min(fillet_size, left / 4)))
            tip = min(tip, left / 8)
        elif crack.path is not None:
            tip = min(tip, _ligament(gear, corners, crack.tooth) / 8)
        for slot in slots:
            tip = min(tip, float(slot.distance(corners[:, -1:])[0]) / 8)
        lines[place] = corners, tip
    return marks, {place: along(corners, marks[place][1], tip, max(fillet_size, tip)) for place, (corners, tip) in lines.items()}


def crack_chains(gear, cracks, lines, rim, starts):
    """Return the `chains` of `fill` for the `lines` of cracks that start at the vertices `starts` of a rim.

    ValueError if one leaves the body or two start at the same vertex.
    """
    chains = []
    for crack, (place, line) in zip(cracks, lines.items(), strict=True):
        _check_within(gear, crack, rim[:, ::2], starts[place], line[:, 1:])
        chains.append((starts[place], line[:, 1:]))
    if len({start for start, _ in chains}) < len(chains):
        raise ValueError(f"z = {gear.z}: two cracks start at the same place between two teeth: leave one out, or start it higher")
    return chains


def _ligament(gear, corners, tooth):
    """Return the distance [mm] from a crack tip to the held circle or the surrounding fillets."""
    tip, arcs = corners[:, -1], np.linspace(0.0, fillet_length(gear), 40)
    fillets = [cartesian(*root_curve(gear, arcs)) * [[sign], [1]] for sign in (-1, 1)]
    turns = (2 * math.pi * (tooth + k) / gear.z for k in (-1, 0, 1))
    points = np.hstack([turned(line, turn) for turn in turns for line in fillets])
    apart = np.hypot(*(points - tip[:, None]))
    behind = np.hypot(*(points - corners[:, :1])) < 0.5 * lengths(corners)[-1]
    return min(abs(np.hypot(*tip) - gear.held), apart[~behind].min(initial=math.inf))


def _check_within(gear, crack, rim, start, line):
    """Raise ValueError if a crack crosses the polygon of the outline's vertices, because gmsh would not terminate."""
    at, to = np.hstack([rim[:, [start]], line[:, :-1]]), line
    ends = np.roll(rim, -1, axis=1)

    def turn(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    a, b, p, q = rim[:, :, None], ends[:, :, None], at[:, None, :], to[:, None, :]
    cut = (turn(a, b, p) * turn(a, b, q) < 0) & (turn(p, q, a) * turn(p, q, b) < 0)
    cut[[start - 1, start], 0] = False  # These edges touch the crack only at its mouth, so the crack does not cut them.
    if cut.any() or (inside(rim, line) == gear.internal).any():
        raise ValueError(
            f"crack from {crack.start!r} at {math.degrees(crack.angle):.3g} degrees on tooth {crack.tooth} of z = {gear.z} "
            "leaves the body along its outline: no mesh can follow it; start it elsewhere, or change its angle or its length"
        )


def fill(rim, held, chains=(), *, ring=False, holes=()):
    """Mesh the area between two closed loops in curved second-order triangles, opened along cracks.

    Parameters
    ----------
    rim, held : ndarray, shape (2, 2 n)
        Loops: vertices at even places, edge middles at odd [mm]; nodes are numbered rim, held, holes, cracks, inside. `held`
        may be empty.
    chains : sequence of (int, ndarray)
        Cracks: the rim vertex each starts at, and its further vertices ``(2, n)`` up to the tip.
    ring : bool
        Whether `held` is the outer loop.
    holes : sequence of ndarray
        Loops of slots, in the same form.

    Returns
    -------
    mesh : skfem.MeshTri2
        With boundaries ``rim``, ``held`` and ``slots``.
    faces : list of ndarray, shape (2, 2 n + 1)
        Nodes of both faces of each crack, see `Seam`.
    """
    loops = [loop for loop in (rim, held, *holes) if loop.size]
    points, triangles = triangulate([loop[:, ::2] for loop in loops], chains, ring)
    first = sum(loop.shape[1] // 2 for loop in loops)
    lines, doubles = [], {}
    for start, inner in chains:
        chain = np.append(start, first + np.arange(inner.shape[1]))
        first += inner.shape[1]
        points, triangles, double = open_seam(points, triangles, chain)
        lines.append((chain, double))
        doubles[start] = int(double[0])
    linear = MeshTri(np.ascontiguousarray(points), np.ascontiguousarray(triangles))
    mesh = _curve(linear, loops, doubles)
    faces = [_faces(mesh, chain, double) for chain, double in lines]
    if not faces:
        return mesh, faces
    nodes = mesh.doflocs.copy()
    for chain, face in zip((c for c, _ in lines), faces, strict=True):
        _quarter(mesh, nodes, int(chain[-1]))
        nodes[:, face[:, -2]] = 0.25 * nodes[:, face[:, -3]] + 0.75 * nodes[:, face[:, -1]]
    return replace(mesh, doflocs=nodes), faces


def _quarter(mesh, nodes, tip):
    """Move the middles of all edges at `tip` to the quarter point, for displacements proportional to the root of the distance."""
    edges = np.flatnonzero((mesh.facets == tip).any(axis=0))
    far = mesh.facets[:, edges].sum(axis=0) - tip
    nodes[:, mesh.nvertices + edges] = 0.25 * nodes[:, far] + 0.75 * nodes[:, [tip]]


def _faces(mesh, chain, double):
    lookup = {(a, b): i for i, (a, b) in enumerate(mesh.facets.T.tolist())}
    out = []
    for side in (chain.tolist(), double.tolist()):
        middle = [mesh.nvertices + lookup[min(a, b), max(a, b)] for a, b in zip(side[:-1], side[1:], strict=True)]
        out.append(np.append(np.array([side[:-1], middle]).T.ravel(), side[-1]))
    return np.array(out)


def _curve(linear, loops, doubles):
    """Return a second-order mesh with every boundary edge curved, and with named boundaries."""
    mesh = MeshTri2.from_mesh(linear)
    nodes = mesh.doflocs.copy()
    boundary = linear.boundary_facets()
    facets = {tuple(pair): i for i, pair in zip(boundary, np.sort(linear.facets[:, boundary].T).tolist(), strict=True)}
    kinds, first = [], 0
    for points in loops:
        ring = (first + np.arange(points.shape[1] // 2)).tolist()
        edges = [_boundary_edge(facets, doubles, a, b) for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
        nodes[:, linear.nvertices + np.array(edges)] = points[:, 1::2]
        kinds.append(np.array(edges))
        first += points.shape[1] // 2
    names = dict(zip(("rim", "held"), kinds, strict=False)) | ({"slots": np.concatenate(kinds[2:])} if kinds[2:] else {})
    return replace(mesh, doflocs=nodes).with_boundaries(names)


def _boundary_edge(facets, doubles, a, b):
    """Return the boundary facet between two loop vertices. A crack mouth may have doubled one of them."""
    for p in (a, doubles.get(a, a)):
        for q in (b, doubles.get(b, b)):
            if (min(p, q), max(p, q)) in facets:
                return facets[min(p, q), max(p, q)]
    raise RuntimeError("gmsh changed the outline: an edge of it is missing from the mesh; change the resolution")
