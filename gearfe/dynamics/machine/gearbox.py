"""The gearbox of a scene: shafts with several gears, motor, loads, couplings and planetary stages.

Stations move in rotation alone (``dofs = "torsion"``) or in six directions. The sun of a planetary stage is a gear of its shaft.
"""

import math
from typing import Any

import numpy as np

from ...scene.schema import scene_schema
from ...scene.train import Train
from .gear_mesh import GearMesh
from .layout import SPACE, Body, Layout
from .loads import Load
from .scene_curves import Meshed, scene_machine
from .shaft_chain import Chain, bearing_springs, chain, lumps, shaft_springs
from .springs import Spring
from .stages import Stage
from .tables import Machine
from .train_planets import (
    KINDS,
    carrier_lump,
    disc,
    mesh_rate,
    phases_of,
    pin_springs,
    planet_bodies,
    planet_speeds,
    planetary_meshes,
    planets_of,
    sense_of,
)

LOOSE = 1e-9  # singular values of unit rows below this count as zero
DOFS = {"torsion": "theta", "six": SPACE}


def scene_gearbox(scene, case, **options):
    """Build the machine of a scene with a `Train`, with the stiffness curves of its pairs."""
    train = scene.train
    homes = {name: (one, two) for name, (one, two, _) in train.pairs.items()}
    meshes = {name: Meshed(name, bodies) for name, bodies in homes.items()}
    for name, stage in train.stages.items():
        sun, _, ring = stage.gears
        names, fields = planets_of(stage), phases_of(scene, name)
        for i, planet in enumerate(names):
            bodies = dict(zip(KINDS, ((sun, planet), (planet, ring)), strict=True))
            for kind, pair in zip(KINDS, stage.pairs, strict=True):
                meshes[f"{pair}{i + 1}"] = Meshed(pair, bodies[kind], fields[f"{kind}{i + 1}"].get("first", (0, 0)))
        homes |= dict(zip(stage.pairs, ((sun, names[0]), (names[0], ring)), strict=True))
    check_bearings(scene)
    return scene_machine(scene, case, options, meshes, homes, lambda healthy, **drive: gearbox(scene, healthy, drive["damage"]))


def check_bearings(scene):
    """Raise ValueError if a shaft with six directions lacks bearings, or for keys of ``[machine]`` that gearboxes do not use."""
    if scene.machine["n_planets"] != scene_schema()["machine"].keys["n_planets"].default:
        raise ValueError(f"{scene.name}.toml [machine] n_planets: the planets of a gearbox are those of [stage.NAME] n_planets")
    if scene.machine["dofs"] == "torsion":
        for key in ("runout_um", "misplaced_um", "misplaced_y_um"):
            if scene.machine[key]:
                raise ValueError(
                    f"{scene.name}.toml [machine] {key}: stations without translations neglect it; give dofs = 'six'"
                )
        return
    for name, shaft in scene.train.shafts.items():
        where = f"{scene.name}.toml [shaft.{name}]"
        if not shaft.radial:
            raise ValueError(f"{where}: dofs = 'six' needs bearings_at_mm and bearings_N_per_um; give them, or dofs = 'torsion'")
        if not any(shaft.axial):
            raise ValueError(f"{where} bearings_axial_N_per_um: no bearing locates the shaft along its axis; give one")


def gearbox(scene, stiffness, damage):
    """Return the `Machine` of a scene with a `Train`.

    Parameters
    ----------
    scene : Scene
    stiffness : dict
        By pair, anything that `GearMesh` takes.
    damage : dict
        By mesh, tuples of `ToothDamage`.

    Returns
    -------
    Machine
        Mass of gears and shafts is lumped at the stations. Stages are in the order of power, the one of the motor last.
    """
    train, run = scene.train, scene.machine
    chains = _chains(train)
    layout = Layout([*_stations(scene, chains), *_ends(train), *planet_bodies(scene)])
    springs = []
    for name, made in chains.items():
        springs += shaft_springs(layout, made, f"shaft {name}", run["damping_per_stiffness_s"])
        springs += bearing_springs(layout, made, f"bearing {name}") if run["dofs"] == "six" else []
    springs += [*_joints(layout, train, chains), *pin_springs(scene, layout, chains)]
    meshes = [*_parallel(scene, layout, stiffness, damage), *planetary_meshes(scene, layout, chains, stiffness, damage)]
    loads = [Load(name, layout.unit(_end(train, chains, name), "theta"), train.torques[name]) for name in train.ends]
    rotors = {body: train.speeds[name] for name, made in chains.items() for body in made.names}
    rotors = rotors | planet_speeds(scene) if run["dofs"] == "six" else {}
    notes = {
        "shaft speeds [rpm]": {name: speed * 30 / math.pi for name, speed in train.speeds.items()},
        "torques [N m]": dict(train.torques),
        "mass of shafts": "lumped at the stations",
    }
    notes |= _passes(scene)
    _check_held(scene, layout, [*(spring.row for spring in springs if spring.k), *(mesh.row for mesh in meshes)])
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), tuple(loads), notes, _stages(scene), rotors=rotors)


