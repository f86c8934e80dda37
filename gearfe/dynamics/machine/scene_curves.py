"""What the machines of scenes share: speed, stage, and stiffness curves or laws of force of the pairs, healthy and damaged."""

import math
from dataclasses import replace

import numpy as np

from ...geometry.damage.kinds import told
from ...geometry.pair.planetary import PlanetarySet
from ...stiffness.curve import StiffnessCurve
from ...stiffness.mesh_cycle import MeshCycle, differing, like_all, mesh_cycle
from ...stiffness.solve import Solve, solve
from .contact_law import force
from .force_law import law_of
from .gear_mesh import ToothDamage
from .tables import Fault

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
    """`MeshCycle` of a scene's pair in a case of damage: its healthy cycle, and each tooth that differs, by one method.

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
        curve = StiffnessCurve(phase, flat, flat, pair.force / flat, np.zeros(1, dtype=int), pairs, pairs)
        return MeshCycle(pair.case(), options["phases"], curve, ())
    hurt = pair.case(case if loads is not None and case in pair.damage else None)
    how = Solve(**{key: value for key, value in options.items() if key != "loads"})
    if loads is None:
        hurt = like_all(hurt, (0, 1))
    elif len(loads[name][0]) == 1:
        hurt = replace(hurt, force=loads[name][0][0])

    def of_one(solved, at):
        curve = solve(solved, at).without_supports()
        return replace(curve, meta=curve.meta | {"scene_pair": name})

    def of_several(solved, at):
        return law_of(replace(solved, force=loads[name][0]), at, loads[name][1])

    return mesh_cycle(hurt, how, curve=of_one if loads is None or len(loads[name][0]) == 1 else of_several)


def teeth_of(cycle):
    """`ToothDamage` of all parts of a `MeshCycle`, for `GearMesh`: its teeth are numbered in the order they enter."""
    both = [part for part in cycle.parts if len(part.gears) == 2]
    alone = [part for part in cycle.parts if len(part.gears) == 1]
    damage = [ToothDamage(part.gears[0], part.position, part.curve) for part in alone]
    return (*damage, *(ToothDamage(0, part.position, part.curve, every=part.period) for part in both))


def faults_of(cycle, bodies, stage):
    """`Fault` of each tooth of a `MeshCycle` that differs from the others; of an eccentric gear one for all its teeth."""
    case, out = cycle.case, []
    for side, (name, body) in enumerate(zip(("pinion", "wheel"), bodies, strict=True)):
        gear = (case.pair.gear_1, case.pair.gear_2)[side]
        hurt = (case.damage or {}).get(name, ())
        teeth = sorted({one.tooth % gear.z for one in hurt})
        said = {tooth: told({name: gear}, {name: [one for one in hurt if one.tooth % gear.z == tooth]}) for tooth in teeth}
        others = sorted(set(differing(case, side)) - set(teeth))
        if others:
            said[others[0]] = "off its place" if len(others) == 1 else f"off its place, as {len(others) - 1} others"
        frequency = stage.returns[body if body in stage.returns else body.rstrip("LR0123456789")]
        out += [Fault(body, tooth, what, frequency, stage.mesh / gear.z) for tooth, what in said.items()]
    return tuple(out)


def healthy_and_hurt(scene, case, options, kinds):
    """Healthy curves by kind of mesh, and damage of the sun's tooth 0, from ``kinds[kind]``, a scene pair's name."""
    for kind, name in kinds.items():
        if case in scene.pair(name).damage and not kind.startswith("sun"):
            raise ValueError(f"case {case!r} damages {name}, but in this machine only the sun has damage: use its cases")
    pair_curves = {name: curves(name, scene.pairs[name], case, options) for name in dict.fromkeys(kinds.values())}
    healthy = {kind: pair_curves[name].healthy for kind, name in kinds.items()}
    hurt = {kind: pair_curves[name].parts[0].curve for kind, name in kinds.items() if pair_curves[name].parts}
    return healthy, hurt
