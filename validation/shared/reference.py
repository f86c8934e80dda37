"""Independent reference values of `reference.toml`, and computed values for them."""

import math
import tomllib

import numpy as np

import gearfe as gf
from gearfe.core.threads import own_warnings
from gearfe.dynamics.machine.member import Member
from gearfe.dynamics.machine.planetary import planetary
from gearfe.flexibility.energy.closed import textbook
from gearfe.flexibility.energy.closed.beam import load_angle
from gearfe.flexibility.hertz import half_plane, linear_hertz, weber_line
from gearfe.geometry.tooth.profile import flank

from .iso import theoretical_stiffness, virtual_teeth
from .places import SOURCES

STEEL = gf.Material(E=206e3, nu=0.3)
RACK = {"alpha_n": math.radians(20), "b": 1.0}


def load():
    """Return the tables of `reference.toml` by name."""
    tables = tomllib.loads((SOURCES / "reference.toml").read_text(encoding="utf-8"))
    return {name: entries[0] for name, entries in tables.items()}


def _root(z, **numbers):
    return gf.Gear(z=z, m_n=1.0, r_bore=0.05 * z, **RACK, **numbers).r_f


def tooth_deflection(row):
    """Return the deflection at the centre-line [um per N/mm]."""
    gear = gf.Gear(z=row["z"], m_n=1.0, r_bore=_root(row["z"]) / 1.4, **RACK)
    return gf.tooth_flexibility(gear, row["radius"], STEEL) * 1e3


def single_pair(row, table):
    """Return the single-pair stiffness with the source's local deformation [N/(mm um)]."""
    gears = [gf.Gear(z=z, m_n=1.0, r_bore=_root(z) - s, **RACK) for z, s in zip((17, 43), row["s_R"], strict=True)]
    teeth = sum(gf.tooth_flexibility(gear, gear.r, STEEL) for gear in gears)
    local = sum(math.log(2 * h / table["half_width"]) - STEEL.nu / (2 * (1 - STEEL.nu)) for h in table["depth"])
    return 1e-3 / (teeth + half_plane(STEEL) * local)


def root_stress(row):
    """Return the root stress over Ft/(b m) [-]."""
    numbers = {"x": row["x"], "rack_tip_radius": row["rack_tip_radius"]}
    gear = gf.Gear(z=row["z"], m_n=1.0, r_bore=0.2 * _root(row["z"], **numbers), **RACK, **numbers)
    return gf.root_stress(gear, math.hypot(*row["point"]), 1 / math.cos(gear.alpha_n), STEEL, half_width=0.05)


def healthy_pair(row):
    """Return pair and material of a row of ``healthy``."""
    rack = {"m_n": row["m_n"], "alpha_n": math.radians(20), "beta": math.radians(row["beta_deg"]), "b": 1.0}
    pair = gf.GearPair(*(gf.Gear(z=z, r_bore=bore, **rack) for z, bore in zip(row["z"], row["bores"], strict=True)))
    return pair, gf.Material(E=row["E"], nu=0.3)


def healthy(row, **options):
    """Return mean, maximum and minimum stiffness [N/(mm um)] without extended contact, at the middles of 32 equal parts."""
    pair, steel = healthy_pair(row)
    return _sizes(pair, row["line_load"], steel, **options)


def _sizes(pair, load, steel, **options):
    k = gf.mesh_stiffness(pair, load, steel, phases=(np.arange(32) + 0.5) / 32, extended=False, **options).k / 1e6
    return np.array([k.mean(), k.max(), k.min()])


def formulation(row, **options):
    """Return errors [%] of a closed form compared with finite elements, per pair of ``healthy``: single and double zone."""
    out = []
    for source in load()["healthy"]["rows"]:
        pair, steel = healthy_pair(source)
        run = {"phases": (np.arange(64) + 0.5) / 64, "extended": False}
        truth = gf.mesh_stiffness(pair, source["line_load"], steel, method="fe", **options, **run).zones()
        found = gf.mesh_stiffness(pair, source["line_load"], steel, method=row["method"], variants=row.get("variants"), **run)
        out.append([100 * (found.zones()[zone] / truth[zone] - 1) for zone in ("single", "double")])
    return np.array(out).T


