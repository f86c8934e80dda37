"""gmsh: triangles and quads between lines, tets between surfaces; nowhere else is it imported.

gmsh has one model and one set of options for the whole process: threads that mesh at the same time take turns.
"""

import contextlib
import ctypes
import os
import signal
import sys
import threading
from dataclasses import dataclass

import numpy as np

# Largest coordinate that gmsh sees, and the decimals of coordinates: its tolerances are absolute, and what it does with points on
# one circle hangs on their last digits, so gears that differ in size alone have to look the same to it.
SEEN, DECIMALS = 50.0, 8

GROWTH = 0.5  # of the edge length of tets per length, away from fine places

TOUCHED = [getattr(signal, name) for name in ("SIGILL", "SIGFPE", "SIGBUS", "SIGSEGV", "SIGPIPE") if hasattr(signal, name)]

_turn = threading.Lock()


class UnmeshedError(RuntimeError):
    """Gmsh made no tets of a solid with these edge lengths; with others it may."""


@contextlib.contextmanager
def gmsh_session():
    """A quiet gmsh session that is closed whatever happens; that of another thread waits until then.

    RuntimeError if gmsh or one of the system libraries it loads is missing (the message says what to install), or if the
    program that uses gearfe has a session of its own open.
    """
    with _turn:
        try:
            import gmsh
        except (ImportError, OSError) as error:
            raise RuntimeError(
                f"gmsh cannot be loaded ({error}); install it with 'pip install gmsh' and, on Debian, 'apt-get install "
                "libglu1-mesa libgl1 libxcursor1 libxft2 libxinerama1 libxfixes3 libxrender1 libgomp1'"
            ) from error
        if gmsh.isInitialized():
            raise RuntimeError("this program has gmsh open, which has one session for all: call gmsh.finalize() before gearfe")
        with _handlers_kept():
            gmsh.initialize(readConfigFiles=False, interruptible=False)  # a user's own options would change the mesh
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.NumThreads", 1)
            yield gmsh
        finally:
            with _handlers_kept():
                gmsh.finalize()


@contextlib.contextmanager
def _handlers_kept():
    """What the process does on signals, put back.

    gmsh loads PETSc, which sets some to the system's default: then a worker that dies ends the process that writes to it, by
    SIGPIPE, and the faults of other libraries are no longer told. Python's own `signal` would serve the main thread alone.
    """
    if os.name != "posix":
        yield
        return
    sigaction = ctypes.CDLL(None).sigaction
    kept = {number: ctypes.create_string_buffer(256) for number in map(int, TOUCHED)}  # a struct sigaction is shorter
    for number, old in kept.items():
        sigaction(number, None, old)
    try:
        yield
    finally:
        for number, old in kept.items():
            sigaction(number, old, None)


def _begin_anew():
    """In the child of a process that was forked: the thread that was meshing is not in it, its session is."""
    global _turn
    if _turn.locked() and "gmsh" in sys.modules and sys.modules["gmsh"].isInitialized():
        sys.modules["gmsh"].finalize()
    _turn = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_anew)


