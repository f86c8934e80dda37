"""CalculiX on whole gears, under line loads and in contact, beside `ritz3d`: the cases, and every run kept in a table.

`reference` computes what `tables/outsider_three.csv` lacks if `ccx` is there.
"""

import csv
import math
import resource
import shutil
import subprocess
import sys
import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.contact.solid import pair_stiffness3d
from gearfe.elements.contact_solid import SolidDeck
from gearfe.energy.ritz import solid as ritz3d
from gearfe.energy.ritz.join import join
from gearfe.files import written
from gearfe.flexibility import solid as flexibility3d

from .places import TABLES

TABLE = TABLES / "outsider_three.csv"
SHARING = TABLES / "outsider_three_sharing.csv"
SHARED = ("mesh", "pair", "ours [N]", "theirs [N]", "ours z [mm]", "theirs z [mm]")
COLUMNS = ("case", "mesh", "nodes", "seconds", "ours", "theirs", "forces apart")
STEEL = gf.Material(E=207e3, nu=0.3)
LOAD = 300.0  # N/mm
PITTED = 600.0  # N/mm of pairs with pits: a contact 1.4 times as wide, so that fewer elements follow it around the pits
PITS = {"cut": "cut out", "lost": "as lost contact", "filled": "filled"}  # by what the deck does with them
STRIP = ({"per_width": 1.0}, {"per_width": 1.5})  # finer along the contact lines only
# of pairs with pits, whose rims follow; with contact springs ten times softer than by default, which cost k less than 0.1 %
RIMS = ({"per_width": 0.67, "penalty": 50}, {"per_width": 1.0, "refine": 1.4, "penalty": 50})
ALL_FINER = {"per_width": 1.0, "refine": 1.3}  # everywhere
SHOWN = "helical, healthy"  # whose load sharing is kept
ASKED = 0.005  # largest difference asked for where both meshes are converged
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}


@dataclass(frozen=True, slots=True)
class Case:
    """A pair in contact: `damage` as of `mesh_stiffness`, the phase, load [N/mm], meshes as options of `write_contact_inp`.

    `pits` as of `write_contact_inp`: a case with pits has two controls in the same mesh.
    """

    pair: gf.GearPair
    phase: float = 0.45
    damage: dict = field(default_factory=dict)
    pits: str = "cut"
    meshes: tuple = STRIP
    load: float = LOAD


def pinion(degrees=15.0):
    """The small gear of all cases."""
    return gf.Gear(z=13, x=0.3, r_bore=8.0, beta=math.radians(degrees), **RACK)


def pair_of(degrees):
    """External pair 13/16."""
    return gf.GearPair(pinion(degrees), gf.Gear(z=16, x=0.2, r_bore=10.0, beta=-math.radians(degrees), **RACK))


def ring_pair():
    """Pinion in a ring of 36 teeth."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # its tip is trimmed
        ring = gf.Gear(z=36, r_rim=45.0, tip_radius=0.2, addendum=0.8, beta=math.radians(15), **RACK)
        return gf.GearPair(pinion(), ring)


def pits():
    """Two pits with their centres on the contact line of the pinion's tooth 0: circular and elliptic."""
    return [
        gf.Pit(radius=13.13, z=1.8, axes=(0.4, 0.4), depth=0.2),
        gf.Pit(radius=13.31, z=4.2, axes=(0.35, 0.7), depth=0.2),
    ]


def cases():
    """Cases in contact, by name, in order of importance."""
    crack, part = gf.Crack(level=0.5), gf.Crack(level=0.5, width=(0.0, 3.0))
    return {
        "helical, healthy": Case(pair_of(15.0), meshes=(*STRIP, {"per_width": 2.25}, ALL_FINER)),
        "helical, crack 50 %": Case(pair_of(15.0), damage={"pinion": [crack]}),
        "helical, crack 50 % over half the width": Case(pair_of(15.0), damage={"pinion": [part]}),
        "spur, healthy": Case(pair_of(0.0)),
        "ring, healthy": Case(ring_pair()),
        **_with_control("helical, two pits", pits(), RIMS),
        **_with_control("helical, crack 50 % and two pits", [crack, *pits()], RIMS),
    }


