"""gmsh in, scikit-fem out: the transverse section of a whole gear as curved second-order triangles.

gmsh only fills the inside. Every vertex of the outline is placed here, on the exact profile, and so is the middle of
every boundary edge, by its own parameter (not by projection).
"""

import contextlib
import math
from dataclasses import dataclass, replace

import numpy as np
from skfem import MeshTri, MeshTri2

from .gear import Gear
from .tooth import arc_at, fillet_length, flank, roll_at_arc, root_curve, root_half_angle

NEAR = 3  # teeth beside the loaded ones that get the edge length `size`; those beyond get `far_size`
GROWTH = 0.25  # of the edge length per length, away from fine places of a flank


@dataclass(frozen=True, slots=True)
class Section:
    """A meshed gear section.

    `mesh` is a `skfem.MeshTri2` [mm] with boundaries ``held`` (bore, or outside of
    a ring) and ``rim`` (the whole toothed outline). `flank[k]` holds
    the vertices of the loaded flank of tooth k from root to tip and `roll[k]` their roll lengths [mm]; `fillet[k]`
    those of the fillet below it, from the flank to the root.
    """

    gear: Gear
    mesh: MeshTri2
    flank: dict
    roll: dict
    fillet: dict


@contextlib.contextmanager
def gmsh_session():
    """A quiet gmsh session that is closed whatever happens.

    Raises
    ------
    RuntimeError
        If gmsh or one of the system libraries it loads is missing; the message says what to install.
    """
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise RuntimeError(
            f"gmsh cannot be loaded ({error}); install it with 'pip install gmsh' and, on Debian, 'apt-get install libglu1-mesa "
            "libgl1 libxcursor1 libxft2 libxinerama1 libxfixes3 libxrender1 libgomp1'"
        ) from error
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        yield gmsh
    finally:
        gmsh.finalize()


def stations(gear, spacing, *, tip=None, low=None, patches=(), span=1):
    """Roll lengths [mm] of flank vertices, from the form point to the tip.

    The arc between them is about `spacing` [mm], graded down to `tip` and `low` towards the two ends, where the
    flexibility changes fast, and to the size of each patch ``(first arc, last arc, size)`` [mm, from the base circle].
    The number of intervals is a multiple of `span`.
    """
    start, stop = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    fine = [(first, last, size) for first, last, size in patches]
    fine += [(stop, stop, tip or spacing), (start, start, low or spacing)]
    smallest = min(size for _, _, size in fine)
    arc = np.linspace(start, stop, 2 + int(4 * (stop - start) / min(smallest, spacing)))
    step = np.full(arc.size, float(spacing))
    for first, last, size in fine:
        away = np.maximum(np.maximum(first - arc, arc - last), 0.0)
        step = np.minimum(step, size + GROWTH * away)
    count = np.concatenate([[0.0], np.cumsum(np.diff(arc) * (1 / step[1:] + 1 / step[:-1]) / 2)])
    intervals = span * max(1, math.ceil(count[-1] / span - 1e-6))
    placed = np.interp(np.linspace(0, count[-1], intervals + 1), count, arc)
    placed[0], placed[-1] = start, stop
    return roll_at_arc(gear, placed)


def section(gear, rolls, *, fillet_size, size, far_size, teeth=None):
    """Mesh the whole section of `gear`, all teeth and the true rim.

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

    Returns
    -------
    Section
    """
    if len({tooth % gear.z for tooth in rolls}) != len(rolls):
        raise ValueError(f"teeth {sorted(rolls)} are not distinct on a gear of z = {gear.z}")
    rolls = {tooth % gear.z: np.asarray(roll, dtype=float) for tooth, roll in rolls.items()}
    radius, angle, where = _outline(gear, rolls, fillet_size, size, far_size, teeth)
    rim = np.array([radius * np.sin(angle), radius * np.cos(angle)])
    held = _held(gear)
    linear = _fill(rim[:, ::2], held[:, ::2], ring=gear.internal)
    mesh = _curve(linear, (rim, held))
    return Section(gear, mesh, {k: v[0] for k, v in where.items()}, rolls, {k: v[1] for k, v in where.items()})


def _held(gear):
    """The held circle, bore or outside of a ring: vertices at even places, edge middles at odd."""
    size = min(0.35 * abs(gear.r_f - gear.held), 2 * math.pi * gear.held / 16)
    count = max(12, math.ceil(2 * math.pi * gear.held / size))
    angle = np.linspace(0, 2 * math.pi, 2 * count, endpoint=False)
    return gear.held * np.array([np.sin(angle), np.cos(angle)])


def _doubled(values):
    """Insert the middles: parameters of vertices and, at odd places, of edge middles."""
    values = np.asarray(values, dtype=float)
    out = np.empty(2 * values.size - 1)
    out[::2] = values
    out[1::2] = (values[1:] + values[:-1]) / 2
    return out


def _even(length, size, least):
    return _doubled(np.linspace(0, 1, max(least, round(length / size)) + 1))


