"""The independent reference values of `reference.toml`, and gearfe's own numbers for them."""

import math
import tomllib
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.energy import textbook
from gearfe.hertz import half_plane, linear_hertz
from gearfe.iso import theoretical_stiffness, virtual_teeth

STEEL = gf.Material(E=206e3, nu=0.3)
RACK = {"alpha_n": math.radians(20), "b": 1.0}


def load():
    """Tables of `reference.toml` by name."""
    tables = tomllib.loads((Path(__file__).parent / "reference.toml").read_text(encoding="utf-8"))
    return {name: entries[0] for name, entries in tables.items()}


def _root(z, **numbers):
    return gf.Gear(z=z, m_n=1.0, r_bore=0.05 * z, **RACK, **numbers).r_f


def tooth_deflection(row):
    """Deflection at the centre-line [um per N/mm]."""
    gear = gf.Gear(z=row["z"], m_n=1.0, r_bore=_root(row["z"]) / 1.4, **RACK)
    return gf.tooth_flexibility(gear, row["radius"], STEEL) * 1e3


def single_pair(row, table):
    """Single-pair stiffness with the source's local deformation [N/(mm um)]."""
    gears = [gf.Gear(z=z, m_n=1.0, r_bore=_root(z) - s, **RACK) for z, s in zip((17, 43), row["s_R"], strict=True)]
    teeth = sum(gf.tooth_flexibility(gear, gear.r, STEEL) for gear in gears)
    local = sum(math.log(2 * h / table["half_width"]) - STEEL.nu / (2 * (1 - STEEL.nu)) for h in table["depth"])
    return 1e-3 / (teeth + half_plane(STEEL) * local)


def root_stress(row):
    """Root stress over Ft/(b m) [-]."""
    numbers = {"x": row["x"], "tip_radius": row["tip_radius"]}
    gear = gf.Gear(z=row["z"], m_n=1.0, r_bore=0.2 * _root(row["z"], **numbers), **RACK, **numbers)
    return gf.root_stress(gear, math.hypot(*row["point"]), 1 / math.cos(gear.alpha_n), STEEL, half_width=0.05)


def healthy(row, *, phases=None, teeth=None):
    """Mean, max, min stiffness [N/(mm um)] without extended contact; phases in the middle of 32 equal parts."""
    rack = {"m_n": row["m_n"], "alpha_n": math.radians(20), "beta": math.radians(row["beta_deg"]), "b": 1.0}
    pair = gf.GearPair(*(gf.Gear(z=z, r_bore=bore, **rack) for z, bore in zip(row["z"], row["bores"], strict=True)))
    phases = (np.arange(32) + 0.5) / 32 if phases is None else phases
    steel = gf.Material(E=row["E"], nu=0.3)
    k = gf.mesh_stiffness(pair, row["line_load"], steel, phases=phases, extended=False, teeth=teeth).k / 1e6
    return np.array([k.mean(), k.max(), k.min()])


def beam_code():
    """The ross 62/62 numbers, with its conventions: k, k_hertz [N/m], contact ratio."""
    sin = math.sin(math.radians(20))
    rho = 0.25 / (1 - sin)
    gear = gf.Gear(z=62, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=17.5, tip_radius=rho)
    theta_f = (math.pi / 2 + 2 * math.tan(gear.alpha_n) * (1 - rho) + 2 * rho / math.cos(gear.alpha_n)) / gear.z
    low, high = math.atan(gear.roll_f / gear.r_b), math.acos(gear.r_b / gear.r_a)
    eps_alpha = gf.GearPair(gear, gear).eps_alpha
    step = (high - low) / eps_alpha
    hertz, k = linear_hertz((STEEL, STEEL)), 0.0
    for first, second in ((low, high), (low + step, high - step)):
        rolls = gear.r_b * np.tan([first, second])
        teeth = textbook.components(gear, STEEL, rolls, lever="contact", theta_f=theta_f).total.sum()
        k += gear.b / (hertz + teeth) * 1e3
    return {"k": k, "k_hertz": gear.b / hertz * 1e3, "eps_alpha": eps_alpha}


def iso():
    """c'_th [N/(mm um)] and virtual tooth numbers of the ISO/TR example."""
    rack = {"m_n": 8.0, "alpha_n": math.radians(20), "beta": math.radians(15.8), "b": 100.0}
    pair = gf.GearPair(gf.Gear(z=17, x=0.145, r_bore=20.0, **rack), gf.Gear(z=103, r_bore=60.0, **rack), 500.0)
    return {"c_th": theoretical_stiffness(pair), "z_n1": virtual_teeth(pair.gear_1), "z_n2": virtual_teeth(pair.gear_2)}
