"""Loads, stiffness and motions of a planetary set over its positions. One contact problem contains all meshes."""

import time
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.checks import checked_refine, numbers, truth, whole
from ..core.steps import steps
from ..core.supports.held import REFUSE
from ..flexibility.solved import solved_gears
from ..stiffness.limits import FURTHEST
from .assembly import BodyTables, Position, Set
from .case import PlanetaryCase
from .cost import check_positions, check_refine
from .cracked import cracked_teeth, faces_of
from .curves import SetCurves
from .meshes import Meshes, near_load
from .rim import ring_faces, ring_on
from .set_error import set_error
from .standing import standing
from .whole_gear import PLACES, between_teeth, whole_gear

CHECKED = 8  # number of positions at which the error is estimated
COARSER, ORDER = 0.7, 3  # coarser resolution relative to that of the curves, and its polynomial order
PASSES = 5  # limit of iterations until corners, kinks and near pairs agree with the mesh loads


def planetary_stiffness(
    case: PlanetaryCase,
    positions: "int | ArrayLike" = 32,
    *,
    cycles: int = 1,
    coupled: bool = True,
    refine: float = 1.0,
    error: bool = True,
    cache: Any = True,
) -> SetCurves:
    """Solve a planetary set: load and stiffness of every mesh, tooth loads, transmission error, ring deformation.

    Each position is one contact problem. It contains the flexibility of each gear between all its teeth, planets loaded on both
    flanks, and the ring on its support. The contact in each mesh is that of `mesh_stiffness`, tip corners included.

    Parameters
    ----------
    case : PlanetaryCase
    positions : int or sequence of float
        Number of positions in each mesh cycle; or the positions themselves: by how many of its pitches the sun is turned.
    cycles : int
        Number of mesh cycles, if `positions` is a number. On n pads or lugs the set repeats after ``z_r / n`` cycles if that is
        whole.
    coupled : bool
        With False meshes do not feel each other's loads, as if each gear were held between them.
    refine : float
        Divides the edge lengths.
    error : bool
        Whether to estimate the error by a coarser solve of some of the positions: ``meta["error"]``, see `set_error`.
    cache : bool or SolvedGears
        See `gearfe.flexibility.solved.solved_gears`.

    Returns
    -------
    SetCurves

    Raises
    ------
    ValueError
        If an argument is of the wrong kind or out of range.
    RuntimeError
        If no forces that only push hold the set, or none were found.

    Notes
    -----
    The load is the same all over the face width. Phases are those of the mean pose of each mesh: its turn under load is shared by
    both gears (`gearfe.geometry.pair.contacts`). The faces of all cracks belong to the same contact problem. They push each other
    apart where they touch, and slide without friction. The motion of contacts along flanks that cracks tilt is neglected. A mesh
    without load at a missing tooth has k = 0 there.
    """
    if not isinstance(case, PlanetaryCase):
        raise ValueError(f"case = {case!r}, but give a PlanetaryCase (set, supports and load)")
    at, refine, options = _positions(positions, cycles), checked_refine(refine), {"cache": solved_gears(cache)}
    coupled, error = truth("coupled", coupled), truth("error", error)
    check_refine(refine)
    found = _curves(case, at, coupled, options | {"refine": refine})
    _check_small(case, found)
    if error:
        some = np.unique(np.linspace(0, at.size - 1, CHECKED).round().astype(int))
        less = _curves(case, at[some], coupled, options | {"refine": COARSER * refine, "order": ORDER})
        found.meta["error"] = set_error(found, less, some)
    return found


def _check_small(case, found):
    """Raise ValueError if a mesh, a pin or the sun is displaced by more than `REFUSE` modules (no small displacements)."""
    closed = np.divide(found.force, found.k, out=np.zeros_like(found.k), where=found.k > 0) - found.rim
    ways = {
        "a mesh closes": 1e3 * closed.max(),
        "the sun moves": 1e3 * np.abs(found.orbit).max(),
        "a pin yields": found.force.max() / case.pin,
    }
    way, limit = max(ways, key=lambda name: ways[name]), REFUSE * case.gears.sun.m_n
    if ways[way] > limit:
        raise ValueError(
            f"force = {case.force:g} N, pin = {case.pin:g} N/mm: {way} by {ways[way]:.3g} mm, but more than {limit:g} mm "
            f"({100 * REFUSE:g} % of the module) exceeds small displacements: give a smaller force, or stiffer pins"
        )


