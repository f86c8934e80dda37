"""Helical machines as tables: the pitted helical pair, and the herringbone planetary stage with its relief groove."""

import math

import numpy as np

from .contact_cycle import ellipse_loss, line_cycle
from .contact_law import hertz_coefficient
from .gear_mesh import Mesh, ToothDamage
from .layout import SPACE, Body, Layout
from .stages import damages, disc, gear_pair, stage_phases
from .tables import Load, Machine, Spring

HALVES = {"L": -1, "R": 1}


def pitted_helical(
    pair, materials, *, pits=(), speed=2500 * math.pi / 30, torque=250.0, damping=1e3, depth=1e-4, support=None, drive=1e4,
    density=7840.0, zeta=0.02, backlash=1e-4,
):  # fmt: skip
    """The helical pair with pitted pinion teeth: impact law, load shared by the lengths of the contact lines.

    8 degrees of freedom: x, y, z and theta of both gears.

    Parameters
    ----------
    pair : GearPair
        The article has 17/60, m_n 2.1 mm, 17.5 and 29 degrees, widths 19.8 and 16.9 mm.
    materials : (Material, Material)
        For the coefficient of the impact law at the pitch point.
    pits : sequence of (int, sequence of (float, float, float, float))
        Pinion teeth and their pits, as `gearfe.machine.contact_cycle.ellipse_loss` takes them, or instead of pits a function of
        the phase (`gearfe.machine.impact.pits_loss`); where the pits are is not in the article.
    speed, torque : float
        Of the pinion [rad/s], [N m]: 2500 rpm; that 250 N m act on the pinion is assumed.
    damping, depth : float
        Largest damping of the impact law [N s/m], assumed 1e3, and the penetration from which it is full [m], 0.1 mm.
    support : dict, optional
        Bearings of both gears by direction, assumed 1e8 N/m in x, y and z.
    drive : float
        Torsional stiffness of the shafts to motor and brake [N m/rad], assumed 1e4 at the pinion, none at the wheel.
    density, zeta, backlash : float
        [kg/m3]; damping ratio of supports, assumed 0.02; play along the line of action [m], assumed 0.1 mm.
    """
    width = min(pair.gear_1.b, pair.gear_2.b)
    radii = pair.curvature_radii(pair.pitch_phase)
    helix = math.cos(pair.gear_1.beta_b)  # radii of curvature across the contact line
    coefficient = hertz_coefficient(float(radii[0]) / helix, float(radii[1]) / helix, materials) / helix**2.5
    bodies = []
    for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2)):
        made = disc(gear, density, 0.0)
        bodies.append(Body(name, made.mass, made.inertia, "x y z theta"))
    damage = tuple(
        ToothDamage(0, tooth, line_cycle(pair, coefficient, lost=lost, width=width))
        for tooth, lost in ((n, own if callable(own) else ellipse_loss(pair, own, width=width)) for n, own in pits)
    )
    return gear_pair(
        pair,
        bodies,
        line_cycle(pair, coefficient, width=width),
        speed=speed,
        torque=torque,
        support={"x": 1e8, "y": 1e8, "z": 1e8} if support is None else support,
        torsion=(drive, 0.0),
        zeta=zeta,
        damage=damage,
        power=1.5,
        push=True,
        damping=damping,
        depth=depth,
        backlash=backlash,
    )


MEMBERS = {"sun": (1.49, 0.028), "planet": (2.86, 0.042), "ring": (3.24, 0.116), "carrier": (1.98, 0.15)}  # kg, kg m2, printed


