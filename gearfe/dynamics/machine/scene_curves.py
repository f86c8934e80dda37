"""Common parts of the machines of scenes: speed, stage, stiffness curves or force laws, damage."""

import math
from dataclasses import replace
from difflib import get_close_matches
from typing import Any, NamedTuple

import numpy as np

from ...geometry.damage.kinds import told
from ...geometry.pair.planetary import PlanetarySet
from ...geometry.tooth.modified import Flank
from ...stiffness.curve import StiffnessCurve
from ...stiffness.deviating_teeth import NAMES as SIDES
from ...stiffness.deviating_teeth import common_profile, differing, like_all, renumbered
from ...stiffness.mesh_cycle import MeshCycle, mesh_cycle
from ...stiffness.solve import Solve, solve
from .contact_law import force
from .force_law import law_of
from .stages import Fault
from .tooth_damage import ToothDamage

IDLE = 1e-3  # Meshes below this part of the pair's stated load at rest count as unloaded and use the stated load.


def speed_of(scene):
    """Speed of the driving gear [rad/s]."""
    return scene.machine["speed_rpm"] * math.pi / 30


def stage_of(scene):
    """Return the `PlanetarySet` of a scene with the pairs `sun_planet` and `planet_ring`."""
    outer, inner = scene.pair("sun_planet").pair, scene.pair("planet_ring").pair
    return PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, scene.machine["n_planets"], outer.a)


def own_forces(machine):
    """Return the largest force at rest in the meshes of each pair [N]. The curve of a mesh states its pair."""
    x = machine.working()
    x = machine.G @ machine.rest() if x is None else x
    out = {}
    for mesh, mesh_force in zip(machine.meshes, force(x, 0 * x, machine.mean_stiffness(), machine.law), strict=True):
        name, stated = (mesh.stiffness.meta[key] for key in ("scene_pair", "force_N"))
        mesh_force = float(abs(mesh_force))
        out[name] = max(out.get(name, 0.0), mesh_force if mesh_force > IDLE * stated else stated)
    return out


def pair_backlash(scene, name):
    """Return the backlash of the meshes of a pair [m], from ``[machine]`` or from tooth thickness allowances. 0 means none."""
    stated, pair = scene.machine.get("backlash_um"), scene.pairs[name].pair
    thin = pair.gear_1.E_sn or pair.gear_2.E_sn
    return 1e-6 * stated if stated is not None else 1e-3 * pair.backlash if thin else 0.0


class Meshed(NamedTuple):
    """Mesh of a machine: pair of the scene, names of both bodies, and the teeth that meet at phase 0."""

    pair: str
    bodies: tuple[str, str]
    first: tuple[int, int] = (0, 0)


class SceneCurves(NamedTuple):
    """Healthy stiffness by pair of the scene, damage by mesh, and deviating teeth by body."""

    healthy: dict[str, Any]
    damage: dict[str, tuple[ToothDamage, ...]]
    teeth: dict[tuple[str, int], tuple[str, int]]  # by body and tooth: name, number of teeth

    def faults(self, machine):
        """Return the `Fault` of each deviating tooth."""
        out = []
        for (body, tooth), (what, z) in self.teeth.items():
            stage, gear = machine.stage_of(body), body.rstrip("0123456789")
            returns = stage.returns[body if body in stage.returns else gear]
            out.append(Fault(body, tooth, what, returns, stage.mesh / z))
        return tuple(out)