def triangulate(loops, chains, ring, free=()):
    """Vertices and triangles between closed vertex loops, with the chains as edges and the free points ``(n, 2)`` as vertices.

    Nodes keep their order: loops, chains, free points, then those that gmsh adds.
    """
    given = np.hstack([*loops, *(points for _, points in chains), np.reshape(free, (-1, 2)).T])
    unit = np.abs(given).max() / SEEN
    loops, free = [np.round(points / unit, DECIMALS) for points in loops], np.round(np.asarray(free) / unit, DECIMALS)
    chains = [(start, np.round(points / unit, DECIMALS)) for start, points in chains]
    with gmsh_session() as gmsh:
        geo = gmsh.model.geo
        closed, last = [], 0
        for points in loops:
            tags = [geo.addPoint(x, y, 0.0) for x, y in points.T]
            lines = [geo.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1], strict=True)]
            closed.append(geo.addCurveLoop(lines))
            last = lines[-1]
        inner = []
        for start, points in chains:
            tags = [start + 1] + [geo.addPoint(x, y, 0.0) for x, y in points.T]
            inner += [geo.addLine(a, b) for a, b in zip(tags[:-1], tags[1:], strict=True)]
        alone = [geo.addPoint(x, y, 0.0) for x, y in free]
        surface = geo.addPlaneSurface(closed[::-1] if ring else closed)  # the outer loop first
        geo.synchronize()
        if alone:
            gmsh.model.mesh.embed(0, alone, 2, surface)
        if inner:
            gmsh.model.mesh.embed(1, inner, 2, surface)
        for line in [*range(1, last + 1), *inner]:
            gmsh.model.mesh.setTransfiniteCurve(line, 2)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.model.mesh.generate(2)
        tags, coords, _ = gmsh.model.mesh.getNodes()
        triangles = gmsh.model.mesh.getElementsByType(2, surface)[1].reshape(-1, 3)
    order = np.argsort(tags)
    place = np.empty(int(tags.max()) + 1, dtype=np.int64)
    place[tags[order]] = np.arange(tags.size)
    points = unit * coords.reshape(-1, 3)[order, :2].T
    points[:, : given.shape[1]] = given
    return points, place[triangles].T


def quadrangulate(points, lines, surfaces, algorithm):
    """Quads between given nodes: every line keeps its three, in between gmsh adds what it needs.

    `algorithm` is that of gmsh's triangles before they are joined. Raises RuntimeError if some are left.

    Parameters
    ----------
    points : ndarray, shape (2, n)
        Nodes of the lines [mm].
    lines : ndarray, shape (k, 3)
        Start, middle and end node of each line; the middle may lie a little off the chord.
    surfaces : list of list of list of int
        Loops of each surface, the outer first: numbers of lines from 1, negative backwards.

    Returns
    -------
    points, quads : ndarray, shape (2, n + added) and (4, m)
    label : ndarray, shape (m,)
        Surface of each quad.
    """
    used = np.unique(lines)
    unit = np.abs(points[:, used]).max() / SEEN
    seen = np.round(points / unit, DECIMALS)
    with gmsh_session() as gmsh:
        geo, mesh = gmsh.model.geo, gmsh.model.mesh
        tags = {int(n): geo.addPoint(*seen[:, n], 0.0) for n in np.unique(lines[:, ::2])}
        curves = [geo.addLine(tags[int(a)], tags[int(c)]) for a, _, c in lines]
        faces = [
            geo.addPlaneSurface([geo.addCurveLoop([int(np.sign(i)) * curves[abs(i) - 1] for i in loop]) for loop in loops])
            for loops in surfaces
        ]
        geo.synchronize()
        legs = np.hypot(*np.diff(seen[:, lines], axis=2))
        for curve, (first, second) in zip(curves, legs, strict=True):
            mesh.setTransfiniteCurve(curve, 3, "Progression", second / first)
        for face in faces:
            mesh.setRecombine(2, face)
        for name, value in (("Algorithm", algorithm), ("RecombinationAlgorithm", 3), ("MeshSizeFromPoints", 0)):
            gmsh.option.setNumber(f"Mesh.{name}", value)
        mesh.generate(2)
        found, coords, _ = mesh.getNodes()
        place = np.full(int(found.max()) + 1, -1)
        for node, tag in tags.items():
            place[int(mesh.getNodes(0, tag)[0][0])] = node
        for curve, middle in zip(curves, lines[:, 1], strict=True):
            place[mesh.getNodes(1, curve)[0].astype(int)] = middle
        kinds = {int(kind) for face in faces for kind in mesh.getElements(2, face)[0]}
        cells = [mesh.getElementsByType(3, face)[1].astype(int).reshape(-1, 4) for face in faces]
    found = found.astype(int)
    known = place[found] >= 0
    if kinds != {3} or not np.array_equal(np.sort(place[found[known]]), used):
        raise RuntimeError("gmsh did not fill the section with quads between the given nodes; change the resolution")
    place[found[~known]] = points.shape[1] + np.arange((~known).sum())
    points = np.hstack([points, unit * coords.reshape(-1, 3)[~known, :2].T])
    return points, place[np.concatenate(cells)].T, np.repeat(np.arange(len(cells)), [len(c) for c in cells])


