"""Two-stage compound planetary gearbox with meshed planets, shared ring and shared carrier."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ...core.record import check_keys, ranged
from ...geometry.pair.gear_pair import GearPair
from ...geometry.renamed import renamed
from .gear_mesh import GearMesh
from .layout import Body, Layout, around, outwards, through
from .loads import Load
from .member import gear_member
from .mesh_curves import Stiffness
from .planetary import angles_of_planets, teeth_damaged
from .scene_curves import Meshed, scene_machine
from .stages import Stage
from .tables import Machine

SCENE_PAIRS = {  # by kind of mesh (b: inner planet, c: outer planet of stage 2): pair of the scene
    "sun1_p": "sun_planet",
    "p_ring": "planet_ring_1",
    "sun2_b": "sun_planet",
    "b_c": "planet_planet",
    "c_ring": "planet_ring_2",
}
KINDS = tuple(SCENE_PAIRS)
HOMES = {  # by pair of the scene: bodies that have the damaged teeth unless the damage names another body
    "sun_planet": ("sun2", "b1"),
    "planet_planet": ("b1", "c1"),
    "planet_ring_1": ("p1", "ring"),
    "planet_ring_2": ("c1", "ring"),
}


def scene_compound(scene, case, **options):
    """Build the machine of a scene with the stiffness curves of its pairs."""
    pairs, n = scene_pairs(scene), scene.machine["n_planets"]
    meshes = {name: mesh.of._replace(pair=SCENE_PAIRS[mesh.of.pair]) for name, mesh in compound_table(pairs, n).items()}

    def build(healthy, **options):
        stiffness = {kind: healthy[name] for kind, name in SCENE_PAIRS.items()}
        return compound_planetary(stiffness, pairs=pairs, n_planets=n, **options)

    return scene_machine(scene, case, options, meshes, HOMES, build)


class _Mesh(NamedTuple):
    """Mesh of the gearbox: gears, angle [rad] and sense (`Layout.mesh`), phase at t = 0 and frequency [Hz]."""

    of: Meshed
    angle: float
    sense: int
    phase: float
    rate: float


def scene_pairs(scene):
    """Return the `GearPair` objects of a scene by kind of mesh."""
    return {kind: scene.pair(name).pair for kind, name in SCENE_PAIRS.items()}


def carrier_speed(pairs, speed):
    """Return the carrier speed if sun 2 rotates at `speed` and sun 1 is at rest, in the same unit. Both stages share one ring.

    ``(n_2 - n_c) z_s2 / z_r2 = n_c z_s1 / z_r1`` (both are the ring's speed relative to the carrier).
    """
    ratio_1 = pairs["sun1_p"].gear_1.z / pairs["p_ring"].gear_2.z
    ratio_2 = pairs["sun2_b"].gear_1.z / pairs["c_ring"].gear_2.z
    return speed * ratio_2 / (ratio_1 + ratio_2)


def branch(pairs):
    """Return centre distances of inner and outer planets from the axis [mm], and the angle by which the outer leads [rad]."""
    inner, between, outer = pairs["sun2_b"].a, pairs["b_c"].a, pairs["c_ring"].a
    cosine = (inner**2 + outer**2 - between**2) / (2 * inner * outer)
    if not -1 < cosine < 1:
        raise ValueError(
            f"centre distances {inner:.6g}, {between:.6g}, {outer:.6g} mm do not form a triangle of sun, inner and outer planet"
        )
    return inner, outer, math.acos(cosine)


def compound_table(pairs, n_planets, rates=(1.0, 1.0)):
    """Return all meshes by name. `rates` are the signed mesh frequencies of both stages [Hz], negative if gear 2 drives.

    Phases are those of `gearfe.dynamics.machine.layout.around` and `through`, 0 for the first mesh of each sun at t = 0.
    """
    inner, outer, ahead = branch(pairs)
    out: dict[str, _Mesh] = {}

    def add(kind, bodies, angle, sense, phase, rate):
        first = (0, 0)
        if bodies[1] == "ring":  # The ring's teeth are numbered in the order in which branch 1 meets them.
            base = next((row.phase for row in out.values() if row.of.pair == kind), phase)
            z = pairs[kind].gear_2.z
            first = (0, _whole(around(base, z, sense, 2 * math.pi * i / n_planets) - phase, kind))
        out["_".join(bodies)] = _Mesh(Meshed(kind, bodies, first), angle, sense, float(phase), rate)

    for i, angle in enumerate(2 * math.pi * np.arange(n_planets) / n_planets):
        p, b, c = (f"{name}{i + 1}" for name in "pbc")
        start = around(0.0, pairs["sun1_p"].gear_1.z, 1, angle)
        passed = through(start, pairs["sun1_p"], pairs["p_ring"], -1, -math.pi)
        add("sun1_p", ("sun1", p), angle, 1, start, rates[0])
        add("p_ring", (p, "ring"), angle, -1, passed, rates[0])
        outward = angle + ahead
        along = _direction(inner, angle, outer, outward)  # direction from the inner to the outer planet
        start = around(0.0, pairs["sun2_b"].gear_1.z, 1, angle)
        middle = through(start, pairs["sun2_b"], pairs["b_c"], -1, along - (angle + math.pi))
        last = through(middle, pairs["b_c"], pairs["c_ring"], 1, outward - (along + math.pi))
        add("sun2_b", ("sun2", b), angle, 1, start, rates[1])
        add("b_c", (b, c), along, -1, middle, rates[1])
        add("c_ring", (c, "ring"), outward, 1, last, rates[1])
    return out


def _direction(r_1, angle_1, r_2, angle_2):
    away = r_2 * np.exp(1j * angle_2) - r_1 * np.exp(1j * angle_1)
    return float(np.angle(away))


def _whole(value, kind):
    if abs(value - round(value)) > 1e-9:
        raise ValueError(
            f"{kind} cannot be assembled with equally spaced planets: {value:.6g} ring teeth between two planets must be a "
            "whole number"
        )
    return round(value)


@renamed(beta="damping_per_stiffness")
def compound_planetary(
    stiffness: Mapping[str, Stiffness],
    *,
    pairs: Mapping[str, GearPair],
    damage: Mapping[str, Any] | None = None,
    speed: float = 700 * math.pi / 30,
    torque: float = 200.0,
    n_planets: int = 3,
    damping_per_stiffness: float = 2e-6,
    zeta: float = 0.02,
    bearing: float = 1e8,
    hold: float = 1e6,
    drive: float = 1e4,
    density: float = 7800.0,
    **mesh: Any,
) -> Machine:
    """Build the two-stage compound planetary gearbox: 39 degrees of freedom (3 per body). Sun 2 drives, sun 1 is fixed.

    Stage 2 drives the ring forward, and stage 1 supports it. In stage 1 the loaded flanks are those of a sun that drives forward.
    That sun is at rest and rotates backward relative to the carrier. Contacts therefore move from the end to the start of the
    path, and the mesh frequency is negative.

    Parameters
    ----------
    stiffness : dict
        Mesh stiffness by kind of mesh (`KINDS`) [N/m].
    pairs : dict
        GearPairs by kind (`scene_pairs` of a scene).
    damage : dict, optional
        ``{"sun2": (tooth, {"sun2_b": curve})}``: by body, the tooth and its curves by kind of mesh; a list of such pairs for
        several teeth. Or by mesh (``"sun2_b1"``) a tuple of `ToothDamage`.
    speed : float
        Speed of sun 2 [rad/s]; the article has 700 rpm.
    torque : float
        Load on the carrier [N m]; the article has 200.
    n_planets : int
        Number of branches, each with one planet of stage 1 and two of stage 2.
    damping_per_stiffness : float
        Mesh damping over stiffness [s]; the article's constants are lost, assumed 2e-6.
    zeta, bearing : float
        Damping ratio and stiffness [N/m] of the supports of every body, assumed 0.02 and 1e8.
    hold, drive : float
        Torsional stiffness at sun 1 (held) and sun 2 (motor shaft) [N m/rad], assumed 1e6 and 1e4.
    density : float
        [kg/m3]; bodies are rings from bore to reference circle, the carrier as heavy as its planets (assumed).
    **mesh
        Further fields of every `GearMesh`.

    Returns
    -------
    Machine
        In SI units and the frame of the carrier: x and y [m] of all bodies along the same axes, theta [rad] counter-clockwise;
        both suns, ring, carrier, then the planets ``p`` of stage 1, ``b`` (inner) and ``c`` (outer) of stage 2.

    Raises
    ------
    ValueError
        If the centre distances of stage 2 make no triangle, the planets cannot be assembled with equal spacing, `density` is not
        positive, a mesh stiffness, `damping_per_stiffness` or `zeta` is negative or not finite, `speed` or `torque` is not
        finite, the phases of a damaged tooth's curve do not rise, or a field of `GearMesh` is out of range.
    """
    speed, torque = ranged("speed", speed, " rad/s"), ranged("torque", torque, " N m")
    check_keys("pair", pairs, KINDS, only=True)
    check_keys("stiffness", stiffness, KINDS, only=True)
    n_planets = len(angles_of_planets(n_planets))
    turn = carrier_speed(pairs, speed)
    suns = pairs["sun1_p"].gear_1, pairs["sun2_b"].gear_1
    rates = -turn * suns[0].z / (2 * math.pi), (speed - turn) * suns[1].z / (2 * math.pi)
    table = compound_table(pairs, n_planets, rates)
    layout, springs = _bodies(pairs, n_planets, (density, bearing, zeta, hold, drive))
    meshes, hurt = [], teeth_damaged(damage, {name: row.of for name, row in table.items()})
    for name, ((kind, bodies, first), angle, sense, phase, rate) in table.items():
        row = layout.pair_mesh(*bodies, pairs[kind], angle, sense=sense)
        fields = {"frequency": rate, "phase": phase, "teeth": _teeth(pairs[kind]), "first": first, "damage": hurt[name]}
        meshes.append(GearMesh(name, row, stiffness[kind], **{"damping_per_stiffness": damping_per_stiffness} | fields | mesh))
    arms = [1e-3 * g.r_b for g in suns]
    rings = pairs["c_ring"].gear_2.r_b / pairs["p_ring"].gear_2.r_b  # ratio of the force in stage 1 to that in stage 2
    driven = torque * arms[1] / (arms[1] + rings * arms[0])
    loads = Load("drive", layout.unit("sun2", "theta"), driven), Load("load", layout.unit("carrier", "theta"), -torque)
    carrier, stages = turn / (2 * math.pi), []
    for i, (planet, rate, gear, returns) in enumerate(zip(("p1", "b1"), rates, suns, _returns(table, pairs), strict=True)):
        turning = abs(rate) / gear.z
        ends = (f"sun{i + 1}",), (planet,)
        stages.append(Stage(f"stage {i + 1}", *ends, abs(rate), turning, n_planets * turning, carrier, returns))
    notes = {
        "mesh frequencies [Hz]": tuple(stage.mesh for stage in stages),
        "fault frequencies of sun teeth [Hz]": tuple(stage.fault for stage in stages),
        "carrier frequency [Hz]": carrier,
        "phases": {name: row.phase for name, row in table.items()},
        "relative phases": relative_phases(table),
    }
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), loads, notes, tuple(stages))


def _teeth(pair):
    return pair.gear_1.z, pair.gear_2.z


def _returns(table, pairs):
    """Return the tooth engagement frequency [Hz] by body of both stages. A ring in both stages belongs to the driven stage."""
    out = [{}, {}]
    for (kind, bodies, _), *_, rate in table.values():
        for body, z in zip(bodies, _teeth(pairs[kind]), strict=True):
            central = body.startswith(("sun", "ring"))
            many = sum(body in row.of.bodies and row.of.pair == kind for row in table.values()) if central else 1
            out[kind not in KINDS[:2]][body] = many * abs(rate) / z
    return out


def relative_phases(table):
    """Return fractional phases relative to the first mesh of the same kind and to the sun's mesh of the same branch [cycles]."""
    by_kind = {kind: [(name, row.phase) for name, row in table.items() if row.of.pair == kind] for kind in KINDS}
    out = {}
    for name, (of, *_, phase, _) in table.items():
        (_, first), *_ = by_kind[of.pair]
        branch = by_kind[of.pair].index((name, phase))
        mate = by_kind["sun1_p" if of.pair in KINDS[:2] else "sun2_b"][branch][1]
        out[name] = tuple(round(float(phase - other) % 1.0, 9) % 1.0 for other in (first, mate))
    return out


def _bodies(pairs, n_planets, options):
    """Return the layout and the springs of all bodies."""
    density, bearing, zeta, hold, drive = options
    inner, outer, ahead = branch(pairs)
    gears = {
        "sun1": pairs["sun1_p"].gear_1, "sun2": pairs["sun2_b"].gear_1, "p": pairs["p_ring"].gear_1,
        "b": pairs["b_c"].gear_1, "c": pairs["c_ring"].gear_1,
    }  # fmt: skip
    members = {name: gear_member(gear, density, bearing) for name, gear in gears.items()}
    rings = [gear_member(pairs[kind].gear_2, density, bearing) for kind in ("p_ring", "c_ring")]
    radii = {"p": 1e-3 * pairs["sun1_p"].a, "b": 1e-3 * inner, "c": 1e-3 * outer}
    bodies = [Body(name, members[name].mass, members[name].inertia) for name in ("sun1", "sun2")]
    bodies.append(Body("ring", sum(r.mass for r in rings), sum(r.inertia for r in rings)))
    weights = {name: n_planets * members[name].mass for name in radii}
    bodies.append(Body("carrier", sum(weights.values()), sum(m * radii[name] ** 2 for name, m in weights.items())))
    bodies += [Body(f"{name}{i + 1}", members[name].mass, members[name].inertia) for name in radii for i in range(n_planets)]
    layout = Layout(bodies)
    plane, springs = {"x": bearing, "y": bearing}, []
    for name, torsion in (("sun1", hold), ("sun2", drive), ("ring", 0.0), ("carrier", 0.0)):
        springs += layout.springs(name, None, plane | {"theta": torsion}, zeta)
    for name, radius in radii.items():
        for i in range(n_planets):
            angle = 2 * math.pi * i / n_planets + (ahead if name == "c" else 0.0)
            arm = radius * outwards(angle)
            springs += layout.springs(f"{name}{i + 1}", "carrier", plane, zeta, arm)
    return layout, springs