def _with_control(name, damage, meshes):
    """A case with pits cut out; in the same mesh with contact lost there but the material left; and with nothing of them."""
    options = {"damage": {"pinion": damage}, "meshes": meshes, "load": PITTED}
    return {f"{name} {end}": Case(pair_of(15.0), pits=kind, **options) for kind, end in PITS.items()}


def lines():
    """Single gears under a line load, by name: gear, cracks."""
    ring = ring_pair().gear_2
    return {
        "line load, spur": (pinion(0.0), ()),
        "line load, helical": (pinion(), ()),
        "line load, crack 50 %": (pinion(), (gf.Crack(level=0.5),)),
        "line load, ring": (ring, ()),
    }


LINE_MESHES = ({"refine": 0.6}, {"refine": 0.8})


def calculix(folder, name):
    """Run CalculiX and give its CPU seconds; RuntimeError with its last words if it has no result."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(["ccx", "-i", name], cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / f"{name}.dat").exists() or not (folder / f"{name}.dat").stat().st_size:
        raise RuntimeError(f"CalculiX gave no result: {done.stdout[-500:]}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def line_hat(gear):
    """Number of the hat under which a line load stands, and its roll length [mm]."""
    knots = flexibility3d.hats(gear)
    whole = np.flatnonzero(np.isclose(np.diff(knots, axis=0), flexibility3d.HAT * gear.m_n, rtol=1e-9).all(axis=0))
    top = int(whole[len(whole) // 2])
    return top, math.sqrt(2 * gear.r_b * gear.outward * knots[1, top])


def line_deflection(name):
    """Deflection [nm/N] under a line load by `ritz3d`."""
    gear, cracks = lines()[name]
    axial = ritz3d.axial_degree(gear.b, gear.m_n)
    panels = [ritz3d.solid_sector(gear, STEEL, own, width=gear.b, order=3, axial=axial, refine=1.0) for own in (cracks, ())]
    found, _ = join(gear, {0: panels[0], 1: panels[1]}, panels[1])
    at = line_hat(gear)[0] * (axial + 1)
    return 1e6 * found[0, 0][at, at] / gear.b


def line_deck(folder, name, mesh):
    """Deck of a line load, in a folder."""
    gear, cracks = lines()[name]
    radius, half = math.hypot(line_hat(gear)[1], gear.r_b), flexibility3d.HAT * gear.m_n
    return gf.write_line_inp(folder / "gear.inp", gear, radius, 100.0, STEEL, cracks=cracks, half_width=half, **mesh)


def line_row(name, mesh):
    """Deflection [nm/N] of a hat of pressure along the tooth's middle, by `ritz3d` and by CalculiX."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        deck = line_deck(folder, name, mesh)
        seconds = calculix(folder, "gear")
        theirs = deck.deflection(folder / "gear.dat") / deck.force
    return _row(name, mesh, deck.part.points.shape[1], seconds, line_deflection(name), 1e6 * theirs, 0.0)


def contact_row(name, mesh):
    """Stiffness [N/um] of a pair by `ritz3d` and by CalculiX at the approach that `ritz3d` has under the load."""
    case = cases()[name]
    pair, face = case.pair, "helical" if case.pair.gear_1.beta else "spur"
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        ours, approach = stiffness(case)
        options = {"face": face, "damage": case.damage, "pits": case.pits, **mesh}
        deck = gf.write_contact_inp(folder / "pair.inp", pair, case.phase, approach, case.load, (STEEL, STEEL), **options)
        seconds = calculix(folder, "pair")
        first, second = deck.forces(folder / "pair.dat")
        if name == SHOWN and isinstance(deck, SolidDeck):
            keep_sharing(case, told(mesh), deck.carried(folder / "pair.dat"))
    theirs = (first + second) / 2 / approach / 1e3
    nodes = sum(part.points.shape[1] for part in deck.parts)
    return _row(name, mesh, nodes, seconds, ours, theirs, first / second - 1)


