"""What the machines of scenes share: speed, stage, and stiffness curves or laws of force of the pairs, healthy and damaged."""

import math
from dataclasses import replace

from geometry.pair.planetary import PlanetarySet

from ..stiffness.solve import mesh_stiffness
from .contact_law import force
from .force_law import force_law

IDLE = 1e-3  # of the load that a scene states for a pair: below it a mesh at rest counts as unloaded, and that load is taken


def speed_of(scene):
    """Speed of the driving gear [rad/s]."""
    return scene.machine["speed_rpm"] * math.pi / 30


def stage_of(scene):
    """PlanetarySet of a scene with the pairs `sun_planet` and `planet_ring`."""
    outer, inner = scene.pairs["sun_planet"].pair, scene.pairs["planet_ring"].pair
    return PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, scene.machine["n_planets"], outer.a)


def own_forces(machine):
    """Largest force at rest of the meshes of each pair of a scene [N], of a machine made of curves that `curves` named."""
    x = machine.working()
    x = machine.G @ machine.rest() if x is None else x
    out = {}
    for mesh, own in zip(machine.meshes, force(x, 0 * x, machine.mean_stiffness(), machine.law), strict=True):
        name, stated = (mesh.stiffness.meta[key] for key in ("scene_pair", "force_N"))
        own = float(abs(own))
        out[name] = max(out.get(name, 0.0), own if own > IDLE * stated else stated)
    return out


def curves(name, pair, case, options):
    """Stiffness of a scene's pair over one cycle, and over its damaged tooth's engagement (None if healthy), by one method.

    `options` are those of `mesh_stiffness`, and ``loads``: by the pair's name the loads [N] it is solved under and the one it
    works at on average. Several make laws of force, one makes curves; None: curves without damage under the load that the scene
    states.
    Without the part of shafts that hold its gears: a machine has bearings of its own.
    """
    given = options["loads"]
    damage = {} if given is None else pair.damage.get(case, {})
    options = {key: value for key, value in options.items() if key != "loads"}
    if options["method"] == "auto" and not all(one.through for found in damage.values() for one in found):
        options = options | {"method": "ritz3d"}
    made = []
    for what, span in ((None, "cycle"), (case, "tooth"))[: 2 if damage else 1]:
        asked = pair.case(what) | options | {"span": span}
        if given is None or len(given[name][0]) == 1:
            asked |= {} if given is None else {"force": given[name][0][0]}
            one = mesh_stiffness(**asked).without_supports()
            made.append(replace(one, meta=one.meta | {"scene_pair": name}))
        else:
            asked.pop("force")
            made.append(force_law(forces=given[name][0], force=given[name][1], **asked))
    return made[0], made[1] if damage else None


def healthy_and_hurt(scene, case, options, kinds):
    """Healthy curves by kind of mesh, and damage of the sun's tooth 0, from ``kinds[kind]``, a scene pair's name."""
    for kind, name in kinds.items():
        if case in scene.pairs[name].damage and not kind.startswith("sun"):
            raise ValueError(f"case {case!r} damages {name}, but in this machine only the sun has damage: use its cases")
    found = {name: curves(name, scene.pairs[name], case, options) for name in dict.fromkeys(kinds.values())}
    healthy = {kind: found[name][0] for kind, name in kinds.items()}
    hurt = {kind: found[name][1] for kind, name in kinds.items() if found[name][1] is not None}
    return healthy, hurt
