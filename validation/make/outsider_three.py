"""Three dimensions judged by an outsider: CalculiX on whole gears, under line loads and in contact, beside `ritz3d` (resumable).

Every run of CalculiX is appended to `tables/outsider_three.csv`; `reference` computes what the table lacks if `ccx` is there, and
`run` makes the page from the table alone.
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
from geometry.tooth.profile import arc_at

from ..shared.places import PAGES, TABLES

PAGE = PAGES / "outsider_three.md"
TABLE = TABLES / "outsider_three.csv"
PRESSURE = TABLES / "outsider_three_pressure.csv"
PICTURE = PAGES / "outsider_three_pressure.png"
COLUMNS = ("case", "mesh", "nodes", "seconds", "ours", "theirs", "forces apart")
STEEL = gf.Material(E=207e3, nu=0.3)
LOAD = 300.0  # N/mm
SHOWN = "helical, healthy"  # whose pressure is drawn
ASKED = 0.005  # largest difference asked for where both meshes are converged
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}


@dataclass(frozen=True, slots=True)
class Case:
    """A pair in contact: `damage` as of `mesh_stiffness`, the phases, and the meshes as options of `write_contact_inp`."""

    pair: gf.GearPair
    phase: float = 0.45
    damage: dict = field(default_factory=dict)
    meshes: tuple = ({"per_width": 1.0}, {"per_width": 1.5})


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
    """Two pits on the pinion's tooth 0 where it touches: circular and elliptic."""
    return [
        gf.Pit(radius=14.0, z=1.8, axes=(0.4, 0.4), depth=0.2),
        gf.Pit(radius=14.4, z=4.2, axes=(0.35, 0.7), depth=0.2),
    ]


def cases():
    """Cases in contact, by name, in order of importance."""
    crack, part = gf.Crack(level=0.5), gf.Crack(level=0.5, width=(0.0, 3.0))
    coarse, main, fine = {"per_width": 1.0}, {"per_width": 1.5}, {"per_width": 2.0, "layers": 4, "refine": 1.2}
    return {
        "helical, healthy": Case(pair_of(15.0), meshes=(coarse, main, fine)),
        "helical, crack 50 %": Case(pair_of(15.0), damage={"pinion": [crack]}),
        "helical, crack 50 % over half the width": Case(pair_of(15.0), damage={"pinion": [part]}),
        "spur, healthy": Case(pair_of(0.0)),
        "ring, healthy": Case(ring_pair()),
        "helical, two pits cut out": Case(pair_of(15.0), damage={"pinion": pits()}),
        "helical, crack 50 % and two pits cut out": Case(pair_of(15.0), damage={"pinion": [crack, *pits()]}),
    }


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