def _passes(scene):
    """Return notes on planets that pass a sensor, counter-clockwise positive. Several stages give notes by pair."""
    train, out = scene.train, {}
    for name, stage in train.stages.items():
        turns, spacing = train.speeds[stage.carrier] / (2 * math.pi), sense_of(scene, name)[1] * 360 / stage.n_planets
        for key, value in {"carrier frequency [Hz]": turns, "planet spacing [deg]": spacing}.items():
            out[key] = out.get(key, {}) | dict.fromkeys(stage.pairs, value)
    return out if len(train.stages) > 1 else {key: next(iter(by_pair.values())) for key, by_pair in out.items()}


def _check_held(scene, layout, rows):
    """Raise ValueError if a body can move without deflection of a spring or mesh, except by the rotation of the whole train."""
    held = np.array(rows)
    sizes, ways = np.linalg.svd(held / np.linalg.norm(held, axis=1, keepdims=True))[1:]
    free = ways[np.count_nonzero(sizes > LOOSE) :]
    if len(free) > 1:
        moved = np.where([".theta" in dof for dof in layout.dofs], 0.0, np.abs(free).max(axis=0))
        dof = layout.dofs[int(np.argmax(moved))]
        raise ValueError(
            f"{scene.name}.toml: {dof} can move without any deflection, and not only by rotation of the train: give its shaft "
            "two bearings or more, or its pins a stiffness"
        )


def _chains(train: Train) -> dict[str, Chain]:
    """Return the `Chain` of each shaft, with stations of motor, loads, couplings and carriers."""
    places: dict[str, dict[str, float]] = {name: {} for name in train.shafts}
    for name, end in train.ends.items():
        shaft = end["shaft"]
        default = 0.0 if name == "motor" else train.shafts[shaft].length
        places[shaft][name if not _elastic(end) else f"{name}_end"] = default if end["at_mm"] is None else end["at_mm"]
    for name, stage in train.stages.items():
        places[stage.carrier][f"{name}_carrier"] = stage.at
    return {name: chain(name, shaft, places[name]) for name, shaft in train.shafts.items()}


def _end(train, chains, name):
    """Return the body on which a motor or load acts."""
    end = train.ends[name]
    return name if _elastic(end) else _held(train, chains, name)


def _held(train, chains, name):
    """Return the station of a motor or load on its shaft."""
    made, at = chains[train.ends[name]["shaft"]], train.ends[name]["at_mm"]
    return made.at(0.0 if name == "motor" else made.shaft.length) if at is None else made.at(at)


def _stations(scene, chains):
    """Return the `Body` of each station: parts of shafts, with their gears, rigidly coupled rotors and carriers."""
    train, run, out = scene.train, scene.machine, []
    more = [(_held(train, chains, n), (0.0, e["inertia_kgm2"], 0.0)) for n, e in train.ends.items() if not _elastic(e)]
    more += [(chains[stage.carrier].at(stage.at), carrier_lump(scene, stage)) for stage in train.stages.values()]
    more += [(gear, disc(scene, gear)) for gear in train.homes]
    for made in chains.values():
        for body, lump in zip(made.names, lumps(made, run["density_kg_per_m3"]), strict=True):
            sizes = np.sum([lump, *(own for place, own in more if place == body)], axis=0).tolist()
            out.append(Body(body, *sizes[:2], DOFS[run["dofs"]], sizes[2]))
    return out


def _elastic(end):
    return end["torsion_Nm_per_mrad"] is not None


def _ends(train):
    """Return the `Body` of each motor and load behind an elastic coupling."""
    out = []
    for name, end in train.ends.items():
        if _elastic(end):
            if not end["inertia_kgm2"] > 0:
                raise ValueError(f"[{name}] inertia_kgm2 = 0, but a member behind an elastic coupling needs a moment of inertia")
            out.append(Body(name, 0.0, end["inertia_kgm2"], "theta"))
    return out


