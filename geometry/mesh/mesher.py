"""Gmsh session, and meshes of triangles and quads between lines. Only this module and `geometry.mesh.tetrahedra` use gmsh.

gmsh has one model and one set of options for the whole process, so that threads mesh one after the other.
"""

import contextlib
import ctypes
import os
import signal
import sys
import threading

import numpy as np

# Coordinates are scaled to this maximum and rounded to these decimals before gmsh. Its tolerances are absolute, and its result
# for points on one circle depends on their last digits. Similar gears of different size thus get similar meshes.
SEEN, DECIMALS = 50.0, 8

NAMES = ("SIGILL", "SIGFPE", "SIGBUS", "SIGSEGV", "SIGPIPE", "SIGTERM", "SIGHUP")
TOUCHED = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]

_turn = threading.Lock()


@contextlib.contextmanager
def gmsh_session():
    """Open a gmsh session without output, and close it in any case. Other threads wait until then.

    RuntimeError if gmsh or one of its system libraries is missing (the message states the package), or if the program that uses
    gearfe has an open gmsh session.
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
            raise RuntimeError("this program has gmsh open, which allows one session only: call gmsh.finalize() before gearfe")
        with _handlers_kept():
            gmsh.initialize(readConfigFiles=False, interruptible=False)  # A user's options file would change the mesh.
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.NumThreads", 1)
            yield gmsh
        finally:
            with _handlers_kept():
                gmsh.finalize()


@contextlib.contextmanager
def _handlers_kept():
    """Restore the signal handlers of the process.

    gmsh loads PETSc, which resets some handlers to the system's default. A dead worker would then end the process that writes to
    it by SIGPIPE, and faults of other libraries would not be reported. A terminated program would leave its temporary files.
    Python's `signal` only works in the main thread.
    """
    if os.name != "posix":
        yield
        return
    sigaction = ctypes.CDLL(None).sigaction
    kept = {number: ctypes.create_string_buffer(256) for number in map(int, TOUCHED)}  # larger than any struct sigaction
    for number, old in kept.items():
        sigaction(number, None, old)
    try:
        yield
    finally:
        for number, old in kept.items():
            sigaction(number, old, None)


def _begin_anew():
    """Close the gmsh session in a forked child process, where the thread that used it does not exist."""
    global _turn
    if _turn.locked() and "gmsh" in sys.modules and sys.modules["gmsh"].isInitialized():
        sys.modules["gmsh"].finalize()
    _turn = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_anew)


def mesh_options(gmsh, **values):
    """Set options of meshing by their names in gmsh."""
    for name, value in values.items():
        gmsh.option.setNumber(f"Mesh.{name}", value)


def triangulate(loops, chains, ring, free=()):
    """Return vertices and triangles between closed vertex loops. Edges follow `chains`, and `free` points are vertices.

    Nodes keep their order: loops, chains, free points, then those that gmsh adds.
    """
    nodes = np.hstack([*loops, *(points for _, points in chains), np.reshape(free, (-1, 2)).T])
    unit = np.abs(nodes).max() / SEEN
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
        surface = geo.addPlaneSurface([*closed[1::-1], *closed[2:]] if ring else closed)  # gmsh requires the outer loop first.
        geo.synchronize()
        if alone:
            gmsh.model.mesh.embed(0, alone, 2, surface)
        if inner:
            gmsh.model.mesh.embed(1, inner, 2, surface)
        for line in [*range(1, last + 1), *inner]:
            gmsh.model.mesh.setTransfiniteCurve(line, 2)
        mesh_options(gmsh, Algorithm=6, MeshSizeExtendFromBoundary=1, MeshSizeFromPoints=0)
        gmsh.model.mesh.generate(2)
        tags, coords, _ = gmsh.model.mesh.getNodes()
        triangles = gmsh.model.mesh.getElementsByType(2, surface)[1].reshape(-1, 3)
    order = np.argsort(tags)
    place = np.empty(int(tags.max()) + 1, dtype=np.int64)
    place[tags[order]] = np.arange(tags.size)
    points = unit * coords.reshape(-1, 3)[order, :2].T
    points[:, : nodes.shape[1]] = nodes
    return points, place[triangles].T


def _places(mesh, tags, middles):
    """Return tags and coordinates of all nodes, and by tag the number of the given node (-1 for nodes added by gmsh)."""
    node_tags, coords, _ = mesh.getNodes()
    place = np.full(int(node_tags.max()) + 1, -1)
    for node, tag in tags.items():
        place[int(mesh.getNodes(0, tag)[0][0])] = node
    for curve, middle in middles:
        place[mesh.getNodes(1, curve)[0].astype(int)] = middle
    return node_tags.astype(int), coords, place


def quadrangulate(points, lines, surfaces, algorithm):
    """Mesh quads between given nodes. Lines keep their three nodes, and gmsh adds inner nodes.

    `algorithm` is that of gmsh's triangles before they are joined. Raises RuntimeError if triangles remain.

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
        loops = [[[int(np.sign(i)) * curves[abs(i) - 1] for i in loop] for loop in face] for face in surfaces]
        faces = [geo.addPlaneSurface(list(map(geo.addCurveLoop, face))) for face in loops]
        geo.synchronize()
        legs = np.hypot(*np.diff(seen[:, lines], axis=2))
        for curve, (first, second) in zip(curves, legs, strict=True):
            mesh.setTransfiniteCurve(curve, 3, "Progression", second / first)
        for face in faces:
            mesh.setRecombine(2, face)
        mesh_options(gmsh, Algorithm=algorithm, RecombinationAlgorithm=3, MeshSizeFromPoints=0)
        mesh.generate(2)
        node_tags, coords, place = _places(mesh, tags, zip(curves, lines[:, 1], strict=True))
        kinds = {int(kind) for face in faces for kind in mesh.getElements(2, face)[0]}
        cells = [mesh.getElementsByType(3, face)[1].astype(int).reshape(-1, 4) for face in faces]
    known = place[node_tags] >= 0
    if kinds != {3} or not np.array_equal(np.sort(place[node_tags[known]]), used):
        raise RuntimeError("gmsh did not fill the section with quads between the given nodes; change the resolution")
    place[node_tags[~known]] = points.shape[1] + np.arange((~known).sum())
    points = np.hstack([points, unit * coords.reshape(-1, 3)[~known, :2].T])
    return points, place[np.concatenate(cells)].T, np.repeat(np.arange(len(cells)), [len(c) for c in cells])
