"""Loads, stiffness and motions of a planetary set over its positions, from one contact problem over all meshes."""

import time
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.checks import checked_refine, numbers, truth, whole
from ..core.steps import steps
from ..flexibility.solved import solved_gears
from ..stiffness.limits import FURTHEST
from .assembly import Bodies, Position, Set
from .case import PlanetaryCase
from .cracked import cracked, cracks_of
from .curves import SetCurves
from .meshes import Meshes, near_load
from .rim import ring_on
from .standing import standing
from .whole_gear import PLACES, between_teeth, whole_gear

PASSES = 4  # at most, until the loads for which corners and kinks are resolved are those of the meshes


def planetary_stiffness(
    case: PlanetaryCase,
    positions: "int | ArrayLike" = 32,
    *,
    cycles: int = 1,
    coupled: bool = True,
    refine: float = 1.0,
    cache: Any = True,
) -> SetCurves:
    """Load and stiffness of every mesh of a planetary set, loads of its teeth, transmission error, and how the ring bends.

    One contact problem at each position: each gear's flexibility over all its teeth, planets on both flanks, the ring on what
    holds it, and in every mesh the contact that `mesh_stiffness` has for its pair alone, tip corners included.

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
    both gears (`gearfe.geometry.pair.contacts`). What is left out of cracks: see `PlanetaryCase`.
    """
    started = time.perf_counter()
    if not isinstance(case, PlanetaryCase):
        raise ValueError(f"case = {case!r}, but give a PlanetaryCase: what holds the set, and its load")
    at, coupled, refine = _positions(positions, cycles), truth("coupled", coupled), checked_refine(refine)
    stand = standing(case.gears, np.array(case.angles), at)
    kept = solved_gears(cache)
    bodies = bodies_of(case, refine=refine, cache=kept)
    solved = time.perf_counter() - started
    meshes = Meshes(case, stand, refine, kept)
    of = Set(case, bodies, stand, coupled)
    solutions = [_position(of, meshes, i) for i in steps(range(at.size))]
    seconds = {"seconds_flexibility": solved, "seconds_contact": time.perf_counter() - started - solved}
    return SetCurves.of(of, meshes, at, solutions, seconds)


def _positions(positions, cycles):
    """Turns of the sun [pitches] ``(p,)`` as `planetary_stiffness` is given them."""
    at = numbers("positions", positions, " [pitches of the sun]")
    if not at.ndim:
        count = whole("positions", positions, 1)
        return np.arange(count * whole("cycles", cycles, 1)) / count
    if at.ndim != 1 or not at.size or not np.isfinite(at).all() or np.abs(at).max() > FURTHEST:
        raise ValueError(f"positions = {positions!r}, but give a row of numbers within {FURTHEST:g} pitches, one at least")
    return at


def _position(of: Set, meshes: Meshes, i: int) -> Position:
    """One position: pressures at corners and kinks are resolved for the nominal load, then for the one that each mesh has."""
    nominal = of.case.force / of.case.width
    loads = np.full((2, of.case.planets), nominal)
    for _ in range(PASSES):
        position = of.solved(i, meshes.at(i, loads))
        new = np.array([[near_load(load, nominal) for load in row] for row in position.loads])
        if (new == loads).all():
            break
        loads = new
    return position


def bodies_of(case: PlanetaryCase, *, refine: float = 1.0, cache: Any = True) -> Bodies:
    """`Bodies` of a case."""
    gears, kept = (case.gears.sun, case.gears.planet, case.ring_gear), solved_gears(cache)
    sun, planet, ring = (whole_gear(gear, m, refine=refine, cache=cache) for gear, m in zip(gears, case.material, strict=True))
    cracked_gears = {}
    for name, cracks in case.damage.items():
        if cracks:
            of = {"sun": sun, "ring": ring}.get(name, planet), tuple(cracks), refine
            cracked_gears[name] = kept.get(("cracks", of[0].gear, of[0].material, *of[1:]), partial(cracks_of, *of))
    key = ring.gear, case.material[2], case.ring, case.width, refine, case.damage.get("ring")
    rim = kept.get(("rim", *key), lambda: ring_on(ring, case.ring, case.width, cracked_gears.get("ring")))
    planets = {name[1]: _held(gear)[..., PLACES:] for name, gear in cracked_gears.items() if name not in ("sun", "ring")}
    across = planet.held()[:, :PLACES, PLACES:]
    return Bodies(_alike(sun, cracked_gears.get("sun")), across, _alike(ring, cracked_gears.get("ring")), rim, planets)


def _alike(whole, cracks):
    """Flexibility ``(z, PLACES, z, PLACES)`` between the right flanks of a gear, its edge held."""
    return between_teeth(whole.held()) if cracks is None else _held(cracks)[..., :PLACES].copy()


def _held(cracks):
    """That of its right flanks by loads on both."""
    return cracked(cracks, cracks.whole.held_inverse()).table[:, :PLACES]