@dataclass(frozen=True, slots=True)
class Pieces:
    """Tets of an extruded section, cut into pieces that share their nodes.

    `points` (3, n) [mm]; `tets` (4, m) right-handed; `face` (m,) the face of the section a tet stands on; `plug` (m,) the
    cylinder it is in, -1 outside of all; `volume` [mm**3] by (face, plug), that of the boundary representation.
    """

    points: np.ndarray
    tets: np.ndarray
    face: np.ndarray
    plug: np.ndarray
    volume: dict


def tetrahedra(drawing, height, cylinders=(), *, fine=(), rim=None, far, strips=()):
    """Tets of an extruded section, with cylinders cut out and kept as pieces of their own.

    Parameters
    ----------
    drawing : (ndarray, list, list)
        The section: points ``(2, n)`` [mm]; curves ``(kind, numbers of points)``, each a ``line`` or ``arc`` (about the origin)
        between two of them or a ``spline`` through all; and of each face its loops, the outer first, as numbers of curves. Faces
        may share curves.
    height : float
        [mm].
    cylinders : sequence of (list, ndarray)
        The outline, and by which vector (3,) it is pushed [mm]: one ``ellipse``, by its centre and its half axes (3, 3); or a
        loop of ``line``, by its ends (3, 2), and ``arc``, a quarter of an ellipse, by its ends and its centre (3, 3). What lies
        outside of the solid is dropped; where cylinders overlap the first one has it.
    fine : sequence of (float, float, float, float)
        Circles of the section: x, y, radius and the edge length within [mm].
    rim : float, optional
        Edge length on the cylinders' edges [mm].
    far : float
        Largest edge length [mm].
    strips : sequence of (ndarray (3, n), float, float)
        Points of lines [mm], the distance from them within which the mesh is finer, the edge length there [mm].

    Returns
    -------
    Pieces

    Raises
    ------
    UnmeshedError
        If gmsh cannot.
    """
    points, curves, faces = drawing
    with gmsh_session() as gmsh:
        occ, mesh = gmsh.model.occ, gmsh.model.mesh
        tags = [occ.addPoint(x, y, 0.0) for x, y in points.T]
        centre = occ.addPoint(0.0, 0.0, 0.0)
        make = {
            "line": lambda at: occ.addLine(*at),
            "arc": lambda at: occ.addCircleArc(at[0], centre, at[1]),
            "spline": lambda at: occ.addSpline(at),
        }
        lines = [make[kind]([tags[i] for i in at]) for kind, at in curves]
        flat = [occ.addPlaneSurface([occ.addCurveLoop([lines[i] for i in loop]) for loop in loops]) for loops in faces]
        prisms = [next(one for one in occ.extrude([(2, face)], 0, 0, height) if one[0] == 3) for face in flat]
        plugs = [_cylinder(occ, *cylinder) for cylinder in cylinders]
        if len(prisms) + len(plugs) > 1:
            _, made = occ.fragment(prisms[:1], prisms[1:] + plugs)
        else:
            made = [prisms]
        owner, outside = {}, set()
        for face, own in enumerate(made[: len(prisms)]):
            owner |= {tag: (face, -1) for _, tag in own}
        for plug, own in reversed([*enumerate(made[len(prisms) :])]):
            outside |= {tag for _, tag in own if tag not in owner}
            owner |= {tag: (owner[tag][0], plug) for _, tag in own if tag in owner}
        occ.remove([(3, tag) for tag in outside], recursive=True)
        occ.remove([(0, centre)])
        occ.synchronize()
        volume = {}
        for tag, piece in owner.items():
            volume[piece] = volume.get(piece, 0.0) + occ.getMass(3, tag)
        inner = [(3, tag) for tag, (_, plug) in owner.items() if plug >= 0]
        _sizes(gmsh, inner, fine, rim, far, strips)
        try:
            mesh.generate(3)
        except Exception as error:  # gmsh itself raises just Exception
            raise UnmeshedError(
                f"gmsh cannot mesh this solid: {error}; raise refine, or move what nearly touches apart"
            ) from error
        found, coords, _ = mesh.getNodes()
        place = np.full(int(found.max()) + 1, -1, dtype=np.int64)
        place[found] = np.arange(found.size)
        cells = {piece: [] for piece in volume}
        for tag, piece in owner.items():
            cells[piece].append(place[mesh.getElementsByType(4, tag)[1]].reshape(-1, 4))
    tets = np.concatenate([part for parts in cells.values() for part in parts])
    label = np.repeat([*cells], [sum(map(len, parts)) for parts in cells.values()], axis=0)
    used, tets = np.unique(tets, return_inverse=True)
    return Pieces(coords.reshape(-1, 3)[used].T, tets.reshape(-1, 4).T, *label.T, volume)


