"""What the machines of scenes share: speed, stage, and stiffness curves or laws of force of the pairs, healthy and damaged."""

import math
from dataclasses import replace

import numpy as np

from ...geometry.pair.planetary import PlanetarySet
from ...stiffness.curve import StiffnessCurve
from ...stiffness.solve import Solve, solve
from .contact_law import force
from .force_law import law_of

IDLE = 1e-3  # of the load that a scene states for a pair: below it a mesh at rest counts as unloaded, and that load is taken


def speed_of(scene):
    """Speed of the driving gear [rad/s]."""
    return scene.machine["speed_rpm"] * math.pi / 30


def stage_of(scene):
    """PlanetarySet of a scene with the pairs `sun_planet` and `planet_ring`."""
    outer, inner = scene.pair("sun_planet").pair, scene.pair("planet_ring").pair
    return PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, scene.machine["n_planets"], outer.a)


def own_forces(machine):
    """Largest force at rest of the meshes of each pair of a scene [N], of a machine made of curves that `curves` named."""
    x = machine.working()
    x = machine.G @ machine.rest() if x is None else x
    out = {}
    for mesh, mesh_force in zip(machine.meshes, force(x, 0 * x, machine.mean_stiffness(), machine.law), strict=True):
        name, stated = (mesh.stiffness.meta[key] for key in ("scene_pair", "force_N"))
        mesh_force = float(abs(mesh_force))
        out[name] = max(out.get(name, 0.0), mesh_force if mesh_force > IDLE * stated else stated)
    return out


def curves(name, pair, case, options):
    """Stiffness of a scene's pair over one cycle, and over its damaged tooth's engagement (None if healthy), by one method.

    `options` are those of `mesh_stiffness`, and ``loads``: by the pair's name the loads [N] it is solved under and the one it
    works at on average. Several make laws of force, one makes curves; None: curves without damage under the load that the scene
    states.
    Method None makes flat curves of 1e8 N/m without solving anything, to check a machine.
    Without the part of shafts that hold its gears: a machine has bearings of its own.
    """
    loads = options["loads"]
    if options["method"] is None:
        phase = np.arange(options["phases"]) / options["phases"]
        flat, pairs = np.full(phase.size, 1e8), np.full((phase.size, 1), np.nan)
        return StiffnessCurve(phase, flat, flat, pair.force / flat, np.zeros(1, dtype=int), pairs, pairs), None
    hurt = pair.case(case if loads is not None and case in pair.damage else None)
    options = {key: value for key, value in options.items() if key != "loads"}
    if options["method"] == "auto":  # one method for both
        options["method"] = Solve().chosen(hurt)[0].name
    results = []
    for solved, span in ((hurt.healthy, "cycle"), (hurt, "tooth"))[: 1 + hurt.damaged]:
        if loads is None or len(loads[name][0]) == 1:
            solved = solved if loads is None else replace(solved, force=loads[name][0][0])
            curve = solve(solved, Solve(span=span, **options)).without_supports()
            results.append(replace(curve, meta=curve.meta | {"scene_pair": name}))
        else:
            results.append(law_of(replace(solved, force=loads[name][0]), Solve(span=span, **options), loads[name][1]))
    return results[0], results[1] if hurt.damaged else None


def healthy_and_hurt(scene, case, options, kinds):
    """Healthy curves by kind of mesh, and damage of the sun's tooth 0, from ``kinds[kind]``, a scene pair's name."""
    for kind, name in kinds.items():
        if case in scene.pair(name).damage and not kind.startswith("sun"):
            raise ValueError(f"case {case!r} damages {name}, but in this machine only the sun has damage: use its cases")
    pair_curves = {name: curves(name, scene.pairs[name], case, options) for name in dict.fromkeys(kinds.values())}
    healthy = {kind: pair_curves[name][0] for kind, name in kinds.items()}
    hurt = {kind: pair_curves[name][1] for kind, name in kinds.items() if pair_curves[name][1] is not None}
    return healthy, hurt
