"""Compliance that a planetary set adds to the meshes of isolated pairs."""

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..geometry.aliases import Floats
from ..scene.load import Scene
from ..stiffness.deviating_teeth import common_profile
from ..stiffness.disk import stored_arrays
from .of_scene import build_set, unlike_set
from .rim_supports import RimSupports

POSITIONS = 32  # number of positions per mesh cycle


class AddedCompliance(NamedTuple):
    """Additional compliance 1/k of the meshes of a healthy planetary set relative to isolated pairs, by kind of mesh.

    Attributes
    ----------
    position : ndarray, shape (p,)
        Rotation of the sun in its pitches, over one mesh cycle.
    added : ndarray, shape (2, p, planets)
        Additional compliance of each mesh [m/N].
    pairs : (str, str)
        Names of the pairs of the scene: sun and planet, planet and ring.
    """

    position: Floats
    added: Floats
    pairs: tuple[str, str]

    def at(self, kind: int, planet: int, position: Floats) -> Floats:
        """Return the added compliance of a mesh at positions [m/N]."""
        return np.interp(position, self.position, self.added[kind, :, planet], period=1.0)


def added_compliance(scene: Scene, force: float | None = None) -> AddedCompliance | None:
    """Compute the `AddedCompliance` of a scene under a `force` of a sun mesh [N] (default: that of the scene).

    The result is None in four cases: the scene has no set, the set does not model its pairs (`unlike_set`), the set does not
    repeat with the mesh cycle (its ring is on pads), or a mesh carries no load. Damage and deviations of single teeth are left
    out.
    """
    if scene.set is None or unlike_set(scene, scene.set):
        return None
    case = build_set(scene)
    case = case.with_(flanks={name: common_profile(flank, case.gear_of(name)) for name, flank in case.flanks.items()})
    if cycles_of(case) > 1:
        return None
    case = case if force is None else case.with_(force=force)
    position, added = stored_arrays("added compliance", case, partial(_added, case))
    return AddedCompliance(position, added, scene.set.pairs) if added.size else None


def _added(case: Any) -> tuple[Floats, Floats]:
    """Return positions and added compliance [m/N] of a `PlanetaryCase`. Both are empty if a mesh carries no load."""
    from .solve import planetary_stiffness  # imported here, because it takes 0.1 s

    found = planetary_stiffness(case, POSITIONS, error=False)
    return found.position, 1 / found.k - 1 / found.k_alone if (found.k > 0).all() else np.zeros(0)


def cycles_of(case: Any) -> int:
    """Return the number of mesh cycles after which a `PlanetaryCase` repeats for each planet."""
    faulty = [name for name, flank in case.flanks.items() if flank.on(case.gear_of(name)).differs]
    faulty += [name for name, found in case.damage.items() if found]
    z = case.ring_gear.z
    on_pads = z // math.gcd(z, case.ring.count) if isinstance(case.ring, RimSupports) else 1
    return math.lcm(on_pads, *(case.gear_of(name).z for name in faulty))