def line_row(name, mesh):
    """Deflection [nm/N] of a hat of pressure along the tooth's middle, by `ritz3d` and by CalculiX."""
    gear, cracks = lines()[name]
    axial = ritz3d.axial_degree(gear.b, gear.m_n)
    panels = [ritz3d.solid_sector(gear, STEEL, own, width=gear.b, order=3, axial=axial, refine=1.0) for own in (cracks, ())]
    found, _ = join(gear, {0: panels[0], 1: panels[1]}, panels[1])
    knots = flexibility3d.hats(gear)
    whole = np.flatnonzero(np.isclose(np.diff(knots, axis=0), flexibility3d.HAT * gear.m_n, rtol=1e-9).all(axis=0))
    top = int(whole[len(whole) // 2])
    at = top * (axial + 1)
    ours = found[0, 0][at, at] / gear.b
    radius = math.hypot(math.sqrt(2 * gear.r_b * gear.outward * knots[1, top]), gear.r_b)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        deck = gf.write_line_inp(
            folder / "gear.inp", gear, radius, 100.0, STEEL, cracks=cracks, half_width=flexibility3d.HAT * gear.m_n, **mesh
        )
        seconds = calculix(folder, "gear")
        theirs = deck.deflection(folder / "gear.dat") / deck.force
    return _row(name, mesh, deck.part.points.shape[1], seconds, 1e6 * ours, 1e6 * theirs, 0.0)


def contact_row(name, mesh):
    """Stiffness [N/um] of a pair by `ritz3d` and by CalculiX at the approach that `ritz3d` has under the load."""
    case = cases()[name]
    pair, face = case.pair, "helical" if case.pair.gear_1.beta else "spur"
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        ours, approach = stiffness(case)
        deck = gf.write_contact_inp(
            folder / "pair.inp", pair, case.phase, approach, LOAD, (STEEL, STEEL), face=face, damage=case.damage, **mesh
        )
        seconds = calculix(folder, "pair")
        first, second = deck.forces(folder / "pair.dat")
        if name == SHOWN and mesh == case.meshes[-1] and isinstance(deck, SolidDeck):
            keep_pressure(case, deck, folder / "pair.frd")
    theirs = (first + second) / 2 / approach / 1e3
    nodes = sum(part.points.shape[1] for part in deck.parts)
    return _row(name, mesh, nodes, seconds, ours, theirs, first / second - 1)


def stiffness(case):
    """Stiffness [N/um] and approach [mm] of a case by `ritz3d`."""
    run = {"method": "ritz3d", "phases": [case.phase], "damage": case.damage or None}
    curve = gf.mesh_stiffness(case.pair, LOAD * case.pair.gear_1.b, STEEL, **run)
    return float(curve.k[0]) / 1e6, 1e3 * float(curve.lte[0])


def _row(name, mesh, *values):
    return dict(zip(COLUMNS, (name, told(mesh), *(f"{v:.6g}" for v in values)), strict=True))


def told(mesh):
    """A mesh's options as text."""
    return ", ".join(f"{key} {value:g}" for key, value in mesh.items())


def keep_pressure(case, deck, path):
    """Nodal contact pressure of CalculiX on the slave flanks, as a table of gear, order, arc [mm], z [mm], pressure [MPa]."""
    pressure, rows = nodal_pressure(path), []
    first = (0, deck.parts[0].points.shape[1])
    for order, (side, faces) in deck.slaves.items():
        gear, part = (case.pair.gear_1, case.pair.gear_2)[side], deck.parts[side]
        centre = (0.0, case.pair.centre_2)[side]
        for node in np.unique(faces).tolist():
            x, y, z = part.points[:, node]
            roll = math.sqrt(max(x * x + (y - centre) ** 2 - gear.r_b**2, 0.0))
            rows.append((side, order, float(arc_at(gear, roll)), z, pressure.get(first[side] + node + 1, 0.0)))
    with written(PRESSURE) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("gear", "pair", "arc [mm]", "z [mm]", "pressure [MPa]"))
        out.writerows([(side, order, f"{s:.5g}", f"{z:.5g}", f"{p:.5g}") for side, order, s, z, p in rows])


def nodal_pressure(path):
    """Contact pressure by node from CalculiX's ``.frd`` file: the fourth value of its last CONTACT block."""
    found, inside = {}, False
    for line in Path(path).read_text(encoding="ascii", errors="replace").splitlines():
        if line.startswith(" -4"):
            inside = "CONTACT" in line
        elif inside and line.startswith(" -1"):
            found[int(line[3:13])] = float(line[13 + 36 : 13 + 48])
        elif line.startswith(" -3"):
            inside = False
    return found


def wanted():
    """(name, mesh) of all runs in order of importance: one mesh of everything first, then the studies of convergence."""
    runs = [(name, LINE_MESHES[0]) for name in lines()]
    main = [(name, case.meshes[0]) for name, case in cases().items()]
    runs += main + [(name, mesh) for name, case in cases().items() for mesh in case.meshes if (name, mesh) not in main]
    return runs + [(name, LINE_MESHES[1]) for name in lines()]


def stored():
    """Rows of the table by (case, mesh)."""
    if not TABLE.exists():
        return {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        return {(row["case"], row["mesh"]): row for row in csv.DictReader(file)}


def reference():
    """Compute the runs that the table lacks, each kept at once; without CalculiX say so and compute nothing."""
    if not shutil.which("ccx"):
        print("  CalculiX (ccx) is not installed: the committed rows are kept (Debian: apt-get install calculix-ccx)")
        return
    for name, mesh in wanted():
        if (name, told(mesh)) not in stored():
            keep((line_row if name in lines() else contact_row)(name, mesh))


def keep(row):
    """Append a row to the table."""
    known = stored()
    with written(TABLE) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows([*known.values(), row])
    print(f"  {row['case']}, {row['mesh']}: {100 * apart(row):+.2f} %, {float(row['seconds']):.0f} s", flush=True)
    sys.stdout.flush()


def apart(row):
    """Relative difference of a row, ours over theirs."""
    return float(row["ours"]) / float(row["theirs"]) - 1


TEXT = f"""
CalculiX is an independent finite-element code. gearfe writes its decks (`gearfe.write_contact_inp` with `face`, and
`gearfe.write_line_inp`): both whole gears with all teeth, of their finite width, bores (of a ring the outside) held, in 20-node
hexahedra with reduced integration (C3D20R); a gear with pits in second-order tets (C3D10) with the pits cut out as holes. What
the two have in common is the shape of the gears and where they stand; stiffness, contact, load sharing, half-space and what pits
do are CalculiX's own. `ritz3d` has pits as lost contact.

In contact: 13/16 teeth (in a ring 13/36), m_n 2 mm, b 6 mm, 15 degrees unless spur, {LOAD:g} N/mm, phase 0.45, tooth 0 of the
pinion damaged; the gears are turned by the approach that `ritz3d` finds, frictionless surface-to-surface contact of all flanks,
large displacements. k is force over approach. Under a line load: the deflection of a strip of pressure under itself.
`per_width`: edges per Hertz half width; `layers` of elements along the width (3 unless said), `refine` divides all edges. Forces
apart: of `T1 / r_b1` and `T2 / r_b2`, which only tip corners off the line of action part. Seconds: of the processor, one thread.
Displacement-based elements are too stiff where they are too coarse: CalculiX's k falls, and its deflection grows, as the mesh is
refined.

Which differences are of the mesh: the healthy helical pair shows how far a mesh is from its limit. With pits there is one
coarse mesh of tets so far, straight and coarse at the crack's tip; no second one says whether it is near its limit, so its
difference is no verdict yet.

`python -m validation outsider_three` makes this page from its table; `--reference` computes what the table lacks where `ccx` is
installed, run by run.
"""

PRESSED = """
Contact pressure on the pinion's flanks of the healthy helical pair, all teeth laid over each other, each picture with a scale of
its own. Where they touch agrees: the line of pair 0 across the whole width, that of pair 1 up to the tip corner, and the corner
itself beyond it, which `ritz3d` carries by rows of their own that are not drawn. The values do not compare: on these
coarse faces few of CalculiX's contact points carry, with pressures far above Hertz's; the likely cause is that contact is
enforced at more points than the faces can follow. The approach sees their mean.
"""


def page():
    """The page, from its tables alone."""
    known = stored()
    lines_ = [
        "# Three dimensions, judged by an outsider",
        "",
        "Made by `python -m validation outsider_three`.",
        *TEXT.splitlines(),
    ]
    lines_ += ["", *_table("k [N/um]", [row for row in known.values() if row["case"] in cases()])]
    lines_ += ["", *_table("deflection [nm/N]", [row for row in known.values() if row["case"] in lines()])]
    missing = [f"{name} ({told(mesh)})" for name, mesh in wanted() if (name, told(mesh)) not in known]
    finest = {}
    for row in known.values():
        if row["case"] not in finest or float(row["nodes"]) > float(finest[row["case"]]["nodes"]):
            finest[row["case"]] = row
    away = {name: apart(row) for name, row in finest.items()}
    worst = max(away, key=lambda name: abs(away[name]))
    lines_ += ["", f"On the finest mesh of each case the difference is at most {100 * abs(away[worst]):.2f} % ({worst})."]
    beyond = [name for name, value in away.items() if abs(value) > ASKED]
    if beyond:
        lines_ += [f"Beyond the {100 * ASKED:g} % asked for: {'; '.join(beyond)}."]
    if missing:
        lines_ += ["", f"Not computed yet: {'; '.join(missing)}."]
    if PRESSURE.exists():
        lines_ += ["", *PRESSED.strip().splitlines(), ""]
        lines_ += [f"![contact pressure side by side]({PICTURE.name})"]
    return "\n".join(lines_) + "\n"


def picture(path):
    """Contact pressure on the unrolled flank of the pinion, all its teeth laid over each other: CalculiX left, `ritz3d` right."""
    from matplotlib.figure import Figure

    case = cases()[SHOWN]
    gear, b = case.pair.gear_1, case.pair.gear_1.b
    place = np.meshgrid(np.linspace(0.0, b, 241), np.linspace(arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a), 321))
    both = theirs_at(*place), ours_at(case, *place)
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    for axes, values, name in zip(figure.subplots(1, 2, sharey=True), both, ("CalculiX, at its nodes", "ritz3d"), strict=True):
        drawn = axes.pcolormesh(*place, values, vmin=0.0, cmap="viridis", rasterized=True)
        figure.colorbar(drawn, ax=axes, label="contact pressure [MPa]")
        axes.set_title(f"{name}: 0 to {values.max():.0f} MPa", fontsize=10)
        axes.set_xlabel("along the width [mm]")
    figure.axes[0].set_ylabel("arc along the pinion's flank [mm]")
    with written(path) as name:
        figure.savefig(name, dpi=130)


def theirs_at(z, arc):
    """CalculiX's pressure [MPa] at places of the pinion's flank, linear between nodes."""
    from scipy.interpolate import LinearNDInterpolator

    _, order, at, height, pressure = np.loadtxt(PRESSURE, delimiter=",", skiprows=1, unpack=True)
    found = [LinearNDInterpolator(np.array([height, at]).T[order == k], pressure[order == k])(z, arc) for k in np.unique(order)]
    return np.nan_to_num(np.array(found)).max(axis=0)


def ours_at(case, z, arc):
    """Pressure of `ritz3d` [MPa] at the same places: Hertz's ellipse across each cell of the contact lines."""
    found = pair_stiffness3d(case.pair, LOAD * case.pair.gear_1.b, STEEL, [case.phase]).cells[0]
    depth, out = found.z, np.zeros(z.shape)
    for order in np.unique(found.order):
        own = np.flatnonzero((found.order == order) & (found.load > 0) & np.isfinite(found.pressure))
        if not own.size:
            continue
        near = own[np.abs(depth[own, None] - z[0]).argmin(axis=0)]
        inside = np.abs(depth[near] - z[0]) <= found.width[near]
        half = 2 * found.load[near] * math.cos(case.pair.gear_1.beta_b) / found.width[near] / (math.pi * found.pressure[near])
        away = (arc - arc_at(case.pair.gear_1, found.roll_1[near])) / half
        height = np.where(inside, found.pressure[near], 0.0)
        out = np.maximum(out, height * np.sqrt(np.maximum(1 - away**2, 0.0)))
    return out


def _table(quantity, rows):
    names = ("case", "mesh", "nodes", f"`ritz3d`, {quantity}", "CalculiX", "difference", "forces apart", "seconds")
    yield "| " + " | ".join(names) + " |"
    yield "|---" * len(names) + "|"
    for row in sorted(rows, key=lambda row: [*lines(), *cases()].index(row["case"])):
        cells = [row["case"], row["mesh"], f"{int(row['nodes']):,}", row["ours"], row["theirs"], f"{100 * apart(row):+.2f} %"]
        yield "| " + " | ".join([*cells, f"{100 * float(row['forces apart']):+.2f} %", f"{float(row['seconds']):.0f}"]) + " |"


def run():
    """Write the page and its picture from the tables."""
    if PRESSURE.exists():
        picture(PICTURE)
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}")
