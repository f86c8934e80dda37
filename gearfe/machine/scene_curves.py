"""What the machines of scenes share: speed, stage, and stiffness curves of the pairs, healthy and damaged."""

import math

from geometry.damage.pit import Pit
from geometry.pair.planetary import PlanetarySet

from ..stiffness.solve import mesh_stiffness


def speed_of(scene):
    """Speed of the driving gear [rad/s]."""
    return scene.machine["speed_rpm"] * math.pi / 30


def stage_of(scene):
    """PlanetarySet of a scene with the pairs `sun_planet` and `planet_ring`."""
    outer, inner = scene.pairs["sun_planet"].pair, scene.pairs["planet_ring"].pair
    return PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, scene.machine["n_planets"], outer.a)


def curves(pair, case, options):
    """Curve of a scene's pair over one cycle, and that of its damaged tooth's engagement (None if healthy), by one method.

    Without the part of shafts that hold its gears: a machine has bearings of its own.
    """
    damage = pair.damage.get(case, {})
    if options["method"] == "auto" and any(isinstance(one, Pit) or not one.through for found in damage.values() for one in found):
        options = options | {"method": "ritz3d"}
    healthy = mesh_stiffness(**pair.case(), **options).without_supports()
    return healthy, mesh_stiffness(**pair.case(case), **options, span="tooth").without_supports() if damage else None


def healthy_and_hurt(scene, case, options, kinds):
    """Healthy curves by kind of mesh, and damage of the sun's tooth 0, from ``kinds[kind]``, a scene pair's name."""
    for kind, name in kinds.items():
        if case in scene.pairs[name].damage and not kind.startswith("sun"):
            raise ValueError(f"case {case!r} damages {name}, but in this machine only the sun has damage: use its cases")
    found = {name: curves(scene.pairs[name], case, options) for name in dict.fromkeys(kinds.values())}
    healthy = {kind: found[name][0] for kind, name in kinds.items()}
    hurt = {kind: found[name][1] for kind, name in kinds.items() if found[name][1] is not None}
    return healthy, hurt
