"""What the scan of S4's readings is interpolated from: `ritz3d` and the closed forms at a few bores and crack lengths.

Every node is kept in `tables/herringbone_scan_nodes.csv` at once, so that a run can be stopped and continued.
"""

import csv
import math
import time
from dataclasses import replace

import numpy as np

import gearfe as gf
from gearfe.core.case import by_gear, overlap
from gearfe.geometry.damage.crack import start_arc
from gearfe.geometry.damage.pit import pit_row
from gearfe.geometry.tooth.profile import cartesian, root_curve

from .places import TABLES
from .solid_pair import solid_contact

SCENE = "herringbone"
PAIRS = ("sun_planet", "planet_ring")
GROUPS = (  # crack angle [degrees] and start, width of a half [mm]: S4 prints 45 degrees, and 60 mm without saying of what
    (45.0, "30deg", 30.0),
    (45.0, "root", 30.0),
    (45.0, "30deg", 60.0),
    (38.0, "30deg", 30.0),
    (45.0, "middle", 30.0),
    (55.0, "30deg", 30.0),
    (45.0, "root", 60.0),
    (38.0, "30deg", 60.0),
    (45.0, "middle", 60.0),
    (55.0, "30deg", 60.0),
)
BORES = {"sun_planet": ((0.36, 0.36), (0.80, 0.36), (0.36, 0.80)), "planet_ring": ((0.36,), (0.80,))}  # parts of r_f
LENGTHS = (0.0, 0.15, 0.4, 0.65, 0.9)  # of the crack, in tooth chords where it starts
PHASES = 6  # of the mesh cycle in which the damaged tooth is in the middle
COARSE = {"order": 2, "refine": 0.7, "step": 1.5}  # of the energy model
AXIAL = {30.0: 8, 60.0: 12}
SINGLES = {  # one assumption at a time, on healthy gears with both bores 0.5 of the root radius
    "as in the scene": {},
    "tip radius 0.2": {"tip": 0.2},
    "rim 80 mm": {"rim": 80.0},
    "rim 95 mm": {"rim": 95.0},
}
PITS = {"3 pits": (0.15, 3, 1), "7 pits": (0.4, 7, 1), "7 pits, deep crack": (0.65, 7, 1), "14 pits": (0.4, 7, 2)}
FLAT = tuple(np.geomspace(0.3, 0.85, 6).round(4).tolist())  # bores of the plane section


def chord(gear, start):
    """Tooth thickness [mm] across the points where cracks start."""
    return 2 * float(cartesian(*root_curve(gear, start_arc(gear, gf.Crack(level=0.5, start=start))))[0])


def changed(pair, *, bores=(0.5, 0.5), half=30.0, tip=None, rim=None):
    """The scene's pair with other bores (parts of the root radius), widths, root of the external gears, and rim."""
    gears, bores = [], list(bores)
    for gear in (pair.gear_1, pair.gear_2):
        made = replace(gear, b=2 * half)
        if gear.internal:
            made = made if rim is None else replace(made, r_rim=rim)
        else:
            made = made if tip is None else replace(made, tip_radius=tip)
            made = replace(made, r_bore=made.r_f * bores.pop(0))
        gears.append(made)
    return gf.GearPair(*gears, pair.a)


def cycle(pair, face, count=PHASES):
    """Phases ``(count,)`` of the cycle in which tooth 0 is in the middle of its engagement."""
    length = pair.eps_alpha + overlap(pair, face, 0.0)
    return length / 2 - 0.5 + (np.arange(count) + 0.5) / count


def coarse(chosen, pair, damage, *, load=1.0):
    """Stiffness ``(PHASES,)`` [N/m] by the coarse energy model."""
    cracks, pits = by_gear(pair, damage)
    found = solid_contact(
        pair,
        load * chosen.force,
        chosen.materials,
        cycle(pair, chosen.face),
        cracks=cracks,
        pits=pits,
        face=chosen.face,
        axial=AXIAL[pair.gear_1.b / 2],
        **COARSE,
    )
    return found.k


