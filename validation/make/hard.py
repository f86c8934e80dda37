"""The page `hard`: extreme cases, each of which ends in a result with an error estimate, or in an error that says why not."""

import math
import warnings

import numpy as np

import gearfe as gf

from ..shared import page
from ..shared.kept_rows import kept, stored
from . import hard_dynamics, hard_three

TABLES = ("hard", "hard_three", "hard_dynamics")
STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}


def gear(z, bore=0.5, **numbers):
    """A gear with its bore at a fraction of the root radius."""
    numbers = RACK | numbers
    r_f = z * numbers["m_n"] / 2 - (numbers.get("dedendum", 1.25) - numbers.get("x", 0.0)) * numbers["m_n"]
    return gf.Gear(z=z, r_bore=bore * r_f, **numbers)


def ring(z, **numbers):
    """A ring with a rim of five modules."""
    return gf.Gear(z=z, **({"r_rim": z + 2 * 1.25 + 10, "tip_radius": 0.2} | RACK | numbers))


def pair(one, two, a=None, force=2000.0, material=STEEL, **options):
    """Curves of a pair by `ritz` and by `fe`, 32 phases, with their error estimates."""
    case = {"pair": gf.GearPair(one, two, a), "force": force, "material": material, "phases": 32} | options
    return [gf.mesh_stiffness(method=method, error=True, **case) for method in ("ritz", "fe")]


def cases():
    """(name, callable) of every hard case."""
    for z in (5, 8, 10, 12, 14, 17, 200, 1000):
        yield f"z = {z} with 43", lambda z=z: pair(gear(z), gear(43))
    for alpha in (14.5, 25, 30):
        rack = {"alpha_n": math.radians(alpha)}
        yield f"alpha_n = {alpha} degrees, 25/43", lambda rack=rack: pair(gear(25, **rack), gear(43, **rack))
    for x in (-0.6, -0.3, 0.3, 0.6, 1.0):
        yield f"x = {x}, 20/43", lambda x=x: pair(gear(20, x=x), gear(43))
    yield "pointed tooth, z = 8, x = 0.9", lambda: pair(gear(8, x=0.9), gear(43))
    for bore in (0.3, 0.8, 0.9, 0.95):
        yield f"bore at {bore} r_f, 25/43", lambda bore=bore: pair(gear(25, bore), gear(43, bore))
    for rho in (0.0, 0.1, 0.47):
        yield f"rack tip radius {rho} m, 25/43", lambda rho=rho: pair(gear(25, tip_radius=rho), gear(43, tip_radius=rho))
    for level in (0.001, 0.01, 0.8, 0.95):
        damage = {"pinion": [gf.Crack(level=level)]}
        yield f"crack {100 * level:g} %, 25/43", lambda damage=damage: pair(gear(25), gear(43), damage=damage, span="tooth")
    for level in (0.95, 0.99, 0.999):
        damage = {"pinion": [gf.Crack(level=level, turning=True)]}
        yield (
            f"turning crack {100 * level:g} %: tip close to the far fillet",
            lambda damage=damage: pair(gear(25), gear(43), damage=damage, span="tooth"),
        )
    for nu in (0.0, 0.3, 0.49, 0.4999):
        yield f"nu = {nu}, 25/43", lambda nu=nu: pair(gear(25), gear(43), material=gf.Material(E=207e3, nu=nu))
    yield (
        "steel on polymer (E 1:70)",
        lambda: pair(gear(25), gear(43), force=100.0, material=(STEEL, gf.Material(E=2957.0, nu=0.4))),
    )
    for line in (0.01, 1.0, 1000.0, 5000.0):
        yield f"F/b = {line:g} N/mm, 25/43", lambda line=line: pair(gear(25), gear(43), force=20 * line)
    for a in (69.47, 69.44):
        yield f"eps close to 1: 25/43 at a = {a} mm", lambda a=a: pair(gear(25), gear(43), a)
    high = {"addendum": 1.35, "dedendum": 1.6, "tip_radius": 0.2}
    yield "eps = 2.3 (three pairs), 60/70", lambda: pair(gear(60, **high), gear(70, **high))
    for teeth in ((27, 72), (30, 40), (32, 40), (35, 40)):
        yield f"planet-ring {teeth[0]}/{teeth[1]}", lambda teeth=teeth: pair(gear(teeth[0]), ring(teeth[1]))
    yield "ring of z = 30: tip inside the base circle", lambda: pair(gear(15), ring(30))
    for refine in (0.25, 4.0):
        yield (
            f"mesh {1 / refine:g} times the default edge lengths, 25/43",
            lambda refine=refine: pair(gear(25), gear(43), refine=refine),
        )


def outcome(case):
    """What a case ended in: cells with its mean, error and warnings, or its ValueError; whether the estimates cover."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            curve, other = case()
        except ValueError as error:
            return {"cells": f"ValueError: {error} | "}
    width = curve.meta["width_mm"]
    text = f"eps {curve.meta['eps_alpha']:.3f}, mean k/b {curve.k.mean() / width / 1e6:.3f} N/(mm um), error "
    text += f"{100 * (curve.error / curve.k).max():.2f} % (fe {100 * (other.error / other.k).max():.2f} %)"
    if curve.meta.get("crack_closed_phases"):
        text += f", crack faces touch at {len(curve.meta['crack_closed_phases'])} of {curve.phase.size} phases"
    text += "".join(f"; warned: {message}" for message in dict.fromkeys(str(w.message) for w in caught))
    away = 100 * np.abs(curve.k / other.k - 1)
    covered = bool((np.abs(curve.k - other.k) <= curve.error + other.error).all())
    return {"cells": f"{text} | {away.mean():.3f} %, {away.max():.3f} %", "covered": covered}


def section(again=False):
    """Lines of the cases in the section."""
    lines = [
        "## In the section",
        "",
        "Pinion / wheel of m 2 mm, b 20 mm, bores at half the root radius, 100 N/mm, steel, unless the row says otherwise;",
        "32 phases, contact beyond the path included. Values by `ritz`; error: the largest estimate over the cycle, of `ritz`",
        "and of `fe`. They share the profile, the held bore and the contact, which [outlines.md](outlines.md) judges.",
        "",
        "| case | outcome | `ritz` against `fe`, mean and largest |",
        "|---|---|---|",
    ]
    for name, case in cases():
        lines.append(f"| {name} | {kept('hard', name, lambda case=case: outcome(case), again)['cells']} |")
    return lines


def answer():
    """The first line."""
    rows = [row for name in TABLES for row in stored(name).values()]
    refused = sum("Error: " in row["cells"].split(" | ")[0] for row in rows)
    compared = [row["covered"] for row in rows if "covered" in row]
    return (
        f"Each of {len(rows)} extreme cases ends in a result with an error estimate or, {refused} of them, in an error that says "
        f"why not; where a second method solves it, estimates cover the difference in {sum(compared)} of {len(compared)}."
    )


HOW = """
`python -m validation hard` makes this page from `tables/hard*.jsonl` and computes them.
"""


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    sections = section(again), hard_three.section(again), hard_dynamics.section(again)
    page.write("hard", answer(), HOW.strip().splitlines(), *sections)