def scene_curves(scene, case, options, meshes, homes):
    """Return the `SceneCurves` of a machine of a scene.

    Parameters
    ----------
    scene : Scene
    case : str or None
    options : dict
        See `mesh_stiffness`, and ``loads``: by the pair's name the loads [N] it is solved under and the one it works at on
        average. Several make force laws, one makes curves; None: curves of teeth all alike under the load that the scene
        states. Method None makes flat curves of 1e8 N/m without solving anything, to check a machine.
    meshes : dict of str to Meshed
        By name.
    homes : dict of str to (str, str)
        By pair, the bodies whose teeth damage is in unless it names another.

    Raises
    ------
    ValueError
        If a case damages a body that no mesh has.
    """
    hurt = {name: _at(scene.pair(mesh.pair), case, mesh.bodies, homes) for name, mesh in meshes.items()}
    _check_owners(scene, case, meshes, homes)
    _check_flanks(scene, meshes)
    cases = {}
    for name, mesh in meshes.items():
        pair = scene.pair(mesh.pair)
        flanks = pair.flanks_at(dict(zip(SIDES, mesh.bodies, strict=True)))
        cases[name] = replace(pair.case(), damage=hurt[name] or None, flanks=flanks or None)
    healthy, damage, teeth, kept = {}, {}, {}, {}
    for name, mesh in meshes.items():
        own, by = cases[name], mesh.first[1] - mesh.first[0]
        teeth |= _teeth(own, mesh.bodies)
        own = renumbered(own, by) if by and all(differing(own, side) for side in (0, 1)) else own
        alike = mesh.pair, repr((own.damage, own.flanks)), own is cases[name] or by
        if alike not in kept:
            same_pair = [cases[other] for other, one in meshes.items() if one.pair == mesh.pair]
            kept[alike] = curves(mesh.pair, own, options, same_pair)
        healthy.setdefault(mesh.pair, kept[alike].healthy)
        damage[name] = teeth_of(kept[alike], mesh.first if own is not cases[name] else (0, 0))
    return SceneCurves(healthy, damage, teeth)


def scene_machine(scene, case, options, meshes, homes, build):
    """Build the machine by ``build(healthy, damage=, speed=, torque=)`` from `scene_curves` and the drive of the scene.

    Parameters
    ----------
    scene, case, options, meshes, homes
        See `scene_curves`.
    build : callable
        Gets the healthy stiffness by pair, `ToothDamage` by mesh, speed [rad/s] and torque [N m] of the driving gear.

    Returns
    -------
    Machine
    """
    found = scene_curves(scene, case, options, meshes, homes)
    made = build(found.healthy, damage=found.damage, speed=speed_of(scene), torque=scene.machine["torque_Nm"])
    return replace(made, faults=found.faults(made))


def _at(pair, case, bodies, homes):
    """Return the damage of the two bodies of a mesh."""
    out = {}
    for side, body in zip(SIDES, bodies, strict=True):
        owned = pair.owned.get(case, {}).get(side, {})
        found = [one for owner, damage in owned.items() if _owner(owner, homes) == body for one in damage]
        out |= {side: found} if found else {}
    return out


def _owner(owner, homes):
    return owner.body or homes[owner.home][SIDES.index(owner.side)]


def _check_owners(scene, case, meshes, homes):
    """Raise ValueError if a damaged body is on the given side in no mesh of its pair."""
    for name, pair in scene.pairs.items():
        for side, owned in pair.owned.get(case, {}).items():
            there = {mesh.bodies[SIDES.index(side)] for mesh in meshes.values() if mesh.pair == name}
            for owner in owned:
                if owner.home == name and (name not in homes or _owner(owner, homes) not in there):
                    body = owner.body or name
                    near = get_close_matches(body, there, 1, 0.0)
                    raise ValueError(
                        f"case {case!r} damages body {body!r} as {side} of pair {name}, but bodies with this gear are "
                        f"{', '.join(sorted(there)) or 'not in this machine'}" + (f"; nearest: {near[0]!r}" if near else "")
                    )