def _cylinder(occ, outline, push):
    """Volume swept by what an outline bounds."""
    kind, (first, *_) = outline[0][0], outline[0][1].T
    if kind == "ellipse":
        axes = outline[0][1][:, 1:]
        size = np.linalg.norm(axes, axis=0)
        axes, size = axes[:, np.argsort(-size)], np.sort(size)[::-1]
        normal = np.cross(axes[:, 0], axes[:, 1])
        face = occ.addDisk(*first, *size, zAxis=normal / np.linalg.norm(normal), xAxis=axes[:, 0] / size[0])
    else:
        tags, curves = [occ.addPoint(*first)], []
        for k, (kind, (start, end, *centre)) in enumerate((kind, points.T) for kind, points in outline):
            tags.append(tags[0] if k == len(outline) - 1 else occ.addPoint(*end))
            if kind == "line":
                curves.append(occ.addLine(*tags[-2:]))
                continue
            middle = occ.addPoint(*centre[0])
            longer = tags[-2] if np.linalg.norm(start - centre) >= np.linalg.norm(end - centre) else tags[-1]
            curves.append(occ.addEllipseArc(tags[-2], middle, longer, tags[-1]))
            occ.remove([(0, middle)])
        face = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    return next(one for one in occ.extrude([(2, face)], *push) if one[0] == 3)


def _sizes(gmsh, inner, fine, rim, far, strips):
    """Background field: edge lengths that grow away from circles of the section, from strips and from the edges of pieces."""
    field = gmsh.model.mesh.field
    numbers = []
    for x, y, radius, size in fine:
        numbers.append(field.add("MathEval"))
        away = f"sqrt((x-({x}))^2+(y-({y}))^2)-{radius}"
        field.setString(numbers[-1], "F", f"{size}+{GROWTH / 2}*(({away})+abs({away}))")
    if inner:
        edges = gmsh.model.getBoundary(
            gmsh.model.getBoundary(inner, combined=False, oriented=False), combined=False, oriented=False
        )
        near = field.add("Distance")
        field.setNumbers(near, "CurvesList", sorted({abs(tag) for dim, tag in edges if dim == 1}))
        field.setNumber(near, "Sampling", 40)
        numbers.append(_away(field, near, 0.0, rim, far))
    for line, reach, size in strips:
        tags = [gmsh.model.occ.addPoint(*place) for place in line.T.tolist()]
        gmsh.model.occ.synchronize()
        near = field.add("Distance")
        field.setNumbers(near, "PointsList", tags)
        numbers.append(_away(field, near, reach, size, far))
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", numbers)
    field.setAsBackgroundMesh(least)
    for name, value in (("MeshSizeMax", far), ("MeshSizeFromPoints", 0), ("MeshSizeExtendFromBoundary", 0)):
        gmsh.option.setNumber(f"Mesh.{name}", value)
    gmsh.option.setNumber("Mesh.Algorithm3D", 1)


def _away(field, near, reach, size, far):
    """Field of edge lengths: `size` up to `reach` from the places of field `near`, then growing to `far`."""
    number = field.add("Threshold")
    for name, value in (("InField", near), ("SizeMin", size), ("SizeMax", far), ("DistMin", reach)):
        field.setNumber(number, name, value)
    field.setNumber(number, "DistMax", reach + (far - size) / GROWTH)
    return number
