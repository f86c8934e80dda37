"""Loads, stiffness and motions of a planetary set over its positions, from one contact problem over all meshes."""

import time
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..flexibility.solved import solved_gears
from ..steps import steps
from .assembly import Bodies, Position, Set
from .case import PlanetaryCase
from .curves import SetCurves
from .meshes import Meshes, near_load
from .rim import ring_on
from .standing import standing
from .whole_gear import PLACES, between_teeth, whole_gear

PASSES = 4  # at most, until the loads that the rows of hats are made for are those of the meshes


def planetary_stiffness(
    case: PlanetaryCase,
    positions: "int | ArrayLike" = 32,
    *,
    cycles: int = 1,
    coupled: bool = True,
    refine: float = 1.0,
    cache: Any = True,
) -> SetCurves:
    """Loads of every mesh and tooth of a planetary set, its stiffness, transmission error and bending ring.

    One contact problem at each position: each gear's flexibility over all its teeth, planets on both flanks, the ring on what
    holds it, and in every mesh the contact of its pair with Hertz's logarithm, corners and kinks.

    Parameters
    ----------
    case : PlanetaryCase
    positions : int or sequence of float
        So many in each mesh cycle; or by how many of its pitches the sun is turned.
    cycles : int
        Mesh cycles, if positions are a number. A ring on n supports repeats after ``z_r / n`` cycles.
    coupled : bool
        With False every mesh is alone, as isolated pairs are: gears are held between meshes.
    refine : float
        Divides the edge lengths.
    cache : bool or SolvedGears
        See `gearfe.flexibility.solved.solved_gears`.

    Returns
    -------
    SetCurves

    Notes
    -----
    Mesh phases are those of the mean pose of each mesh (`geometry.pair.contacts`). Crossed terms of a crack are left out. Loads
    are per width in plane strain, alike over the width.

    Raises
    ------
    RuntimeError
        If no forces that only push hold the set.
    """
    started = time.perf_counter()
    if isinstance(positions, int):
        if positions < 1 or cycles < 1:
            raise ValueError(f"positions = {positions}, cycles = {cycles}, but both count from 1")
        at = np.arange(positions * cycles) / positions
    else:
        at = np.atleast_1d(np.asarray(positions, dtype=float))
        if at.ndim != 1 or not at.size or not np.isfinite(at).all():
            raise ValueError("positions must be a number or a list of finite numbers")
    stand = standing(case.gears, np.array(case.angles), at)
    kept = solved_gears(cache)
    bodies = bodies_of(case, refine=refine, cache=kept)
    solved = time.perf_counter() - started
    meshes = Meshes(case, stand, refine, kept)
    of = Set(case, bodies, stand, coupled)
    found = [_position(of, meshes, i) for i in steps(range(at.size))]
    seconds = {"seconds_flexibility": solved, "seconds_contact": time.perf_counter() - started - solved}
    return SetCurves.of(of, meshes, at, found, seconds)


def _position(of: Set, meshes: Meshes, i: int) -> Position:
    """One position: rows of hats are made for the nominal load, then for the one that each mesh has."""
    nominal = of.case.force / of.case.width
    loads = np.full((2, of.case.planets), nominal)
    for _ in range(PASSES):
        found = of.solved(i, meshes.at(i, loads))
        new = np.array([[near_load(one, nominal) for one in row] for row in found.loads])
        if (new == loads).all():
            break
        loads = new
    return found


def bodies_of(case: PlanetaryCase, *, refine: float = 1.0, cache: Any = True) -> Bodies:
    """`Bodies` of a case."""
    gears = case.gears.sun, case.gears.planet, case.ring_gear
    sun, planet, ring = (whole_gear(gear, m, refine=refine, cache=cache) for gear, m in zip(gears, case.material, strict=True))
    rim = solved_gears(cache).get(("rim", ring.gear, case.material[2], case.ring, case.width, refine),
                                  lambda: ring_on(ring, case.ring, case.width))  # fmt: skip
    both = planet.held()[:, :PLACES, PLACES:]
    return Bodies(between_teeth(sun.held()), both, between_teeth(ring.held()), rim)