def _ross_gear():
    """Return the gear of the beam code's example and its root half angle."""
    rho = 0.25 / (1 - math.sin(math.radians(20)))
    gear = gf.Gear(z=62, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=17.5, rack_tip_radius=rho)
    return gear, (math.pi / 2 + 2 * math.tan(gear.alpha_n) * (1 - rho) + 2 * rho / math.cos(gear.alpha_n)) / gear.z


def load_trend(line_load):
    """Return errors [%] of the beam code's single pair at the pitch point, compared with its composition and with `fe`.

    The composition is two teeth by finite elements at the centre-line, and Weber's local deflection down to it.
    """
    gear, theta_f = _ross_gear()
    pair = gf.GearPair(gear, gear)
    roll = np.array([gear.r_b * math.tan(gear.alpha_n)])
    beam = 2 * textbook.components(gear, STEEL, roll, lever="contact", theta_f=theta_f).total[0] + linear_hertz((STEEL, STEEL))
    radius, angle = flank(gear, roll)
    depth = radius * np.sin(angle) / np.cos(load_angle(gear, roll))
    local, _ = weber_line(line_load, (STEEL, STEEL), pair.relative_radius(roll, roll), (depth, depth))
    composed = 2 * gf.tooth_flexibility(gear, gear.r, STEEL) + local[0]
    run = {"phases": [pair.pitch_phase], "extended": False}
    whole = 1e-6 * gf.mesh_stiffness(pair, line_load * gear.b, STEEL, method="fe", **run).k[0] / gear.b
    return 100 * (composed / beam - 1), 100 * (1e-3 / beam / whole - 1)


def beam_code():
    """Return k, k_hertz [N/m] and contact ratio of the pair 62/62 of ross, with the conventions of ross."""
    gear, theta_f = _ross_gear()
    low, high = math.atan(gear.roll_f / gear.r_b), math.acos(gear.r_b / gear.r_a)
    eps_alpha = gf.GearPair(gear, gear).eps_alpha
    step = (high - low) / eps_alpha
    hertz, k = linear_hertz((STEEL, STEEL)), 0.0
    for first, second in ((low, high), (low + step, high - step)):
        rolls = gear.r_b * np.tan([first, second])
        teeth = textbook.components(gear, STEEL, rolls, lever="contact", theta_f=theta_f).total.sum()
        k += gear.b / (hertz + teeth) * 1e3
    return {"k": k, "k_hertz": gear.b / hertz * 1e3, "eps_alpha": eps_alpha}


def _iso_pair(**rack):
    """Return the pair of the ISO/TR example."""
    rack |= {"m_n": 8.0, "alpha_n": math.radians(20), "beta": math.radians(15.8), "b": 100.0}
    return gf.GearPair(gf.Gear(z=17, x=0.145, r_bore=20.0, **rack), gf.Gear(z=103, r_bore=60.0, **rack), 500.0)


def iso():
    """Return c'_th [N/(mm um)] and virtual tooth numbers of the ISO/TR example."""
    pair = _iso_pair()
    return {"c_th": theoretical_stiffness(pair), "z_n1": virtual_teeth(pair.gear_1), "z_n2": virtual_teeth(pair.gear_2)}


def ring_root_stress(row):
    """Return the root stress of a ring over Ft/(b m) [-], and its contact ratio with 17 teeth before trimming."""
    ring = gf.Gear(z=row["z"], m_n=1.0, r_rim=row["z"] / 2 + 12.0, rack_tip_radius=row["rack_tip_radius"], **RACK)
    stress = gf.root_stress(ring, math.hypot(*row["point"]), 1 / math.cos(ring.alpha_n), STEEL, half_width=0.05)
    with own_warnings():
        pair = gf.GearPair(gf.Gear(z=17, m_n=1.0, r_bore=4.0, **RACK), ring)
    return stress, pair.eps_alpha_of(pair.gear_1.roll_a, ring.roll_a)


