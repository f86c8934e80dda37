"""Three dimensions judged by an outsider: the page and its picture, from the tables of `validation.shared.outsider` alone."""

import math
from pathlib import Path

import numpy as np

from gearfe.contact.solid import pair_stiffness3d
from gearfe.files import written
from geometry.tooth.profile import arc_at

from ..shared.outsider import ASKED, LOAD, PRESSURE, SHOWN, STEEL, apart, cases, lines, reference, stored, told, wanted
from ..shared.places import PAGES

__all__ = ["page", "reference", "run"]

PAGE = PAGES / "outsider_three.md"
PICTURE = PAGES / "outsider_three_pressure.png"
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

Which differences are of the mesh: the healthy helical pair shows how far a mesh is from its limit, and of every case but it
there are two meshes where the table has them. With pits the meshes are tets, straight, and coarse at the crack's tip. Contact
in CalculiX is a bed of springs, so that its k is too low by about 0.07 %: see [truth.md](truth.md). Before loads were mirrored
in the free end faces `ritz3d` was 0.3 % stiffer for the spur pair (97.31 instead of 97.03 N/um) and 0.2 % for the helical one.

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
