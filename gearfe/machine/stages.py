"""Machines as tables: gear pairs, and a planetary stage with any number of planets.

What a source leaves out is an argument with a default, named in the docstring as an assumption. Stiffnesses are given by mesh
name as anything `gearfe.machine.gear_mesh.Mesh` takes; damage by mesh name as tuples of `gearfe.machine.gear_mesh.ToothDamage`.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .contact_cycle import friction_weights
from .gear_mesh import Mesh
from .layout import Body, Layout, around, through
from .tables import Load, Machine


def single_mesh(mass, stiffness, frequency, *, force=0.0, **mesh):
    """One mass on one mesh: a gear pair along its line of action, ``m x'' + c x' + k(t) f(x - e(t)) = F``.

    Parameters
    ----------
    mass : float
        Equivalent mass [kg], ``1 / (r_b1**2 / I_1 + r_b2**2 / I_2)``.
    stiffness
        Over one cycle [N/m].
    frequency : float
        Of the mesh [Hz].
    force : float, (ndarray, ndarray) or callable
        Force transmitted [N].
    **mesh
        Further fields of `Mesh` (``damping``, ``zeta``, ``backlash``, ``error``, ``damage``...).
    """
    row = np.ones(1)
    return Machine(
        ("pair.x",), np.array([mass]), (), (Mesh("mesh", row, stiffness, frequency, **mesh),), (Load("force", row, force),)
    )


def gear_pair(pair, bodies, stiffness, *, speed, torque, support, torsion=(0.0, 0.0), zeta=0.02, helix=None, damage=(), **mesh):
    """Two gears on elastic shafts: 6 degrees of freedom (x, y, theta each), more if the bodies have more.

    Gear 1 drives counter-clockwise; gear 2 stands on the x axis.

    Parameters
    ----------
    pair : GearPair
    bodies : (Body, Body)
        Of the two gears, names and directions included.
    stiffness
        Of the mesh along its transverse line of action [N/m^power].
    speed : float
        Of gear 1 [rad/s].
    torque : float, (ndarray, ndarray) or callable
        On gear 1 [N m]; gear 2 carries it times the ratio of the base radii.
    support : dict
        Stiffness of both bearings by direction, ``{"x": k, "y": k, ...}`` [N/m, N m/rad].
    torsion : (float, float)
        Of the shafts to drive and load [N m/rad]; 0: free.
    zeta : float
        Damping ratio of the supports.
    helix : float, optional
        ``tan(beta_b)`` with the sign of the axial force on gear 2; default: from the gears, pushing it along +z.
    damage : tuple of ToothDamage
    **mesh
        Further fields of `Mesh`.
    """
    layout, (one, two) = Layout(bodies), bodies
    radii = 1e-3 * pair.gear_1.r_b, 1e-3 * pair.gear_2.r_b
    place = {"angle": 0.0, "alpha": pair.alpha_w, "radii": radii, "internal": pair.gear_2.internal}
    row = layout.mesh(one.name, two.name, helix=math.tan(abs(pair.gear_1.beta_b)) if helix is None else helix, **place)
    frequency = abs(speed) * pair.gear_1.z / (2 * math.pi)
    springs = [s for body in bodies for s in layout.springs(body.name, None, support, zeta)]
    for body, k in zip(bodies, torsion, strict=True):
        springs += layout.springs(body.name, None, {"theta": k}, zeta)
    made = Mesh("mesh", row, stiffness, frequency, teeth=(pair.gear_1.z, pair.gear_2.z), damage=damage, **mesh)
    loads = (
        Load("drive", layout.unit(one.name, "theta"), torque),
        Load("load", row[layout.place[f"{two.name}.theta"]] / radii[0] * layout.unit(two.name, "theta"), torque),
    )
    notes = {
        "mesh frequency [Hz]": frequency,
        "turning frequencies [Hz]": tuple(frequency / g.z for g in (pair.gear_1, pair.gear_2)),
    }
    return Machine(layout.dofs, layout.mass, tuple(springs), (made,), loads, notes)


@dataclass(frozen=True, slots=True)
class Member:
    """A central member or a planet of a stage: its mass, inertia and springs to the ground, a planet's to the carrier.

    Attributes
    ----------
    mass, inertia : float
        [kg], [kg m2]
    bearing : float
        In x and y [N/m].
    torsion : float
        To the ground [N m/rad].
    r_b : float
        Base radius [m]; of the carrier: the radius to the planets' axes.
    """

    mass: float
    inertia: float
    bearing: float
    r_b: float
    torsion: float = 0.0


def planetary(sun, planet, ring, carrier, *, n_planets, alpha, stiffness, mesh=None, loads=None, zeta=0.0, places=None):
    """A planetary stage in its plane, 3 degrees of freedom per body, seen from the carrier, without gyroscopic terms.

    The model of J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, in coordinates that do not turn with the planets; for
    its frequencies see ``tests/machine/test_models.py``.

    Parameters
    ----------
    sun, planet, ring, carrier : Member
    n_planets : int
    alpha : (float, float)
        Working pressure angles sun-planet and planet-ring [rad].
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}`` along the line of action [N/m].
    mesh : callable, optional
        ``mesh(kind, i) -> dict`` of further fields of `Mesh` for planet i.
    loads : dict, optional
        Torques ``{"sun": ..., "ring": ..., "carrier": ...}`` [N m]: numbers, histories or functions.
    zeta : float
        Damping ratio of the supports.
    places : sequence of float, optional
        Angles of the planets [rad]; default: equal spacing from 0.
    """
    names = [f"planet{i + 1}" for i in range(n_planets)]
    angles = 2 * math.pi * np.arange(n_planets) / n_planets if places is None else np.asarray(places, dtype=float)
    central = {"sun": sun, "ring": ring, "carrier": carrier}
    bodies = [Body(name, m.mass, m.inertia) for name, m in central.items()] + [
        Body(n, planet.mass, planet.inertia) for n in names
    ]
    layout, springs, meshes = Layout(bodies), [], []
    for name, m in central.items():
        springs += layout.springs(name, None, {"x": m.bearing, "y": m.bearing, "theta": m.torsion}, zeta)
    for i, (name, angle) in enumerate(zip(names, angles, strict=True)):
        arm = carrier.r_b * np.array([math.cos(angle), math.sin(angle)])
        springs += layout.springs(name, "carrier", {"x": planet.bearing, "y": planet.bearing}, zeta, arm)
        for kind, one, two, r, sense, inside in (
            ("sun_planet", "sun", name, (sun.r_b, planet.r_b), 1, False),
            ("planet_ring", name, "ring", (planet.r_b, ring.r_b), -1, True),
        ):
            own = layout.mesh(one, two, angle=angle, alpha=alpha[inside], radii=r, sense=sense, internal=inside)
            meshes.append(Mesh(f"{kind}{i + 1}", own, stiffness[kind], **({} if mesh is None else mesh(kind, i))))
    torques = tuple(Load(f"{name} torque", layout.unit(name, "theta"), value) for name, value in (loads or {}).items())
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), torques)


def stage_phases(pairs, n_planets, *, start=0.0, frequency=1.0, places=None):
    """Running phases and first teeth of the meshes of a simple stage whose sun drives counter-clockwise.

    Parameters
    ----------
    pairs : (GearPair, GearPair)
        Sun-planet and planet-ring.
    n_planets : int
    start : float
        Phase of the first sun-planet mesh at t = 0.
    frequency : float
        Of all meshes [Hz].
    places : sequence of float, optional
        Angles of the planets [rad].

    Returns
    -------
    dict
        By mesh name: fields of `Mesh` (``frequency, phase, teeth, first``). Sun teeth are numbered in the order in which they
        enter at planet 1, the teeth of each planet in the order they meet the sun from the pair of sun tooth 0 on, ring teeth
        as planet 1 meets them.
    """
    outer, inner = pairs
    sun, planet, ring = outer.gear_1, outer.gear_2, inner.gear_2
    out, angles = {}, 2 * math.pi * np.arange(n_planets) / n_planets if places is None else places
    for i, angle in enumerate(angles):
        phase = around(start, sun.z, 1, angle)
        ahead = (sun.z + ring.z) * angle / (2 * math.pi)
        if abs(ahead - round(ahead)) > 1e-9:
            raise ValueError(
                f"planet {i + 1} at {math.degrees(angle):.4g} degrees cannot be assembled: (z_s + z_r) / turn is not whole"
            )
        out[f"sun_planet{i + 1}"] = {"phase": phase, "teeth": (sun.z, planet.z)}
        passed = through(phase, outer, inner, -1, -math.pi)
        out[f"planet_ring{i + 1}"] = {"phase": passed, "teeth": (planet.z, ring.z), "first": (0, round(ahead))}
    return {name: fields | {"frequency": frequency} for name, fields in out.items()}


def pitted_planetary(
    stage, stiffness, *, damage=None, speed=1000 * math.pi / 30, torque=100.0, carrier_torque=None, bearing=1e8, drive=1e4,
    density=7800.0, zeta=0.02, friction=None, **mesh
):  # fmt: skip
    """The planetary gearbox with pitted sun teeth (articles on 21/31/84): sun drives, ring held, load on the carrier.

    Parameters
    ----------
    stage : PlanetarySet
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}``: mesh stiffnesses [N/m], or with ``power=1.5, backlash=...`` coefficients of
        the impact law [N/m^1.5] (`gearfe.machine.contact_cycle.impact_cycle`).
    damage : dict, optional
        By gear: ``{"sun": (tooth, {"sun_planet": curve})}``, planets as ``"planet1"`` with curves for both meshes, ``"ring"``.
    speed : float
        Of the sun [rad/s]; the articles have 1000 rpm.
    torque : float
        Of the sun [N m], assumed 100.
    carrier_torque : number, history or function, optional
        Load against the carrier's rotation [N m] (`gearfe.machine.tables.pulses`); default: steady, in balance with `torque`.
    bearing : float
        Of every body in x and y [N/m], assumed 1e8.
    drive : float
        Torsional stiffness that holds the sun to its motor and the ring to the housing (a hundred times as much) [N m/rad],
        assumed 1e4: the articles prescribe the sun's speed.
    density : float
        [kg/m3]; masses are those of rings from bore to reference circle (rim to reference circle), the carrier's that of
        all planets together (assumed).
    zeta : float
        Damping ratio of supports, assumed 0.02.
    friction : dict, optional
        ``static, dynamic, v_static, v_dynamic`` of Coulomb friction at the sun's meshes (0.08, 0.05, 1e-4, 1e-2 m/s).
    **mesh
        Further fields of every `Mesh`: for the impact law ``power=1.5, push=True, depth=1e-4, damping=..., backlash=...``.
    """
    outer, inner, n = stage.sun_planet, stage.planet_ring, stage.n_planets
    sun, planet, ring = outer.gear_1, outer.gear_2, inner.gear_2
    turn = speed * sun.z / (sun.z + ring.z)
    frequency = (speed - turn) * sun.z / (2 * math.pi)
    phases = stage_phases((outer, inner), n, frequency=frequency)
    phases = {name: fields | {"damage": damages(name, damage)} for name, fields in phases.items()}
    member = {name: disc(gear, density, bearing) for name, gear in (("sun", sun), ("planet", planet), ("ring", ring))}
    together, a = n * member["planet"].mass, 1e-3 * stage.a
    member["carrier"] = Member(together, together * a**2, bearing, a)
    member["sun"], member["ring"] = replace(member["sun"], torsion=drive), replace(member["ring"], torsion=100 * drive)
    balance = torque * (1 + ring.z / sun.z)
    load = balance if carrier_torque is None else carrier_torque
    machine = planetary(
        *(member[name] for name in ("sun", "planet", "ring", "carrier")),
        n_planets=n,
        alpha=(outer.alpha_w, inner.alpha_w),
        stiffness=stiffness,
        mesh=lambda kind, i: phases[f"{kind}{i + 1}"] | mesh,
        loads={"sun": torque, "carrier": _against(load)},
        zeta=zeta,
    )
    notes = {
        "mesh frequency [Hz]": frequency,
        "fault frequency of a sun tooth [Hz]": n * frequency / sun.z,
        "carrier frequency [Hz]": turn / (2 * math.pi),
        "phases": {name: fields["phase"] for name, fields in phases.items()},
    }
    machine = replace(machine, notes=notes)
    return (
        machine if friction is None else _rubbed(machine, outer, (speed - turn, -(speed - turn) * sun.z / planet.z), friction, n)
    )


def damages(mesh, damage):
    """Damage of a mesh ``sun_planet1`` or ``planet_ring1`` from damage by gear (see `pitted_planetary`)."""
    from .gear_mesh import ToothDamage

    kind, number = mesh.rstrip("0123456789"), mesh[len(mesh.rstrip("0123456789")) :]
    names = [gear + (number if gear == "planet" else "") for gear in kind.split("_")]
    found = ((body, *(damage or {}).get(name, (0, {}))) for body, name in enumerate(names))
    return tuple(ToothDamage(body, tooth, curves[kind]) for body, tooth, curves in found if kind in curves)


def disc(gear, density, bearing, *, width=None):
    """`Member` of a gear as a ring from its bore (or rim) to its reference circle; `width` in mm, default the gear's."""
    low, high = sorted((gear.r_rim if gear.internal else gear.r_bore, gear.z * gear.m_n / (2 * math.cos(gear.beta))))
    mass = density * math.pi * (high**2 - low**2) * (width or gear.b) * 1e-9
    return Member(mass, mass * (low**2 + high**2) / 2 * 1e-6, bearing, 1e-3 * gear.r_b)


def _against(value):
    if callable(value):
        return lambda t: -value(t)
    return -value if np.ndim(value) == 0 else (value[0], -np.asarray(value[1]))


def _rubbed(machine, pair, speeds, friction, n):
    """The machine with Coulomb friction at its sun-planet meshes."""
    layout = Layout([Body(name, 1.0, 1.0) for name in dict.fromkeys(dof.partition(".")[0] for dof in machine.dofs)])
    weights = friction_weights(pair, speeds, **friction)
    meshes = {mesh.name: mesh for mesh in machine.meshes}
    for i in range(n):
        rows = layout.rubbing("sun", f"planet{i + 1}", angle=2 * math.pi * i / n, alpha=pair.alpha_w)
        name = f"sun_planet{i + 1}"
        meshes[name] = replace(meshes[name], friction=tuple(zip(rows, weights, strict=True)))
    return replace(machine, meshes=tuple(meshes.values()))
