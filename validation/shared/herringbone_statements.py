"""Conclusions of article S4 from its stiffness: reductions by `ritz3d` for each fault alone and both together."""

import numpy as np

import gearfe as gf
from gearfe.core.case_parts import overlap

from .kept_rows import kept

# distance of the pit centre from the pitch point [base pitches]
OFFSETS = (-0.25, -0.12, -0.09, -0.06, -0.03, 0.0, 0.03, 0.06, 0.09, 0.12, 0.25)
SCENES = ("herringbone", "herringbone_contact_line")
FAULTS = ("both", "crack", "pits")
CLOSE = 0.1  # tolerance of equality, relative to the effect of the crack alone
NAME = "herringbone_statements"
TITLE = """
## What S4 concludes from its stiffness

The largest reduction [%] by `ritz3d` within a quarter of a base pitch of the pitch point is listed for crack and pits, the crack
alone and the pits alone. 'Close': the pits add less than a tenth of the reduction by the crack.
"""


def reduction(scene, pair, case):
    """Return the largest reductions [%] by both faults of a case and by each alone."""
    chosen = gf.load_scene(scene).pairs[pair]
    phase = chosen.pair.pitch_phase + overlap(chosen.pair, chosen.face, chosen.groove) / 2 + np.array(OFFSETS)
    run = {"method": "ritz3d", "phases": phase}
    whole, every = gf.mesh_stiffness(chosen.case(), **run).k, chosen.damage[case]
    own = {"both": every}
    for name, kind in (("crack", gf.Crack), ("pits", gf.Pit)):
        own[name] = {side: [one for one in found if isinstance(one, kind)] for side, found in every.items()}
    return {
        name: float(100 * (1 - gf.mesh_stiffness(**chosen.case().as_dict() | {"damage": damage}, **run).k / whole).max())
        for name, damage in own.items()
    }


def rows(again=False):
    """Return reductions by (scene, pair, number of the case)."""
    out = {}
    for scene in SCENES:
        for pair, prefix in (("sun_planet", "case"), ("planet_ring", "planet")):
            for number in (1, 2, 3, 4):
                name = f"{scene}, {pair}, {prefix}{number}"
                make = lambda scene=scene, pair=pair, case=f"{prefix}{number}": reduction(scene, pair, case)  # noqa: E731
                out[scene, pair, number] = kept(NAME, name, make, again)
    return out


def verdicts(found, scene):
    """Return the statements of S4, whether they hold in a scene, and the numbers that decide."""
    sun, ring = ([found[scene, pair, number] for number in (1, 2, 3, 4)] for pair in ("sun_planet", "planet_ring"))
    pairs = gf.load_scene(scene).pairs
    eps = [pairs[name].pair.eps_alpha for name in ("sun_planet", "planet_ring")]
    lower = all(one["both"] > max(one["crack"], one["pits"]) for one in (*sun, *ring))
    beside = [one[2]["both"] - one[2]["crack"] for one in (sun, ring)]
    both = ", ".join(f"{a['both']:.2f} / {b['both']:.2f}" for a, b in zip(sun, ring, strict=True))
    close = f"pits add {beside[0]:.1f} and {beside[1]:.1f} points to {sun[2]['crack']:.1f} and {ring[2]['crack']:.1f} %"
    return (
        ("the coupled stiffness is lower than that of either fault", lower, "in all eight rows" if lower else "not in all"),
        ("case 3 is close to the 60 % crack alone, which covers the pits", max(beside) < CLOSE * sun[2]["crack"], close),
        (
            "pits beyond the crack, case 4: their contact loss dominates",
            sun[3]["pits"] > sun[3]["crack"],
            f"14 pits alone cause {sun[3]['pits']:.1f} %, the crack alone {sun[3]['crack']:.1f} %",
        ),
        (
            "sun and planet are more sensitive than planet and ring",
            all(a["both"] > b["both"] for a, b in zip(sun, ring, strict=True)),
            f"{both} %",
        ),
        ("because their contact ratio is smaller", eps[0] < eps[1], f"{eps[0]:.2f} and {eps[1]:.2f}"),
    )


def section(again=False):
    """Return the lines of the page."""
    found = rows(again)
    lines = [TITLE, "", "| scene | pair | case 1 | case 2 | case 3 | case 4 |", "|---|---|---|---|---|---|"]
    for scene in SCENES:
        for pair in ("sun_planet", "planet_ring"):
            cells = [" ; ".join(f"{found[scene, pair, n][name]:.1f}" for name in FAULTS) for n in (1, 2, 3, 4)]
            lines.append(f"| {scene} | {pair} | " + " | ".join(cells) + " |")
    lines += ["", "| S4 says | " + " | ".join(SCENES) + " |", "|---|---|---|"]
    told = [verdicts(found, scene) for scene in SCENES]
    for both in zip(*told, strict=True):
        lines.append(f"| {both[0][0]} | " + " | ".join(f"{'yes' if holds else 'no'}: {why}" for _, holds, why in both) + " |")
    return lines
