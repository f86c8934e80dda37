"""Sector of a gear in tets. Pits of one tooth are cut out as holes, and a crack is a seam of zero width.

The sector is drawn and cut in the frame of the helix, where a tooth is a prism and its traces are straight. The finished nodes
are then rotated by ``w z``, which keeps volumes. A pit is an elliptic cylinder pushed along the flank's normal at its centre,
with a bottom `depth` below the flank there (`gearfe.Pit`). The cut volume is compared with an integral that is independent of the
boundary representation, so that no wrong cut goes unnoticed.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..checks import is_whole
from ..damage.crack import meshed_path
from ..damage.hollow import centre_arc, check_hollows
from ..damage.hollow_volume import removed_volume
from ..damage.kinds import check_crack
from ..tooth.gear import Gear
from ..tooth.profile import arc_at, cartesian, fillet_length, flank, root_curve, turned
from .holed_drawing import fine, numbers_of, on_outline, section, tool
from .tetrahedra import UnmeshedError, tetrahedra

# Edge lengths in modules: largest, damaged tooth, its loaded flank, its fillets, crack. At the rims of pits the edge length is
# relative to the smallest half axis.
SIZES = {"far": 1.6, "tooth": 0.5, "flank": 0.5, "fillet": 0.35, "tip": 0.12, "rim": 0.4}
CUT = 2e-3  # largest relative error of the removed volume; quadrature and splines contribute less than 1e-3
FINER = (1.0, 1.07, 1.15, 1.3, 1.5)  # refinement factors tried in order, because flat tetrahedra and thin walls can fold
MESHED = 0.12  # largest relative error of the removed volume in the mesh, whose pit rim is a polygon


@dataclass(frozen=True, slots=True)
class Holed:
    """A sector of a gear with tooth 0 in its middle.

    Attributes
    ----------
    points : ndarray, shape (3, n)
        Vertices [mm].
    cells : ndarray, shape (4, m)
        Straight-sided tets, also those inside of the pits.
    plug : ndarray, shape (m,)
        The pit a tet is in, -1 outside of all: the gear with holes is ``cells[:, plug < 0]``.
    faces : dict of str to ndarray, shape (3, k)
        Triangles by name: ``held`` (bore or outside of a ring), ``sides`` (where the sector was cut off), ``end 0``, ``end b``,
        ``flank -1``, ``flank 0``, ... (loaded, without the pits), ``fillets 0`` (both of tooth 0), ``outline`` (of all teeth,
        with these), ``pits`` (walls and bottoms), ``crack body``, ``crack tooth`` (facing each other).
    removed : (float, float, float)
        Volume of the pits [mm**3]: by the integral, cut, in the mesh.
    """

    gear: Gear
    points: np.ndarray
    cells: np.ndarray
    plug: np.ndarray
    faces: dict
    removed: tuple


def _check_teeth(gear, teeth):
    if teeth is None:
        return
    if not is_whole(teeth):
        raise ValueError(f"teeth = {teeth!r}, but give an odd whole number of teeth, or None for all")
    if teeth < 1 or teeth % 2 == 0 or teeth > gear.z // 2:
        raise ValueError(f"teeth = {teeth}: give an odd number of at most half the teeth of z = {gear.z}")


def holed_sector(gear, pits=(), crack=None, *, broken=(), teeth=3, refine=1.0, sizes=None, strips=(), stretch=1.0):
    """Mesh a sector of `gear`, or all of it, with pits as holes.

    Parameters
    ----------
    gear : Gear
        Gear with signed helix angle: at height z the section is rotated clockwise by ``tan(beta) / r z``.
    pits : sequence of Pit
        Pits of one tooth, which becomes tooth 0 of the sector. They may overlap and cross the tip edge and the end faces.
    crack : Crack, optional
        Crack of the same tooth, through the whole width.
    broken : sequence of (MissingTooth or Chip)
        Broken teeth, numbered from tooth 0 of the sector.
    teeth : int or None
        Odd number of teeth in the sector; None: the whole gear.
    refine : float
        Divides all edge lengths, not those of `strips`.
    sizes : dict, optional
        Edge lengths instead of those of `SIZES`.
    strips : sequence of (ndarray (3, n), float, float)
        Lines of points [mm] in the frame of the helix, the distance within which the mesh is finer, the edge length there [mm].
    stretch : float
        Ratio of tet sizes along and across the width.

    Returns
    -------
    Holed

    Raises
    ------
    ValueError
        If a pit or the crack is impossible, or a pit reaches below the form circle.
    RuntimeError
        If the cut volume is not that of the pits, or gmsh cannot mesh the rest.
    """
    _check_teeth(gear, teeth)
    if not (math.isfinite(refine) and refine > 0):
        raise ValueError(f"refine = {refine}, but it divides the edge lengths: give refine > 0")
    if crack is not None:
        check_crack(crack)
    pits = tuple(dict.fromkeys(pits))
    check_hollows(gear, pits)
    _check_place(gear, pits, crack)
    size = {name: value * gear.m_n / refine for name, value in (SIZES | (sizes or {})).items()}
    for finer in FINER:
        finer_sizes = {name: value / finer for name, value in size.items()}
        try:
            made = _attempt(gear, pits, crack, section(gear, crack, teeth, broken), teeth, finer_sizes, strips, stretch)
        except UnmeshedError:  # Pits that touch leave thin walls, which a finer mesh may resolve.
            if finer == FINER[-1]:
                raise
        else:
            if _sizes_of(made.points, made.cells).min() > 0:
                return made
    raise RuntimeError(f"the helix of z = {gear.z} inverts tetrahedra of this mesh: raise refine")


def filled(sector, *, teeth=3):
    """Return the same mesh with filled pits, for a comparison without discretisation effects.

    The flanks are complete and no tet is in a pit. The faces ``pits`` are the parts of the flank above the pits.
    `holed_sector` describes `teeth`.
    """
    plug = np.full_like(sector.plug, -1)
    flat = turned(sector.points, -sector.gear.twist_rate * sector.points[2])
    faces = _named(sector.gear, flat, sector.cells, plug, teeth)
    bare = {tuple(face) for face in skin(sector.cells[:, sector.plug < 0]).T.tolist()}
    whole = skin(sector.cells)
    faces["pits"] = whole[:, [tuple(face) not in bare for face in whole.T.tolist()]]
    return replace(sector, plug=plug, faces=faces | {name: sector.faces[name] for name in sector.faces if "crack" in name})


def _attempt(gear, pits, crack, drawn, teeth, size, strips, stretch):
    rim = min((min(pit.axes) for pit in pits), default=1.0) * size["rim"] / gear.m_n
    squeeze = np.array([[1.0], [1.0], [1 / stretch]])
    made = tetrahedra(
        drawn, gear.b / stretch, [tool(gear, pit, squeeze) for pit in pits],
        fine=fine(gear, crack, size, teeth), rim=rim, far=size["far"], strips=[(squeeze * line, *rest) for line, *rest in strips],
    )  # fmt: skip
    made = replace(made, points=made.points / squeeze, volume={piece: stretch * v for piece, v in made.volume.items()})
    meshed = float(_sizes_of(made.points, made.tets)[made.plug >= 0].sum())
    cut = float(sum(v for (_, plug), v in made.volume.items() if plug >= 0))
    volumes = float(removed_volume(gear, pits)), cut, meshed
    _check_volume(gear, pits, volumes, made)
    nodes, cells, seam = _opened(gear, crack, made)
    flat = np.hstack([made.points, made.points[:, nodes]])
    named = _named(gear, flat, cells, made.plug, teeth) | seam
    return Holed(gear, turned(flat, gear.twist_rate * flat[2]), cells, made.plug, named, volumes)


def _check_place(gear, pits, crack):
    places = {defect.tooth % gear.z for defect in (*pits, *([] if crack is None else [crack]))}
    if len(places) > 1:
        raise ValueError(
            f"damage on teeth {sorted(places)}, but holes can be cut into one tooth only: give the damage of one tooth"
        )
    for pit in pits:
        least = centre_arc(gear, pit) - pit.reach[0]
        if least < arc_at(gear, gear.roll_f):
            raise ValueError(
                f"{pit._nouns[0]} at radius = {pit.radius:.6g} mm reaches {arc_at(gear, gear.roll_f) - least:.3g} mm below the "
                f"form circle ({gear.r_form:.6g} mm): holes must be on the involute; move it towards the tip or make it smaller"
            )


def _sizes_of(points, cells):
    """Volumes ``(m,)`` of tets [mm**3]."""
    a, b, c, d = points[:, cells].transpose(1, 0, 2)
    return np.einsum("im,im->m", np.cross(b - a, c - a, axis=0), d - a) / 6


def _check_volume(gear, pits, volumes, made):
    """Raise RuntimeError if the volume of the body or of the pits differs from the drawn volume."""
    want, cut, meshed = volumes
    missing = [k for k in range(len(pits)) if not (made.plug == k).any()]
    if not (abs(cut - want) <= CUT * want and abs(meshed - cut) <= MESHED * cut):  # also rejects nan
        raise RuntimeError(
            f"the holes should take {want:.6g} mm**3 from the tooth of z = {gear.z}, but {cut:.6g} mm**3 were cut and "
            f"{meshed:.6g} mm**3 meshed"
            + (f"; nothing of hole {missing[0]}" if missing else "")
            + ": a boolean operation failed or "
            "the mesh is too coarse; change refine, or move the holes by a little"
        )


def _opened(gear, crack, made):
    """Return nodes to be doubled, cells with the new nodes on the tooth side, and the faces of the crack."""
    if crack is None:
        return np.zeros(0, dtype=int), made.tets, {}
    body, tooth = (_triangles(made.tets[:, made.face == k]) for k in (0, 1))
    walls = np.array(sorted(set(map(tuple, body.T.tolist())) & set(map(tuple, tooth.T.tolist())))).T
    path = meshed_path(gear, crack)
    away = _distance(made.points[:2], path)
    on = (away[walls] < 1e-6 * gear.m_n).all(axis=0)
    if not on.any():
        raise RuntimeError("the mesh does not contain the crack: change refine")
    free = np.setdiff1d(walls[:, on], walls[:, ~on])
    free = free[np.hypot(*(made.points[:2, free] - path[:, -1:])) > 1e-6 * gear.m_n]
    double = np.arange(made.points.shape[1])
    double[free] = made.points.shape[1] + np.arange(free.size)
    cells = made.tets.copy()
    cells[:, made.face == 1] = double[cells[:, made.face == 1]]
    return free, cells, {"crack body": walls[:, on], "crack tooth": double[walls[:, on]]}


def _distance(points, path):
    """Distance ``(n,)`` of points from a polyline."""
    out = np.full(points.shape[1], np.inf)
    for a, b in zip(path.T[:-1], path.T[1:], strict=True):
        t = np.clip((b - a) @ (points - a[:, None]) / ((b - a) @ (b - a)), 0, 1)
        out = np.minimum(out, np.hypot(*(points - a[:, None] - np.outer(b - a, t))))
    return out


def _triangles(cells):
    """Return all faces of tets ``(3, 4 m)``, with ascending node numbers."""
    return np.sort(np.hstack([cells[[1, 2, 3]], cells[[0, 2, 3]], cells[[0, 1, 3]], cells[[0, 1, 2]]]), axis=0)


def skin(cells):
    """Triangles ``(3, k)`` that belong to one tet only."""
    faces, count = np.unique(_triangles(cells), axis=1, return_counts=True)
    return faces[:, count == 1]


def _named(gear, points, cells, plug, teeth):
    """Return surface triangles of the gear with holes by surface name, from the points before the helical rotation."""
    outer, whole = skin(cells[:, plug < 0]), skin(cells)
    key = {tuple(face) for face in whole.T.tolist()}
    kept = np.array([tuple(face) in key for face in outer.T.tolist()])
    x, y, z = points
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    near = 1e-4 * gear.m_n
    roll = np.sqrt(np.maximum(radius**2 - gear.r_b**2, 0.0))
    on = {"end 0": np.abs(z) < near, "end b": np.abs(z - gear.b) < near, "held": np.abs(radius - gear.held) < near}
    if teeth is not None:
        on["sides"] = np.abs(np.abs(angle) - teeth * math.pi / gear.z) * radius < near
    curve = root_curve(gear, np.linspace(0.0, fillet_length(gear), 400))
    order = np.argsort(curve[0])
    off = np.abs(angle) - np.interp(radius, curve[0][order], curve[1][order])
    on["fillets 0"] = (np.abs(off) * radius < 10 * near) & (gear.outward * (gear.r_form - radius) > -near)
    low, high = gear.flank_rolls
    for tooth in numbers_of(gear, teeth):
        off = (angle - 2 * math.pi * tooth / gear.z - flank(gear, roll)[1] + math.pi) % (2 * math.pi) - math.pi
        on[f"flank {tooth}"] = (np.abs(off) * radius < near) & (roll > low - near) & (roll < high + near)
    near_to = np.array(on_outline(gear, radius, angle))
    on["outline"] = np.hypot(*(cartesian(radius, angle) - cartesian(*near_to))) < 10 * near
    uncut = outer[:, kept]
    faces = {name: uncut[:, mask[uncut].all(axis=0)] for name, mask in on.items()}
    ends = np.isin(uncut, faces["held"]).all(axis=0) | (on["end 0"] | on["end b"])[uncut].all(axis=0)
    faces["outline"] = uncut[:, on["outline"][uncut].all(axis=0) & ~ends]
    return faces | {"pits": outer[:, ~kept]}
