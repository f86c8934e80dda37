"""Tets between surfaces by gmsh: extruded sections with holes that are kept as separate pieces."""

from dataclasses import dataclass

import numpy as np

from .mesher import gmsh_session, mesh_options

GROWTH = 0.5  # growth of the edge length with the distance from fine places


class UnmeshedError(RuntimeError):
    """Error if gmsh cannot mesh a solid in tets with these edge lengths. Other lengths may succeed."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """Tets of an extruded section, divided into pieces that share nodes.

    `points` (3, n) are in mm, and `tets` (4, m) are right-handed. `face` (m,) is the face of the section below each tet, and
    `plug` (m,) the cylinder that contains it, -1 outside of all. `volume` [mm**3] by (face, plug) is that of the boundary
    representation.
    """

    points: np.ndarray
    tets: np.ndarray
    face: np.ndarray
    plug: np.ndarray
    volume: dict


def tetrahedra(drawing, height, cylinders=(), *, fine=(), rim=None, far, strips=()):
    """Mesh an extruded section in tets. Cylinders are cut out and kept as separate pieces.

    Parameters
    ----------
    drawing : (ndarray, list, list)
        The section: points ``(2, n)`` [mm]; curves ``(kind, numbers of points)``, each a ``line`` or ``arc`` (about the origin)
        between two of them or a ``spline`` through all; and of each face its loops, the outer first, as numbers of curves. Faces
        may share curves.
    height : float
        Height of the extrusion [mm].
    cylinders : sequence of (list, ndarray)
        Outline, and the vector (3,) of its push [mm]: one ``ellipse``, by its centre and its half axes (3, 3); or a loop of
        ``line``, by its ends (3, 2), and ``arc``, a quarter of an ellipse, by its ends and its centre (3, 3). Parts outside the
        solid are dropped; in overlaps the first cylinder counts.
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
        If gmsh fails.
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
        prisms = [_prism(occ, face, (0, 0, height)) for face in flat]
        owner = _pieces(occ, prisms, [_cylinder(occ, *cylinder) for cylinder in cylinders])
        occ.remove([(0, centre)])
        occ.synchronize()
        volume = dict.fromkeys(owner.values(), 0.0)
        for tag, piece in owner.items():
            volume[piece] += occ.getMass(3, tag)
        inner = [(3, tag) for tag, (_, plug) in owner.items() if plug >= 0]
        _sizes(gmsh, inner, fine, rim, far, strips)
        try:
            mesh.generate(3)
        except Exception as error:  # gmsh raises only `Exception`.
            raise UnmeshedError(
                f"gmsh cannot mesh this solid: {error}; increase refine, or increase the distance of surfaces that nearly touch"
            ) from error
        points, cells = _cells(mesh, owner)
    tets = np.hstack(list(cells.values()))
    label = np.repeat([*cells], [part.shape[1] for part in cells.values()], axis=0)
    used, tets = np.unique(tets, return_inverse=True)
    return Pieces(points[:, used], tets.reshape(4, -1), *label.T, volume)


def _cells(mesh, owner):
    """Points ``(3, n)`` and the tets ``(4, m)`` by face and plug."""
    node_tags, coords, _ = mesh.getNodes()
    place = np.full(int(node_tags.max()) + 1, -1, dtype=np.int64)
    place[node_tags] = np.arange(node_tags.size)
    cells = {}
    for tag, piece in owner.items():
        cells.setdefault(piece, []).append(place[mesh.getElementsByType(4, tag)[1]].reshape(-1, 4).T)
    return coords.reshape(-1, 3).T, {piece: np.hstack(parts) for piece, parts in cells.items()}


def _pieces(occ, prisms, plugs):
    """Cut prisms by plugs into pieces. Return face and plug by piece number.

    Parts of plugs outside of all prisms are removed.
    """
    made = occ.fragment(prisms[:1], prisms[1:] + plugs)[1] if len(prisms) + len(plugs) > 1 else [prisms]
    owner = {tag: (face, -1) for face, solids in enumerate(made[: len(prisms)]) for _, tag in solids}
    cut = [(tag, plug) for plug, solids in reversed([*enumerate(made[len(prisms) :])]) for _, tag in solids]
    owner |= {tag: (owner[tag][0], plug) for tag, plug in cut if tag in owner}
    occ.remove([(3, tag) for tag in {tag for tag, _ in cut if tag not in owner}], recursive=True)
    return owner


def _prism(occ, face, push):
    """Return the volume swept by a face."""
    return next(entity for entity in occ.extrude([(2, face)], *push) if entity[0] == 3)


def _cylinder(occ, outline, push):
    """Return the volume swept by the area inside an outline."""
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
    return _prism(occ, face, push)


def _sizes(gmsh, inner, fine, rim, far, strips):
    """Set the edge lengths, which grow with the distance from circles of the section, strips, and edges of pieces."""
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
    mesh_options(gmsh, MeshSizeMax=far, MeshSizeFromPoints=0, MeshSizeExtendFromBoundary=0, Algorithm3D=1)


def _away(field, near, reach, size, far):
    """Return a field of edge lengths: `size` up to `reach` from the places of field `near`, growing to `far` beyond."""
    number = field.add("Threshold")
    for name, value in (("InField", near), ("SizeMin", size), ("SizeMax", far), ("DistMin", reach)):
        field.setNumber(number, name, value)
    field.setNumber(number, "DistMax", reach + (far - size) / GROWTH)
    return number
