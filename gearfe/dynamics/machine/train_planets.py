"""Planetary stages of a gearbox: their planets, the springs of the pins, meshes and phases.

With ``dofs = "torsion"`` the axes of the planets follow the carrier rigidly. With ``"six"`` planets move on their pins in all
directions. The ring is at rest. Directions are those of the carrier at time 0, and terms of its rotation are neglected. Forces
on sun and carrier therefore have constant directions here, while they rotate for a fixed observer.
"""

import math

from ...scene.train import TrainStage
from .gear_mesh import GearMesh
from .layout import SPACE, Body, outwards
from .member import gear_member
from .planetary import stage_phases

KINDS = ("sun_planet", "planet_ring")
DAMPED = 0.02  # damping ratio of a planet on its pin


def planets_of(stage: TrainStage) -> list[str]:
    """Return the names of the planet bodies of a stage."""
    return [f"{stage.gears[1]}{i + 1}" for i in range(stage.n_planets)]


def disc(scene, gear):
    """Return mass [kg] and polar and diametral moments of inertia [kg m2] of a gear of a scene."""
    member = gear_member(scene.gears[gear], scene.machine["density_kg_per_m3"], 0.0)
    return member.mass, member.inertia, member.inertia / 2 + member.mass * (1e-3 * scene.gears[gear].b) ** 2 / 12


def moves(scene):
    """Return whether the planets move on their pins."""
    return scene.machine["dofs"] == "six"


def carrier_lump(scene, stage):
    """Return mass [kg] and polar and diametral moments of inertia [kg m2] that a stage adds at the station of its carrier.

    A carrier is a thin disc. Planets that follow it rigidly add their moment of inertia.
    """
    mass = stage.n_planets * disc(scene, stage.gears[1])[0]
    planets = mass * _radius(scene, stage) ** 2
    own = planets if stage.inertia is None else stage.inertia
    return (mass if stage.mass is None else stage.mass, own, own / 2) if moves(scene) else (0.0, planets + own, 0.0)


def planet_bodies(scene):
    """Return the `Body` of each planet. Without translations it rotates about its own axis."""
    dofs = SPACE if moves(scene) else "theta"
    out = []
    for stage in scene.train.stages.values():
        mass, inertia, across = disc(scene, stage.gears[1])
        out += [Body(name, mass, inertia, dofs, across) for name in planets_of(stage)]
    return out


def planet_speeds(scene):
    """Return the absolute angular velocity of each planet [rad/s]."""
    train, out = scene.train, {}
    for stage in train.stages.values():
        turn, (_, planet, ring) = train.speeds[stage.carrier], (scene.gears[gear].z for gear in stage.gears)
        out |= dict.fromkeys(planets_of(stage), turn * (1 - ring / planet))
    return out


def pin_springs(scene, layout, chains):
    """Return the springs between moving planets and carrier. The default tilting stiffness is that of a uniform bearing.

    A bearing of radial stiffness k over the face width b has the tilting stiffness ``k b**2 / 12``.
    """
    out = []
    for name, stage in scene.train.stages.items() if moves(scene) else ():
        if stage.pin is None:
            raise ValueError(f"{scene.name}.toml [stage.{name}]: dofs = 'six' needs pin_N_per_um; give it, or dofs = 'torsion'")
        even = stage.pin * (1e-3 * scene.gears[stage.gears[1]].b) ** 2 / 12
        tilt = even if stage.pin_tilt is None else stage.pin_tilt
        axial = stage.pin if stage.pin_axial is None else stage.pin_axial
        held = dict.fromkeys("xy", stage.pin) | {"z": axial, "tilt_x": tilt, "tilt_y": tilt}
        for i, body in enumerate(planets_of(stage)):
            arm = _radius(scene, stage) * outwards(_angle(scene, name, i))
            out += layout.springs(body, chains[stage.carrier].at(stage.at), held, DAMPED, arm)
    return out


def _radius(scene, stage):
    return 1e-3 * scene.pair(stage.pairs[0]).pair.a


def _angle(scene, name, i):
    """Return the angle of planet i [rad]. Planets are numbered in the sense of the torque on the sun."""
    return sense_of(scene, name)[1] * 2 * math.pi * i / scene.train.stages[name].n_planets


def sense_of(scene, name):
    """Return the `Link` of a planetary stage, and the sense of the torque of the sun's shaft on the sun."""
    link = next(link for link in scene.train.links if link.name == name)
    return link, (1 if link.ratio * scene.train.torques[name] > 0 else -1)


def mesh_rate(scene, name):
    """Return the mesh frequency of a planetary stage [Hz]. It is negative for a driven sun, whose contacts move in reverse."""
    (link, sense), speeds = sense_of(scene, name), scene.train.speeds
    return sense * (speeds[link.one] - speeds[link.two]) * scene.gears[scene.train.stages[name].gears[0]].z / (2 * math.pi)


def phases_of(scene, name):
    """Return the fields of the meshes of a planetary stage, as from `stage_phases`."""
    stage = scene.train.stages[name]
    pairs = scene.pair(stage.pairs[0]).pair, scene.pair(stage.pairs[1]).pair
    return stage_phases(pairs, stage.n_planets, frequency=mesh_rate(scene, name))


def planetary_meshes(scene, layout, chains, stiffness, damage):
    """Return the meshes of the planetary stages: sun on planets, planets on ring, in the sense of the sun's torque."""
    out = []
    for name, stage in scene.train.stages.items():
        fields, sense = phases_of(scene, name), sense_of(scene, name)[1]
        for i, body in enumerate(planets_of(stage)):
            ends = (stage.gears[0], body), (body, None)
            for kind, pair, bodies, turn in zip(KINDS, stage.pairs, ends, (sense, -sense), strict=True):
                mesh, gears = f"{pair}{i + 1}", scene.pair(pair).pair
                place, helix = _angle(scene, name, i), -turn * math.tan(gears.gear_1.beta_b)
                row = layout.pair_mesh(*bodies, gears, place, sense=turn, helix=helix)
                if not moves(scene):  # The axis of the planet is rigidly attached to the carrier.
                    along = turn * math.cos(gears.alpha_wt) * outwards(place + math.pi / 2)
                    along += math.sin(gears.alpha_wt) * outwards(place)
                    carrier = layout.point(chains[stage.carrier].at(stage.at), along, 1e-3 * gears.a * outwards(place))
                    row += carrier if bodies[1] is None else -carrier
                more = fields[f"{kind}{i + 1}"] | {"damage": damage[mesh]}
                more["damping_per_stiffness"] = scene.machine["damping_per_stiffness_s"]
                out.append(GearMesh(mesh, row, stiffness[pair], **more))
    return out
