"""Pairs of the frozen page `pairs_three`: by the energy model, and by hexahedra of both whole gears on file."""

import csv
import math
import warnings

import numpy as np
from usual import STEEL

import gearfe as gf
from gearfe.geometry.damage.pit import pit_row
from validation.shared.places import TABLES

TABLE = TABLES / "pairs_three.csv"
LOAD = 100.0  # [N/mm]
PHASES = 12  # of a mesh cycle, over the whole engagement of the damaged tooth
MAIN, COARSE = 0.8, 0.55  # resolutions
CASES = ("healthy", "crack 30 %", "crack 60 %", "7 pits")
TWO = ("17/ring 42", "healthy")  # with both resolutions


def pairs():
    """Pairs by name: teeth, helix angle, width in modules; wheel or ring with its rim radius."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20)}
    ring = {"rack_tip_radius": 0.2, "addendum": 0.8}

    def made(one, two, degrees, b, **wheel):
        beta, rim = math.radians(degrees), wheel.get("r_rim")
        first = gf.Gear(z=one[0], r_bore=one[1], b=b, beta=beta, **rack)
        second = gf.Gear(z=two[0], b=b, beta=beta if rim else -beta, **wheel, **rack, **(ring if rim else {"r_bore": two[1]}))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a ring's trimmed tip
            return gf.GearPair(first, second)

    return {
        "12/20": ("30 degrees, b/m 5", made((12, 6.0), (20, 12.0), 30, 10.0)),
        "17/ring 42": ("10 degrees, b/m 5", made((17, 8.0), (42,), 10, 10.0, r_rim=54.0)),
    }


def damage(pair, case):
    """Damage of the pinion's tooth 0 in a case."""
    gear = pair.gear_1
    if case == "7 pits":
        radius = pair.pitch_radius_1
        size = {"axes": (0.4 * gear.m_n, min(0.5 * gear.m_n, gear.b / 20)), "depth": 0.05 * gear.m_n}
        return {"pinion": pit_row(7, 0.1 * gear.b, 0.9 * gear.b, radius=radius, **size)}
    return None if case == "healthy" else {"pinion": [gf.Crack(level=float(case.split()[1]) / 100)]}


def curve(pair, case, **options):
    """Stiffness curve over the engagement of tooth 0."""
    run = {"phases": PHASES, "span": "tooth", "damage": damage(pair, case), "extended": False}
    return gf.mesh_stiffness(pair, LOAD * pair.gear_1.b, STEEL, **(run | options))


def model_curve(pair, case):
    """Stiffness by the energy model, and a mask of phases that the hexahedra on file can judge.

    No load presses the faces of a crack together there, and the cracked tooth is on its path of contact: the hexahedra took teeth
    two away from it without the crack.
    """
    found = curve(pair, case, method="ritz3d")
    apart = ~np.isin(found.phase, found.meta.get("crack_closed_phases", ()))
    own = (found.phase >= 0) & (found.phase <= pair.eps_alpha + pair.eps_beta)
    return found.k, apart & own if case.startswith("crack") else apart


def wanted():
    """(pair, case, refine) of all runs, in order of importance."""
    return [(name, case, MAIN) for name in pairs() for case in CASES] + [(*TWO, COARSE)]


def stored():
    """Runs of the table: by (pair, case, refine) the unknowns, seconds, phases and k."""
    if not TABLE.exists():
        return {}
    out = {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            run = out.setdefault((row["pair"], row["case"], float(row["refine"])), {"phase": [], "k": []})
            run |= {"dofs": (int(row["dofs 1"]), int(row["dofs 2"])), "seconds": float(row["seconds"])}
            run["phase"].append(float(row["phase"]))
            run["k"].append(float(row["k [N/m]"]))
    return {key: run | {name: np.array(run[name]) for name in ("phase", "k")} for key, run in out.items()}
