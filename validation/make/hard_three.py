"""A part of the page `hard`: cases in three dimensions."""

import math
import warnings
from dataclasses import replace

import numpy as np

import gearfe as gf

from ..shared.kept_rows import kept

STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
PHASES = np.array([0.1, 0.35, 0.6, 0.85])  # not 0, where a spur pair enters at once
PIT = gf.Pit(radius=18.7, z=6.0, axes=(1.0, 1.5), depth=0.1)
PITTED = np.array([0.4, 0.7, 1.0, 1.3, 1.6])  # pair 0 from below the pitch circle to its tip


def pair(b=12.0, degrees=16.0, bore=0.55, mate=None):
    """18/27 of m_n 2 mm, bores at a fraction of the root radius, or 18 with another mate."""
    beta, rack = math.radians(degrees), RACK | {"b": b}
    one, two = (
        gf.Gear(z=z, beta=sense * beta, r_bore=bore * (z / math.cos(beta) - 2.5), **rack) for z, sense in ((18, 1), (27, -1))
    )
    return gf.GearPair(one, mate or two)


def ring(rim, degrees=16.0):
    """A ring of 72 teeth with a rim of so many modules under its roots."""
    return gf.Gear(
        z=72,
        r_rim=72 / math.cos(math.radians(degrees)) + 2.5 + 2 * rim,
        b=12.0,
        beta=math.radians(degrees),
        tip_radius=0.2,
        addendum=0.8,
        **RACK,
    )


def cases():
    """(name, arguments of `mesh_stiffness`) of every hard case; functions, because some pairs are refused."""
    yield "as above", lambda: {"pair": pair()}
    yield "the same phases as the pitted rows", lambda: {"pair": pair(), "phases": PITTED}
    pits = {
        "pit at the tip edge": replace(PIT, radius=20.7),
        "pit across the end face": replace(PIT, z=12.0),
        "pit over the whole contact line of tooth 0": replace(PIT, axes=(8.0, 20.0)),
        "pit of 0.02 mm, finer than a cell": replace(PIT, axes=(0.01, 0.01)),
        "pit beside the flank": replace(PIT, radius=21.5),
    }
    for name, pit in pits.items():
        yield name, lambda pit=pit: {"pair": pair(), "phases": PITTED, "damage": {"pinion": [pit]}}
    yield (
        "pits over the whole contact lines of all teeth in contact",
        lambda: {"pair": pair(), "damage": {"pinion": [replace(PIT, axes=(8.0, 20.0), tooth=k) for k in range(-1, 4)]}},
    )
    for force in (1.0, 1e6):
        yield f"load {force:g} N", lambda force=force: {"pair": pair(), "force": force}
    for level in (0.8, 0.95):
        crack = {"pinion": [gf.Crack(level=level)]}
        yield f"crack {100 * level:g} %", lambda crack=crack: {"pair": pair(), "phases": PITTED, "damage": crack}
    parts = {
        "crack 80 %, half the width from the end z = 0": gf.Crack(level=0.8, width=(0.0, 6.0)),
        "crack 80 %, the middle third of the width": gf.Crack(level=0.8, width=(4.0, 8.0)),
        "crack 80 % on the unloaded side, pressed shut": gf.Crack(level=0.8, side="unloaded"),
        "crack that runs out along the width": gf.Crack(level=0.8, ends=(1.0, 0.0)),
    }
    for name, crack in parts.items():
        yield name, lambda crack=crack: {"pair": pair(), "phases": PITTED, "damage": {"pinion": [crack]}}
    for name, width in (("both halves", None), ("one half only", (0.0, 12.0))):
        yield (
            f"herringbone of 28 mm, groove 4 mm, crack 80 % in {name}",
            lambda width=width: {
                "pair": pair(28.0), "phases": PITTED, "face": "herringbone", "groove": 4.0, "force": 2400.0,
                "damage": {"pinion": [gf.Crack(level=0.8, width=width)]},
            },
        )  # fmt: skip
    yield "spur, b/m = 0.5", lambda: {"pair": pair(1.0, 0.0)}
    yield "b/m = 0.5", lambda: {"pair": pair(1.0)}
    for degrees in (0.0, 0.01, 45.0, 59.9, 60.0):
        yield f"beta = {degrees:g} degrees", lambda degrees=degrees: {"pair": pair(degrees=degrees)}
    for rim in (5.0, 1.0, 0.5):
        yield f"ring of 72 teeth, rim of {rim:g} m", lambda rim=rim: {"pair": pair(mate=ring(rim))}
    yield "bores at 0.92 of the root radius", lambda: {"pair": pair(bore=0.92)}
    yield "b/m = 40, edges twice as long", lambda: {"pair": pair(80.0), "refine": 0.5}


def outcome(case):
    """What a case ended in: mean k/b and error, or the error it was refused with."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            case = {"material": STEEL, "phases": PHASES, "method": "ritz3d"} | case()
            case = {"force": 100.0 * case["pair"].gear_1.b} | case
            curve = gf.mesh_stiffness(error=True, **case)
        except (ValueError, RuntimeError) as error:
            return f"{type(error).__name__}: {error} | | "
    warned = "".join(f"; warned: {message}" for message in dict.fromkeys(str(w.message) for w in caught))
    width = curve.meta["width_mm"]
    values = f"{curve.k.mean() / width / 1e6:.3f}", f"{(curve.k / width / 1e6).min():.3f}{warned}"
    return " | ".join([*values, f"{100 * (curve.error / curve.k).max():.2f} %"])


def _listed(phases):
    return ", ".join(f"{p:g}" for p in phases)


def section(again=False):
    """Lines of the page."""
    lines = [
        "## In three dimensions",
        "",
        "18/27 teeth of m_n 2 mm, 16 degrees, b 12 mm, bores at 0.55 of the root radius, 100 N/mm, steel, `ritz3d`, unless the",
        f"row says otherwise; phases {_listed(PHASES)}, of pits and cracks {_listed(PITTED)}. Damage is on the pinion's",
        "tooth 0. Error: the largest estimate over the phases.",
        "",
        "| case | mean k/b [N/(mm um)] | least | error |",
        "|---|---|---|---|",
    ]
    for name, case in cases():
        lines.append(f"| {name} | {kept('hard_three', name, lambda case=case: {'cells': outcome(case)}, again)['cells']} |")
    return [
        *lines,
        "",
        "Thin helical gears are soft because their tooth force has an axial part, which bends a disc held at its bore; as thin",
        "spur gears are not. Rims are held outside: thinner ones are stiffer. Where a pit takes all of a pair's contact line,",
        "the next pairs carry the load beyond their path of contact, across the gap that their tip corners have there.",
    ]