def cracked(pair, length, angle, start):
    """Damage of the pinion: a crack as long as so many chords, or none."""
    if not length:
        return {}
    return {"pinion": [gf.Crack(length=length * chord(pair.gear_1, start), angle=math.radians(angle), start=start)]}


def with_pits(pair, count, rows):
    """S4's pits of 1 mm on the pinion, in rows 0.4 mm below and above the pitch circle, or one on it; along one half."""
    places = [0.0] if rows == 1 else [-0.4, 0.4]
    made = [pit_row(count, 3.0, 27.0, radius=pair.gear_1.r + at, axes=(0.5, 0.5), depth=0.2) for at in places]
    return [pit for row in made for pit in row]


def healthy(group):
    """The first group of the same width, which has the nodes without a crack: healthy gears know no other difference."""
    return next(i for i, one in enumerate(GROUPS) if one[2] == GROUPS[group][2])


def jobs():
    """All nodes as (name, callable giving an array [N/m]), in the order of their importance."""
    pairs = gf.load_scene(SCENE).pairs
    out = {}
    for name in PAIRS:
        for bore in FLAT:
            for which in range(len(BORES[name][0])):
                out[f"plane {name} {which} {bore}"] = (_plane, pairs[name], which, bore)
    for group, (angle, start, half) in enumerate(GROUPS):
        for name in PAIRS:
            for bores in BORES[name]:
                for length in LENGTHS:
                    if not length and group != healthy(group):
                        continue
                    text = " ".join(map(str, bores))
                    out[f"{group} {name} {text} {length}"] = (_node, pairs[name], bores, half, (length, angle, start))
        if group == 0:
            for name in PAIRS:
                for what, case in PITS.items():
                    out[f"pits {name} {what}"] = (_pitted, pairs[name], case, GROUPS[0])
            for name in PAIRS:
                for what, other in SINGLES.items():
                    if name == "planet_ring" or "rim" not in what:
                        out[f"single {name} {what}"] = (_single, pairs[name], other)
    return out


def _plane(chosen, which, bore):
    bores = [0.5, 0.5]
    bores[which] = bore
    pair = changed(chosen.pair, bores=bores)
    return gf.mesh_stiffness(pair, chosen.force, chosen.materials, method="ritz", phases=16).k.mean(keepdims=True)


def _node(chosen, bores, half, crack):
    pair = changed(chosen.pair, bores=bores, half=half)
    return coarse(chosen, pair, cracked(pair, *crack), load=half / 30.0)


def _pitted(chosen, case, group):
    pair = changed(chosen.pair, bores=BORES["sun_planet"][0])
    damage = cracked(pair, case[0], *group[:2])
    return coarse(chosen, pair, {"pinion": [*damage["pinion"], *with_pits(pair, *case[1:])]})


def _single(chosen, other):
    return coarse(chosen, changed(chosen.pair, **other), {})


def path():
    """The table of nodes."""
    return TABLES / "herringbone_scan_nodes.csv"


def load():
    """Stiffness [N/m] by name of a node, and the seconds of the processor that they took together."""
    if not path().exists():
        return {}, 0.0
    with path().open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    values = {row["node"]: np.array([float(v) for v in row["k [N/m]"].split()]) for row in rows}
    return values, sum(float(row["seconds"]) for row in rows)


def keep(target, header, row):
    """Append a row to a table."""
    fresh = not target.exists()
    with target.open("a", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerows([header, row] if fresh else [row])


def compute():
    """Compute the nodes that are not in the table."""
    known = load()[0]
    todo = {name: job for name, job in jobs().items() if name not in known}
    for count, (name, (work, *case)) in enumerate(todo.items(), 1):
        started = time.process_time()
        try:
            k = work(*case)
        except ValueError as error:
            if "crack of length" not in str(error):
                raise
            k = np.full(PHASES, np.nan)  # the crack cuts this gear's body
        seconds = time.process_time() - started
        keep(path(), ["node", "k [N/m]", "seconds"], [name, " ".join(f"{v:.6g}" for v in k), f"{seconds:.2f}"])
        print(f"{count}/{len(todo)} {name}: {seconds:.2f} s", flush=True)