def herringbone_planetary(
    stage, stiffness, *, damage=None, speed=2000 * math.pi / 30, torque=400.0, members=None, bearing=1e8, tilt=1e5, housing=1e9,
    drive=1e4, groove=20.0, shear_modulus=80e9, zeta=0.02, mesh_zeta=0.05, **mesh
):  # fmt: skip
    """Herringbone planetary stage: 6 degrees of freedom for each half of sun and planets and for the ring, one for the carrier.

    Sun input, ring held, carrier output; 55 degrees of freedom and 12 meshes with three planets. The rows are those of the
    transverse
    line of action with ``tan(beta_b)`` along the axis, opposite in both halves, and include the tilting that the axial force
    causes; the article prints ``sin(beta)`` and no tilting.

    Parameters
    ----------
    stage : PlanetarySet
        Helical gears with the width of *one half*.
    stiffness : dict
        ``{"sun_planet": ..., "planet_ring": ...}`` of one half (`gearfe.machine.contact_cycle.sliced`) [N/m].
    damage : dict, optional
        ``{"sun": (tooth, {"sun_planet": curve})}`` as in `gearfe.machine.stages.pitted_planetary`; in both halves.
    speed, torque : float
        Of the sun [rad/s], [N m]: the article has 2000 rpm and 400.
    members : dict, optional
        Masses and inertias of whole bodies; default: as printed (`MEMBERS`), though the inertias are far above those of the
        gears. Inertias across the axis are half of them (assumed).
    bearing, tilt : float
        Supports of each half of sun and planets [N/m], [N m/rad], assumed 1e8 and 1e5.
    housing : float
        Support of the ring [N/m], assumed 1e9; tilting and turning with it times its squared base radius.
    drive : float
        Torsional stiffness between motor and sun [N m/rad], assumed 1e4 (half of it at each half).
    groove : float
        Width of the relief groove [mm], assumed 20: the halves are joined by a hollow shaft from bore to root circle.
    shear_modulus : float
        Of it [Pa]; Young's modulus is 2.6 times it.
    zeta, mesh_zeta : float
        Damping ratios of supports and meshes, assumed 0.02 and 0.05.
    **mesh
        Further fields of every `Mesh` (``backlash``: half of the article's dead zone lies on either side of 0 there).
    """
    outer, inner, n = stage.sun_planet, stage.planet_ring, stage.n_planets
    sun, planet, ring = outer.gear_1, outer.gear_2, inner.gear_2
    frequency = speed * ring.z / (sun.z + ring.z) * sun.z / (2 * math.pi)
    layout, apart = _halves(stage, members or MEMBERS), 5e-4 * (sun.b + groove)
    springs = _supports(layout, stage, (bearing, tilt, housing, drive, zeta))
    for name, gear in (("sun", sun), *((f"planet{i + 1}", planet) for i in range(n))):
        springs += _neck(layout, name, gear, (groove, shear_modulus, apart, zeta))
    meshes, helix = [], math.tan(abs(sun.beta_b))
    angles = dict(zip(range(1, n + 1), 2 * math.pi * np.arange(n) / n, strict=True))
    for name, fields in stage_phases((outer, inner), n, frequency=frequency).items():
        kind, i = name[:-1] if n < 10 else name.rstrip("0123456789"), int(name.rpartition(name.rstrip("0123456789"))[2])
        inside = kind == "planet_ring"
        pair = inner if inside else outer
        found = damages(name, damage)
        for half, hand in HALVES.items():
            one, two = (f"planet{i}{half}", "ring") if inside else (f"sun{half}", f"planet{i}{half}")
            place = {"angle": angles[i], "alpha": pair.alpha_w, "radii": (1e-3 * pair.gear_1.r_b, 1e-3 * pair.gear_2.r_b)}
            # a planet's flanks are parallel: what pushes it along the axis in one mesh it passes on in the other
            place |= {"sense": -1 if inside else 1, "internal": inside, "helix": hand * helix}
            row = layout.mesh(one, two, **place)
            if inside:
                row = row + _offset(layout, row, hand * apart, "ring")
            options = {"zeta": mesh_zeta} | fields | {"damage": found} | mesh
            meshes.append(Mesh(f"{name}{half}", row, stiffness[kind], **options))
    loads = [Load(f"sun{half} torque", layout.unit(f"sun{half}", "theta"), torque / 2) for half in HALVES]
    loads.append(Load("carrier torque", layout.unit("carrier", "theta"), -torque * (1 + ring.z / sun.z)))
    notes = {
        "mesh frequency [Hz]": frequency,
        "fault frequency of a sun tooth [Hz]": n * frequency / sun.z,
        "carrier frequency [Hz]": speed / (1 + ring.z / sun.z) / (2 * math.pi),
        "phases": {mesh.name: mesh.phase for mesh in meshes},
        "overlap ratio of one half": outer.eps_beta_of(sun.b),
    }
    return Machine(layout.dofs, layout.mass, tuple(springs), tuple(meshes), tuple(loads), notes)


def _halves(stage, members):
    names = ["sun", *(f"planet{i + 1}" for i in range(stage.n_planets))]
    bodies = []
    for name in names:
        mass, inertia = (value / 2 for value in members[name.rstrip("0123456789")])
        bodies += [Body(f"{name}{half}", mass, inertia, SPACE, inertia / 2) for half in HALVES]
    mass, inertia = members["ring"]
    bodies.append(Body("ring", mass, inertia, SPACE, inertia / 2))
    bodies.append(Body("carrier", *members["carrier"], "theta"))
    return Layout(bodies)


def _supports(layout, stage, options):
    """Springs of sun, planets and ring to ground or carrier."""
    bearing, tilt, housing, drive, zeta = options
    moves = dict.fromkeys("xyz", bearing) | {"tilt_x": tilt, "tilt_y": tilt}
    out = []
    for half in HALVES:
        out += layout.springs(f"sun{half}", None, moves | {"theta": drive / 2}, zeta)
        for i in range(stage.n_planets):
            angle = 2 * math.pi * i / stage.n_planets
            arm = 1e-3 * stage.a * np.array([math.cos(angle), math.sin(angle)])
            out += layout.springs(f"planet{i + 1}{half}", "carrier", moves, zeta, arm)
    turn = housing * (1e-3 * stage.ring.r_b) ** 2
    return out + layout.springs("ring", None, dict.fromkeys("xyz", housing) | dict.fromkeys(SPACE.split()[3:], turn), zeta)


def _neck(layout, name, gear, options):
    """Springs of the hollow shaft under the relief groove, between the faces of both halves."""
    width, G, apart, zeta = options
    outer, inner, length = 1e-3 * gear.r_f, 1e-3 * gear.r_bore, 1e-3 * width
    area, second = math.pi * (outer**2 - inner**2), math.pi / 4 * (outer**4 - inner**4)
    bend = 2.6 * G * second / length
    sizes = {"x": 0.9 * G * area / length, "z": 2.6 * G * area / length, "tilt_x": bend, "theta": 2 * G * second / length}
    sizes |= {"y": sizes["x"], "tilt_y": bend}
    axes, out = dict(zip("xyz", np.eye(3), strict=True)), []
    for dof, k in sizes.items():
        if dof in axes:
            row = layout.point(f"{name}L", axes[dof], (0, 0, apart)) - layout.point(f"{name}R", axes[dof], (0, 0, -apart))
        else:
            row = layout.unit(f"{name}L", dof) - layout.unit(f"{name}R", dof)
        out.append(Spring(f"{name} groove {dof}", row, k, 2 * zeta * math.sqrt(k / (row**2 / layout.mass).sum())))
    return out


def _offset(layout, row, z, name):
    """What a row gains if its forces act on body `name` at height `z` [m] over its centre."""
    out = np.zeros_like(row)
    out[layout.place[f"{name}.tilt_x"]] = -z * row[layout.place[f"{name}.y"]]
    out[layout.place[f"{name}.tilt_y"]] = z * row[layout.place[f"{name}.x"]]
    return out
