"""The two-stage compound planetary gearbox with meshed planets, shared ring and shared carrier, as a table."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...geometry.pair.gear_pair import GearPair
from .gear_mesh import GearMesh, Stiffness
from .layout import Body, Layout, around, through
from .member import disc
from .planetary import teeth_damaged
from .scene_curves import Meshed, scene_curves, speed_of
from .tables import Load, Machine, Stage

SCENE_PAIRS = {  # by kind of mesh (b inner, c outer planet of stage 2), the pair of a scene
    "sun1_p": "sun_planet",
    "p_ring": "planet_ring_1",
    "sun2_b": "sun_planet",
    "b_c": "planet_planet",
    "c_ring": "planet_ring_2",
}
KINDS = tuple(SCENE_PAIRS)
HOMES = {  # by pair of a scene, the bodies whose teeth damage is in unless it names another
    "sun_planet": ("sun2", "b1"),
    "planet_planet": ("b1", "c1"),
    "planet_ring_1": ("p1", "ring"),
    "planet_ring_2": ("c1", "ring"),
}


def scene_compound(scene, case, **options):
    """Machine of a scene: the stiffness curves of its pairs."""
    pairs, n = scene_pairs(scene), scene.machine["n_planets"]
    meshes = {name: mesh._replace(pair=SCENE_PAIRS[mesh.pair]) for name, mesh in _meshes(compound_table(pairs, n)).items()}
    found = scene_curves(scene, case, options, meshes, HOMES)
    healthy = {kind: found.healthy[name] for kind, name in SCENE_PAIRS.items()}
    settings = {"speed": speed_of(scene), "torque": scene.machine["torque_Nm"], "n_planets": n}
    made = compound_planetary(healthy, pairs=pairs, damage=found.damage, **settings)
    return replace(made, faults=found.faults(made))


def _meshes(table):
    """`Meshed` of the meshes of a `compound_table`; planets are called ``p1``, ``b1``, ``c1`` and so on."""
    return {name: Meshed(kind, bodies, fields["first"]) for name, (kind, bodies, _, fields) in table.items()}


def scene_pairs(scene):
    """GearPairs of a scene by kind of mesh."""
    return {kind: scene.pair(name).pair for kind, name in SCENE_PAIRS.items()}


def carrier_speed(pairs, speed):
    """Speed of the carrier for sun 2 at `speed` and sun 1 standing (any unit): both stages drive one ring.

    ``(n_2 - n_c) z_s2 / z_r2 = n_c z_s1 / z_r1`` (both are the ring's speed relative to the carrier).
    """
    ratio_1 = pairs["sun1_p"].gear_1.z / pairs["p_ring"].gear_2.z
    ratio_2 = pairs["sun2_b"].gear_1.z / pairs["c_ring"].gear_2.z
    return speed * ratio_2 / (ratio_1 + ratio_2)


def branch(pairs):
    """Centre distances of inner and outer planets from the axis [mm] and the angle by which the outer is ahead [rad]."""
    inner, between, outer = pairs["sun2_b"].a, pairs["b_c"].a, pairs["c_ring"].a
    cosine = (inner**2 + outer**2 - between**2) / (2 * inner * outer)
    if not -1 < cosine < 1:
        raise ValueError(
            f"centre distances {inner:.6g}, {between:.6g}, {outer:.6g} mm make no triangle: sun, inner and outer planet"
        )
    return inner, outer, math.acos(cosine)


def compound_table(pairs, n_planets, rates=(1.0, 1.0)):
    """All meshes as rows ``name: (bodies, geometry, mesh)``.

    Parameters
    ----------
    pairs : dict of GearPair
    n_planets : int
    rates : (float, float)
        Signed mesh frequencies of both stages [Hz]; negative where gear 2 drives.

    Returns
    -------
    dict
        `geometry` are arguments of `machine.layout.Layout.mesh` and `mesh` fields of `machine.gear_mesh.GearMesh`:
        phases by `gearfe.dynamics.machine.layout.around` and `through`, 0 for the first mesh of each sun at t = 0.
    """
    inner, outer, ahead = branch(pairs)
    out = {}

    def add(kind, bodies, angle, sense, phase, rate):
        pair, first = pairs[kind], (0, 0)
        if bodies[1] == "ring":  # its teeth are numbered as branch 1 meets them
            base = next((row[3]["phase"] for row in out.values() if row[0] == kind), phase)
            first = (0, _whole(around(base, pair.gear_2.z, sense, 2 * math.pi * i / n_planets) - phase, kind))
        gear_1, gear_2 = pair.gear_1, pair.gear_2
        radii = 1e-3 * gear_1.r_b, 1e-3 * gear_2.r_b
        place = {"angle": angle, "alpha": pair.alpha_w, "radii": radii, "sense": sense, "internal": gear_2.internal}
        fields = {"frequency": rate, "phase": float(phase), "teeth": (gear_1.z, gear_2.z), "first": first}
        out["_".join(bodies)] = (kind, bodies, place, fields)

    for i, angle in enumerate(2 * math.pi * np.arange(n_planets) / n_planets):
        p, b, c = (f"{name}{i + 1}" for name in "pbc")
        start = around(0.0, pairs["sun1_p"].gear_1.z, 1, angle)
        passed = through(start, pairs["sun1_p"], pairs["p_ring"], -1, -math.pi)
        add("sun1_p", ("sun1", p), angle, 1, start, rates[0])
        add("p_ring", (p, "ring"), angle, -1, passed, rates[0])
        outward = angle + ahead
        along = _direction(inner, angle, outer, outward)  # from inner to outer planet
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
        raise ValueError(f"{kind} cannot be assembled with equally spaced planets: {value:.6g} ring teeth between two of them")
    return round(value)


def compound_planetary(
    stiffness: Mapping[str, Stiffness],
    *,
    pairs: Mapping[str, GearPair],
    damage: Mapping[str, Any] | None = None,
    speed: float = 700 * math.pi / 30,
    torque: float = 200.0,
    n_planets: int = 3,
    beta: float = 2e-6,
    zeta: float = 0.02,
    bearing: float = 1e8,
    hold: float = 1e6,
    drive: float = 1e4,
    density: float = 7800.0,
    **mesh: Any,
) -> Machine:
    """Two-stage compound planetary: sun 2 driven, sun 1 held, load on the carrier; 39 degrees of freedom (3 per body).

    Stage 2 pushes the ring forward and stage 1 holds it. In stage 1 the loaded flanks are those of a sun that drives forward;
    but it stands and the carrier leaves it behind, so that contacts run from their end to their start: its frequency is negative.

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
    beta : float
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
        positive, a mesh stiffness, `beta` or `zeta` is negative or not finite, `speed` or `torque` is not finite, the phases of a
        damaged tooth's curve do not rise, or a field of `GearMesh` is out of range.
    """
    turn = carrier_speed(pairs, speed)
    suns = pairs["sun1_p"].gear_1, pairs["sun2_b"].gear_1
    rates = -turn * suns[0].z / (2 * math.pi), (speed - turn) * suns[1].z / (2 * math.pi)
    table = compound_table(pairs, n_planets, rates)
    layout, springs = _bodies(pairs, n_planets, (density, bearing, zeta, hold, drive))
    meshes, hurt = [], teeth_damaged(damage, _meshes(table))
    for name, (kind, bodies, place, fields) in table.items():
        row = layout.mesh(*bodies, **place)
        meshes.append(GearMesh(name, row, stiffness[kind], damage=hurt[name], **({"beta": beta} | fields | mesh)))
    arms = [1e-3 * g.r_b for g in suns]
    rings = pairs["c_ring"].gear_2.r_b / pairs["p_ring"].gear_2.r_b  # force in stage 1 over that in stage 2
    driven = torque * arms[1] / (arms[1] + rings * arms[0])
    loads = Load("drive", layout.unit("sun2", "theta"), driven), Load("load", layout.unit("carrier", "theta"), -torque)
    phases = {name: fields["phase"] for name, (_, _, _, fields) in table.items()}
    notes = {
        "mesh frequencies [Hz]": tuple(abs(r) for r in rates),
        "fault frequencies of sun teeth [Hz]": tuple(n_planets * abs(r) / g.z for r, g in zip(rates, suns, strict=True)),
        "carrier frequency [Hz]": turn / (2 * math.pi),
        "phases": phases,
        "relative phases": relative_phases(table),
    }
    stages = tuple(
        Stage(
            f"stage {i + 1}", (f"sun{i + 1}",), (planet,), abs(rate), abs(rate) / gear.z, n_planets * abs(rate) / gear.z,
            turn / (2 * math.pi), returns,
        )
        for i, (planet, rate, gear, returns) in enumerate(zip(("p1", "b1"), rates, suns, _returns(table, rates), strict=True))
    )  # fmt: skip
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), loads, notes, stages)


def _returns(table, rates):
    """How often a tooth meshes [Hz], by body of both stages; a ring that both have is of the driven one."""
    out = [{}, {}]
    for kind, bodies, _, fields in table.values():
        stage = 0 if kind in KINDS[:2] else 1
        for body, z in zip(bodies, fields["teeth"], strict=True):
            central = body.startswith(("sun", "ring"))
            many = sum(body in row[1] and row[0] == kind for row in table.values()) if central else 1
            out[stage][body] = many * abs(rates[stage]) / z
    return out


def relative_phases(table):
    """Phases less whole cycles, each relative to the first mesh of its kind and to the sun's mesh of its branch, in cycles."""
    out = {}
    for name, (kind, _, _, fields) in table.items():
        first = next(f["phase"] for k, _, _, f in table.values() if k == kind)
        stage = "sun1_p" if kind in KINDS[:2] else "sun2_b"
        phases = [f["phase"] for k, _, _, f in table.values() if k == stage]
        mate = phases[[n for n, row in table.items() if row[0] == kind].index(name)]
        out[name] = tuple(round(float(fields["phase"] - other) % 1.0, 9) % 1.0 for other in (first, mate))
    return out


def _bodies(pairs, n_planets, options):
    """Layout and springs of all bodies."""
    density, bearing, zeta, hold, drive = options
    inner, outer, ahead = branch(pairs)
    discs = {kind: (disc(p.gear_1, density, bearing), disc(p.gear_2, density, bearing)) for kind, p in pairs.items()}
    members = {
        "sun1": discs["sun1_p"][0],
        "sun2": discs["sun2_b"][0],
        "p": discs["p_ring"][0],
        "b": discs["b_c"][0],
        "c": discs["c_ring"][0],
    }
    rings = discs["p_ring"][1], discs["c_ring"][1]
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
            arm = radius * np.array([math.cos(angle), math.sin(angle)])
            springs += layout.springs(f"{name}{i + 1}", "carrier", plane, zeta, arm)
    return layout, springs