def _curves(case, at, coupled, options):
    """Return `SetCurves` without error estimate. `gearfe.flexibility.energy.ritz.plane.flexibility` describes `options`."""
    started = time.perf_counter()
    stand = standing(case.gears, np.array(case.planet_angles), at)
    bodies = bodies_of(case if coupled else case.with_(ring="held"), refine=options["refine"], cache=options["cache"])
    solved = time.perf_counter() - started
    of, meshes = Set(case, bodies, stand, coupled), Meshes(case, stand, options)
    solutions = [_position(of, meshes, i) for i in steps(range(at.size))]
    seconds = {"seconds_flexibility": solved, "seconds_contact": time.perf_counter() - started - solved}
    pairs = Meshes(case, stand, options, alone=True) if case.damage else meshes
    return SetCurves.of(of, pairs, at, solutions, seconds)


def _positions(positions, cycles):
    """Return the rotations of the sun [pitches] ``(p,)`` from the arguments of `planetary_stiffness`."""
    at = numbers("positions", positions, " [pitches of the sun]")
    if not at.ndim:
        count, cycles = whole("positions", positions, 1), whole("cycles", cycles, 1)
        check_positions(count * cycles)
        return np.arange(count * cycles) / count
    if at.ndim != 1 or not at.size or not np.isfinite(at).all() or np.abs(at).max() > FURTHEST:
        raise ValueError(f"positions = {positions!r}, but give at least one number, each within {FURTHEST:g} pitches")
    return at


def _position(of: Set, meshes: Meshes, i: int) -> Position:
    """Solve one position, first with corner and kink pressures of the nominal load, then with those of each mesh's load.

    Further pairs that may touch under the deflection of the teeth are added. RuntimeError if this does not converge.
    """
    nominal, reach = of.case.force / of.case.width, np.zeros((2, of.case.planets))
    loads = np.full(reach.shape, nominal)
    for _ in range(PASSES):
        met = meshes.at(i, loads, reach)
        position = of.solved(i, met)
        new = np.array([[near_load(load, nominal) for load in row] for row in position.loads])
        approach = np.where(position.loads > 0, position.closing - position.rim, 0.0)
        short = approach > np.array([[one.contacts.reach for one in row] for row in met])
        if not short.any() and (new == loads).all():
            return position
        loads, reach = new, np.where(short, 2 * approach, reach)
    if short.any():
        raise RuntimeError("the deflection brings more and more tooth pairs into contact: give shorter cracks or a smaller load")
    return position


def bodies_of(case: PlanetaryCase, *, refine: float = 1.0, cache: Any = True) -> BodyTables:
    """Return the `BodyTables` of a case."""
    gears, kept = (case.gears.sun, case.gears.planet, case.ring_gear), solved_gears(cache)
    sun, planet, ring = (whole_gear(gear, m, refine=refine, cache=cache) for gear, m in zip(gears, case.material, strict=True))
    key = ring.gear, case.material[2], case.ring, case.width, refine
    rim = kept.get(("rim", *key), lambda: ring_on(ring, case.ring, case.width))
    faces = {}
    for name, damage in case.damage.items():
        whole = {"sun": sun, "ring": ring}.get(name, planet)
        of = whole, tuple(damage), refine
        teeth = kept.get(("cracks", whole.gear, whole.material, *of[1:]), partial(cracked_teeth, *of))
        if teeth:
            faces[name] = ring_faces(rim, case.ring, teeth) if name == "ring" else faces_of(whole, teeth, whole.held_inverse())
    across = planet.held()[:, :PLACES, PLACES:]
    return BodyTables(between_teeth(sun.held()), across, between_teeth(ring.held()), rim, faces)