def stiffness(case):
    """Stiffness [N/um] and approach [mm] of a case by `ritz3d`."""
    damage = case.damage
    if case.pits == "filled":
        damage = {side: [one for one in own if isinstance(one, gf.Crack)] for side, own in damage.items()}
    run = {"method": "ritz3d", "phases": [case.phase], "damage": damage}
    curve = gf.mesh_stiffness(case.pair, case.load * case.pair.gear_1.b, STEEL, **run)
    return float(curve.k[0]) / 1e6, 1e3 * float(curve.lte[0])


def _row(name, mesh, *values):
    return dict(zip(COLUMNS, (name, told(mesh), *(f"{v:.6g}" for v in values)), strict=True))


def told(mesh):
    """A mesh's options as text."""
    return ", ".join(f"{key} {value:g}" for key, value in mesh.items())


def keep_sharing(case, mesh, theirs):
    """Put the force that each tooth pair carries and the height of its line of action, ours and theirs, into their table."""
    cells = pair_stiffness3d(case.pair, case.load * case.pair.gear_1.b, STEEL, [case.phase]).cells[0]
    rows = [row for row in rows_of(SHARING) if row["mesh"] != mesh]
    for order, (force, z) in sorted(theirs.items()):
        load = np.where(cells.order == order, cells.load, 0.0)
        values = load.sum(), force, (load * cells.z).sum() / load.sum(), z
        rows.append(dict(zip(SHARED, (mesh, order, *(f"{v:.5g}" for v in values)), strict=True)))
    _write(rows, SHARING, SHARED)


def wanted():
    """(name, mesh) of all runs in order of importance: one mesh of everything first, then the studies of convergence."""
    runs = [(name, LINE_MESHES[0]) for name in lines()]
    main = [(name, case.meshes[0]) for name, case in cases().items()]
    runs += main + [(name, mesh) for name, case in cases().items() for mesh in case.meshes if (name, mesh) not in main]
    return runs + [(name, LINE_MESHES[1]) for name in lines()]


def stored():
    """Rows of the table by (case, mesh)."""
    return {(row["case"], row["mesh"]): row for row in rows_of(TABLE)}


def rows_of(table):
    """Rows of a table; none if there is no table."""
    if not table.exists():
        return []
    with table.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def refresh():
    """Put what `ritz3d` finds today into the rows of the table."""
    known, today = stored(), {}
    for row in known.values():
        name = row["case"]
        if name not in today:
            today[name] = line_deflection(name) if name in lines() else stiffness(cases()[name])[0]
        row["ours"] = f"{today[name]:.6g}"
    _write(known.values())


def reference():
    """Compute the runs that the table lacks, each kept at once; without CalculiX say so and compute nothing."""
    refresh()
    if not shutil.which("ccx"):
        print("  CalculiX (ccx) is not installed: the committed rows are kept (Debian: apt-get install calculix-ccx)")
        return
    for name, mesh in wanted():
        if (name, told(mesh)) not in stored():
            keep((line_row if name in lines() else contact_row)(name, mesh))


def keep(row):
    """Append a row to the table."""
    _write([*stored().values(), row])
    print(f"  {row['case']}, {row['mesh']}: {100 * apart(row):+.2f} %, {float(row['seconds']):.0f} s", flush=True)
    sys.stdout.flush()


def _write(rows, table=TABLE, columns=COLUMNS):
    with written(table) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, columns, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


def apart(row):
    """Relative difference of a row, ours over theirs."""
    return float(row["ours"]) / float(row["theirs"]) - 1