def _joints(layout: Layout, train: Train, chains: dict[str, Chain]) -> list[Spring]:
    """Return the couplings between shafts, to motor and loads, and the slopes of torque-speed lines as dampers to the ground."""
    joints = [
        (name, chains[row["shaft_1"]].names[-1], chains[row["shaft_2"]].names[0], row) for name, row in train.couplings.items()
    ]
    ends = [(name, _held(train, chains, name), _end(train, chains, name), row) for name, row in train.ends.items()]
    out = []
    for name, one, two, row in (*joints, *ends):
        if one != two:
            turn = layout.unit(two, "theta") - layout.unit(one, "theta")
            out.append(Spring(f"coupling {name}", turn, 1e3 * row["torsion_Nm_per_mrad"], row["damping_Nms_per_rad"]))
        if row.get("slope_Nms_per_rad"):
            out.append(Spring(f"line {name}", layout.unit(two, "theta"), 0.0, row["slope_Nms_per_rad"]))
    return out


def pair_phases(scene):
    """Return the phase at t = 0 of each pair between shafts, from the angular positions of the gears on each shaft.

    Tooth 0 of the first gear of the motor's shaft is at the angle 0. Tooth 0 of a driven gear meets tooth 0 of its driver. The
    driving flank of a tooth at the angle c passes the pitch point, at the angle d, where ``sense (c - d) + half thickness =
    0``.
    """
    train, out = scene.train, {}
    base = {train.ends["motor"]["shaft"]: 0.0}  # angle of the mark on each shaft, zero after couplings and planetary stages
    for link in train.links:
        if link.name not in train.pairs:
            base.setdefault(link.one, 0.0), base.setdefault(link.two, 0.0)
            continue
        (one, two, angle), pair = train.pairs[link.name], scene.pair(link.name).pair
        sense, turn = (math.copysign(1, train.speeds[shaft]) for shaft in (link.one, link.two))
        tooth = base[link.one] + train.shafts[link.one].turned[one]
        ahead = sense * (tooth - angle) + pair.gear_1.half_thickness(pair.pitch_radius_1)
        out[link.name] = pair.pitch_phase + pair.gear_1.z / (2 * math.pi) * ahead
        z_2, place = pair.gear_2.z, angle if pair.gear_2.internal else angle + math.pi
        behind = pair.gear_2.half_thickness(pair.pitch_radius_2) + 2 * math.pi / z_2 * (out[link.name] - pair.pitch_phase)
        base[link.two] = place + turn * behind - train.shafts[link.two].turned[two]
    return out


def _parallel(scene, layout, stiffness, damage):
    """Return the meshes between shafts.

    A positive helix angle is a right-hand helix, whose driver is pushed forward by its rotation.
    """
    train, out, phases = scene.train, [], pair_phases(scene)
    for link in train.links:
        if link.name not in train.pairs:
            continue
        (one, two, angle), pair, speed = train.pairs[link.name], scene.pair(link.name).pair, train.speeds[link.one]
        sense = 1 if speed > 0 else -1
        row = layout.pair_mesh(one, two, pair, angle, sense=sense, helix=-sense * math.tan(pair.gear_1.beta_b))
        fields: dict[str, Any] = {"teeth": (pair.gear_1.z, pair.gear_2.z), "damage": damage[link.name]}
        fields |= {"phase": phases[link.name], "frequency": abs(speed) * pair.gear_1.z / (2 * math.pi)}
        out.append(
            GearMesh(
                link.name, row, stiffness[link.name], damping_per_stiffness=scene.machine["damping_per_stiffness_s"], **fields
            )
        )
    return out


def _stages(scene):
    """Return the `Stage` of each pair and planetary stage, from the loads to the motor, whose stage is the last."""
    train, out = scene.train, []
    for link in train.links:
        turns = [abs(train.speeds[shaft]) / (2 * math.pi) for shaft in (link.one, link.two)]
        if link.name in train.pairs:
            bodies = train.pairs[link.name][:2]
            mesh = turns[0] * scene.gears[bodies[0]].z
            returns = dict(zip(bodies, turns, strict=True))
            out.append(Stage(link.name, bodies[:1], bodies[1:], mesh, turns[0], returns=returns))
        elif link.name in train.stages:
            stage, mesh = train.stages[link.name], abs(mesh_rate(scene, link.name))
            sun, planet, ring = (mesh / scene.gears[gear].z for gear in stage.gears)
            names, n = planets_of(stage), stage.n_planets
            returns = {stage.gears[0]: n * sun, stage.gears[2]: n * ring} | dict.fromkeys(names, planet)
            more = {"fault": n * sun, "carrier": turns[1], "returns": returns}
            out.append(Stage(link.name, stage.gears[:1], (names[0],), mesh, sun, **more))
    return tuple(reversed(out))