def _check_flanks(scene, meshes):
    """Raise ValueError for flanks of an unknown body, or of one body with another profile than the rest has."""
    for name, pair in scene.pairs.items():
        for side, own in pair.owned_flanks.items():
            gear = pair.pair.gears[SIDES.index(side)]
            there = {mesh.bodies[SIDES.index(side)] for mesh in meshes.values() if mesh.pair == name}
            for body, flank in own.items():
                if body is not None and body not in there:
                    near = get_close_matches(body, there, 1, 0.0)
                    raise ValueError(
                        f"[flank] body = {body!r} as {side} of pair {name}, but bodies with this gear are "
                        f"{', '.join(sorted(there)) or 'not in this machine'}" + (f"; nearest: {near[0]!r}" if near else "")
                    )
                if body is not None and common_profile(flank, gear) != common_profile(own.get(None, Flank()), gear):
                    raise ValueError(
                        f"[flank] body = {body!r} of pair {name} has another profile than the other bodies, but in a machine all "
                        "meshes of a pair have one healthy stiffness: give body to pitch_um, tooth_scale and eccentricity_um of "
                        "single teeth only, or compute [set] by gearfe set"
                    )


def _teeth(case, bodies):
    """Describe the damaged or deviating teeth of a case, with the tooth number of the gear. An eccentric gear has one entry."""
    out = {}
    for side, (name, body) in enumerate(zip(SIDES, bodies, strict=True)):
        gear = case.pair.gears[side]
        hurt = (case.damage or {}).get(name, ())
        teeth = sorted({one.tooth % gear.z for one in hurt})
        said = {tooth: told({name: gear}, {name: [one for one in hurt if one.tooth % gear.z == tooth]}) for tooth in teeth}
        others = sorted(set(differing(case, side)) - set(teeth))
        if others:
            said[others[0]] = "off its place" if len(others) == 1 else f"off its place, as {len(others) - 1} others"
        out |= {(body, tooth): (what, gear.z) for tooth, what in said.items()}
    return out


def curves(name, case, options, same_pair=()):
    """Return the `MeshCycle` of the pair `name` of a scene in a case, by a method that suits all cases of `same_pair`.

    `scene_curves` describes `options`. The deflection of shafts is not included, since a machine has separate bearings.
    """
    loads = options["loads"]
    if options["method"] is None:
        phase = np.arange(options["phases"]) / options["phases"]
        flat, pairs = np.full(phase.size, 1e8), np.full((phase.size, 1), np.nan)
        curve = StiffnessCurve(phase, flat, flat, case.forces[0] / flat, np.zeros(1, dtype=int), pairs, pairs)
        return MeshCycle(case, options["phases"], curve, ())
    how = Solve(**{key: value for key, value in options.items() if key != "loads"})
    if loads is None:
        case = like_all(case, (0, 1))
    elif len(loads[name][0]) == 1:
        case = replace(case, force=loads[name][0][0])
    if how.method == "auto" and loads is not None:
        chosen = [how.chosen(one)[0] for one in (case, *same_pair)]
        how = replace(how, method=next((row for row in chosen if row.kind == "solid"), chosen[0]).name)

    def of_one(solved, at):
        curve = solve(solved, at).without_supports()
        return replace(curve, meta=curve.meta | {"scene_pair": name})

    def of_several(solved, at):
        return law_of(replace(solved, force=loads[name][0]), at, loads[name][1])

    fine = loads is not None and len(loads[name][0]) == 1
    return mesh_cycle(case, how, fine=fine, curve=of_one if loads is None or fine else of_several)


def teeth_of(cycle, first=(0, 0)):
    """Return the `ToothDamage` of each damaged tooth of a `MeshCycle`. Teeth are numbered in the order of engagement.

    `first` are the teeth of the pair that enters at phase 0, if the wheel's teeth were renumbered.
    """
    both = [part for part in cycle.parts if len(part.gears) == 2]
    alone = [part for part in cycle.parts if len(part.gears) == 1]
    damage = [ToothDamage(part.gears[0], part.position - first[0] + first[part.gears[0]], part.curve) for part in alone]
    return (*damage, *(ToothDamage(0, part.position, part.curve, every=part.period) for part in both))
