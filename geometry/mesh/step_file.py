"""A gear as a solid in a STEP file by gmsh's OpenCASCADE kernel, with splines along flanks and fillets and arcs elsewhere."""

import contextlib
import math
import os
import sys
from collections.abc import Iterator

import numpy as np

from ..aliases import StrPath
from ..tooth.gear import Gear
from ..tooth.profile import cartesian, fillet_length, flank, root_curve, root_half_angle
from .mesher import gmsh_session

POINTS = 24  # points per spline
TURN = math.radians(2.0)  # rotation between two sections of a helical solid [rad]


def write_step(path: StrPath, gear: Gear) -> float:
    """Write a spur or helical gear as a solid [mm].

    The axis is z, tooth 0 points along y at z = 0. Returns its volume [mm^3].

    ValueError if the path does not end in ``.step`` or ``.stp``, or gmsh cannot write it.
    """
    if not str(path).lower().endswith((".step", ".stp")):
        raise ValueError(f"{path}: a solid is written as .step or .stp")
    sections = max(3, math.ceil(abs(gear.twist_rate) * gear.b / TURN)) if gear.beta else 1
    with gmsh_session() as gmsh:
        occ = gmsh.model.occ
        body = _solid(occ, gear, np.linspace(0.0, gear.b, sections + 1))
        occ.synchronize()
        volume = float(occ.getMass(3, body))
        try:
            with _quiet():
                gmsh.write(str(path))
        except Exception as error:  # gmsh raises only `Exception`.
            raise ValueError(f"cannot write {path}: {error}") from error
    return volume


@contextlib.contextmanager
def _quiet():
    """Context that suppresses the statistics that OpenCASCADE prints for a STEP file."""
    sys.stdout.flush()
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)


def _solid(occ, gear, heights):
    """Return the solid through sections at these heights [mm], with its held edge cut out."""
    teeth = occ.addThruSections([_wire(occ, gear, z) for z in heights], makeSolid=True, makeRuled=False)[0]
    cylinder = (3, occ.addCylinder(0, 0, 0, 0, 0, gear.b, gear.held))
    outer, inner = (cylinder, teeth) if gear.internal else (teeth, cylinder)
    return occ.cut([outer], [inner])[0][0][1]


def _wire(occ, gear, z):
    """Return the closed curve of all teeth at a height z [mm]."""
    pieces = list(_pieces(gear, gear.twist_rate * z))
    first = [occ.addPoint(*points[0], z) for points, _ in pieces]
    centre = occ.addPoint(0, 0, z)
    curves = []
    for i, (points, arc) in enumerate(pieces):
        ends = first[i], first[(i + 1) % len(pieces)]
        if arc:
            curves.append(occ.addCircleArc(ends[0], centre, ends[1]))
        else:
            curves.append(occ.addSpline([ends[0], *(occ.addPoint(*point, z) for point in points[1:-1]), ends[1]]))
    return occ.addCurveLoop(curves)


def _pieces(gear: Gear, turn: float) -> Iterator[tuple[np.ndarray, bool]]:
    """Return points ``(n, 2)`` of the outline pieces, clockwise, and whether each piece is an arc about the axis."""
    fillet = root_curve(gear, np.linspace(0.0, fillet_length(gear), POINTS))
    rise = flank(gear, np.linspace(gear.roll_f, gear.roll_a, POINTS))
    tip, root = float(rise[1][-1]), root_half_angle(gear)
    pitch = 2 * math.pi / gear.z
    for tooth in range(gear.z):
        at = turn + tooth * pitch
        yield _at(gear.r_a, [at - tip, at + tip]), True
        yield _at(rise[0][::-1], at + rise[1][::-1]), False
        yield _at(fillet[0][::-1], at + fillet[1][::-1]), False
        if pitch - 2 * root > 1e-9:
            yield _at(gear.r_f, [at + root, at + pitch - root]), True
        yield _at(fillet[0], at + pitch - fillet[1]), False
        yield _at(rise[0], at + pitch - rise[1]), False


def _at(radius, angle):
    x, y = cartesian(np.broadcast_to(radius, np.shape(angle)), np.asarray(angle))
    return np.column_stack([x, y])