def healthy_ring(method):
    """Return mean, maximum and minimum stiffness [N/(mm um)] of the 27/72 ring pair."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "beta": math.radians(16), "b": 1.0}
    with own_warnings():
        pair = gf.GearPair(gf.Gear(z=27, r_bore=12.0, **rack), gf.Gear(z=72, r_rim=90.0, **rack))
    return _sizes(pair, 150.0, gf.Material(E=207e3, nu=0.3), method=method)


def crack_reduction(row, method="ritz", **crack):
    """Return the largest reduction of k [-] by a pinion crack of the row's level."""
    table = load()["healthy"]["rows"]
    source = next(r for r in table if r["z"] == row["z"])
    pair, steel = healthy_pair(source)
    run = {"span": "tooth", "phases": 64, "extended": False, "method": method}
    whole = gf.mesh_stiffness(pair, source["line_load"], steel, **run).k
    damage = {"pinion": [gf.Crack(**({"level": row["level"]} | crack))]}
    return float((1 - gf.mesh_stiffness(pair, source["line_load"], steel, damage=damage, **run).k / whole).max())


def iso_mesh():
    """Return single and mesh stiffness of the ISO/TR example by ISO 6336-1 with rack D and solid discs [N/(mm um)]."""
    pair = _iso_pair(dedendum=1.4, rack_tip_radius=0.25)
    basic_rack = 1 + 0.5 * (1.2 - pair.gear_1.dedendum)
    single = theoretical_stiffness(pair) * 0.8 * basic_rack * math.cos(pair.gear_1.beta)
    mesh = single * (0.75 * pair.eps_alpha + 0.25)
    return {"c_prime": single, "c_gamma_alpha": mesh, "c_gamma_beta": 0.85 * mesh}


def lin_parker(n=3, k_ru=1e9):
    """Return the planetary stage of Lin and Parker's Table 1."""

    def member(mass, inertia, diameter, turn=0.0):
        r = diameter / 2e3
        return Member(mass, inertia * r**2, 1e8, r, turn * r**2)

    sun, planet, ring = member(0.4, 0.39, 77.4), member(0.66, 0.61, 100.3), member(2.35, 3.0, 275.0, k_ru)
    both = {"sun_planet": 5e8, "planet_ring": 5e8}
    carrier = member(5.43, 6.29, 176.8)
    return planetary(sun, planet, ring, carrier, n_planets=n, alpha=(math.radians(24.6),) * 2, stiffness=both)


def natural_frequencies():
    """Return natural frequencies of `lin_parker` [Hz], rotational then translational modes, by central body."""
    stage = lin_parker()
    values, modes = gf.natural_frequencies(stage)
    places = [stage.dofs.index(f"{body}.{axis}") for body in ("sun", "ring", "carrier") for axis in "xy"]
    moved = np.abs(modes[places]).max(axis=0) > 1e-6 * np.abs(modes).max(axis=0)
    return [*values[~moved], *values[moved][::2]]


def stage(table):
    """Return f_m, fault frequencies of sun and planet, carrier frequency [Hz] and contact ratios of a stage in the tables."""
    teeth, module, rpm, a = {
        "stage_17_37_91": ((17, 37, 91), 5.0, 800, None),
        "stage_21_31_84": ((21, 31, 84), 1.5, 600, 39.750056),
    }[table]
    rack = {"m_n": module, "alpha_n": math.radians(20), "b": 10.0}
    sun, planet = (gf.Gear(z=z, r_bore=0.15 * module * z, **rack) for z in teeth[:2])
    ring = gf.Gear(z=teeth[2], r_rim=module * (teeth[2] / 2 + 5), rack_tip_radius=0.2, **rack)
    with own_warnings():
        outer, inner = gf.GearPair(sun, planet, a), gf.GearPair(planet, ring, a)
    carrier = rpm / 60 * teeth[0] / (teeth[0] + teeth[2])
    mesh = carrier * teeth[2]
    ring_ratio = inner.eps_alpha_of(planet.roll_a, ring.roll_a)  # contact ratio before trimming of the ring's tip
    return mesh, 3 * mesh / teeth[0], mesh / teeth[1], carrier, outer.eps_alpha, ring_ratio