def _half(gear, roll, fillet_size, size):
    """Half tooth from tip middle to root middle: radius, angle, vertex ranges of flank and fillet."""
    width = gear.half_thickness(gear.r_a) * gear.r_a
    corner = arc_at(gear, roll[-1]) - arc_at(gear, roll[-2])
    tip = _doubled(1 - _graded(corner, size, width)[::-1] / width)
    # by roll angle, and by arc near the base circle, where roll ~ sqrt(arc)
    middle = _doubled(roll[::-1])
    below = gear.r_f * (math.pi / gear.z - root_half_angle(gear))
    root = (fillet_length(gear) + below) * _even(fillet_length(gear) + below, fillet_size, 2)[::-1]
    pieces = [
        (np.full(tip.size, gear.r_a), tip * gear.half_thickness(gear.r_a)),
        flank(gear, middle),
        root_curve(gear, root - below),
    ]
    radius = np.concatenate([p[0][:-1] for p in pieces])
    angle = np.concatenate([p[1][:-1] for p in pieces])
    ends = np.cumsum([p[0].size - 1 for p in pieces]) // 2
    return radius, angle, ends[0] + np.arange(roll.size), ends[1] + np.arange(root.size // 2 + 1)


def _graded(first, last, length):
    """Distances growing from 0 to `length` [mm], in steps from `first` up to `last`."""
    steps = [min(first, length)]
    while sum(steps) < length:
        steps.append(min(steps[-1] * (1 + GROWTH * 2), last))
    return np.concatenate([[0.0], np.cumsum(steps)]) * (length / sum(steps))


def _outline(gear, rolls, fillet_size, size, far_size, teeth):
    """All teeth clockwise, starting at the middle of tooth 0's tip; vertices at even places, edge middles at odd."""
    plain = _half(gear, stations(gear, size), fillet_size, size)
    coarse = _half(gear, stations(gear, size), size, size)
    far = _half(gear, stations(gear, far_size), far_size, far_size)
    gone = _no_tooth(gear, far_size)

    def half(tooth, *, loaded_side):
        distance = min(abs((tooth - k + gear.z // 2) % gear.z - gear.z // 2) for k in rolls)
        if teeth is not None and distance > teeth // 2:
            return gone
        if distance == 0:
            return _half(gear, rolls[tooth], fillet_size, size) if loaded_side else plain
        return coarse if distance <= NEAR else far

    radii, angles, where, count = [], [], {}, 0
    for tooth in range(gear.z):
        right, left = half(tooth, loaded_side=True), half((tooth + 1) % gear.z, loaded_side=False)
        turn = 2 * math.pi * tooth / gear.z
        radii += [right[0], [gear.r_f], left[0][:0:-1]]
        angles += [turn + right[1], [turn + math.pi / gear.z], turn + 2 * math.pi / gear.z - left[1][:0:-1]]
        if tooth in rolls:
            where[tooth] = ((count + right[2])[::-1], count + right[3])
        count += (right[0].size + left[0].size) // 2
    return np.concatenate(radii), np.concatenate(angles), where


def _no_tooth(gear, size):
    arc = math.pi / gear.z * _even(math.pi / gear.z * gear.r_f, size, 1)[:-1]
    return np.full(arc.size, gear.r_f), arc, None, None


def _fill(rim, held, *, ring):
    """Triangulate between the two closed vertex loops; vertices keep their order: rim, held, inside."""
    with gmsh_session() as gmsh:
        geo = gmsh.model.geo
        loops, tag = [], 0
        for points in (rim, held):
            tags = [geo.addPoint(x, y, 0.0) for x, y in points.T]
            lines = [geo.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1], strict=True)]
            loops.append(geo.addCurveLoop(lines))
            tag = lines[-1]
        surface = geo.addPlaneSurface(loops[::-1] if ring else loops)  # the outer loop first
        geo.synchronize()
        for line in range(1, tag + 1):
            gmsh.model.mesh.setTransfiniteCurve(line, 2)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.model.mesh.generate(2)
        tags, coords, _ = gmsh.model.mesh.getNodes()
        triangles = gmsh.model.mesh.getElementsByType(2, surface)[1].reshape(-1, 3)
    place = np.empty(int(tags.max()) + 1, dtype=np.int64)
    place[tags] = np.arange(tags.size)
    order = np.argsort(tags)
    place[tags[order]] = np.arange(tags.size)
    points = coords.reshape(-1, 3)[order, :2].T
    return MeshTri(np.ascontiguousarray(points), np.ascontiguousarray(place[triangles].T))


def _curve(linear, loops):
    """Second-order mesh with every boundary edge bent onto its curve, boundaries named."""
    mesh = MeshTri2.from_mesh(linear)
    nodes = mesh.doflocs.copy()
    facets = {
        tuple(pair): i
        for i, pair in zip(linear.boundary_facets(), np.sort(linear.facets[:, linear.boundary_facets()].T), strict=True)
    }
    names, first = {}, 0
    for name, points in zip(("rim", "held"), loops, strict=True):
        count = points.shape[1] // 2
        ring = first + np.arange(count)
        edges = np.array([facets[min(a, b), max(a, b)] for a, b in zip(ring, np.roll(ring, -1), strict=True)])
        nodes[:, linear.nvertices + edges] = points[:, 1::2]
        names[name] = edges
        first += count
    return replace(mesh, doflocs=nodes).with_boundaries(names)
