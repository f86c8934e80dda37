"""Part of the page `flanks.md`: a helical pair with modified flanks and axes askew, against CalculiX in three dimensions.

The runs take minutes each; rows on file are kept, so that a run can be stopped and continued.
"""

import csv
import shutil
import tempfile
from pathlib import Path

import gearfe as gf
from gearfe.files import written

from ..shared import outsider
from ..shared.places import TABLES

CSV = TABLES / "flanks_three.csv"
HEADER = ("case", "phase", "per_width", "nodes", "seconds", "te_um", "calculix_N", "forces_apart")
LOAD = 300.0  # N/mm
RUNS = tuple(
    (case, phase, mesh) for mesh in (1.0, 1.5) for case in ("crowned, relieved, askew", "involutes") for phase in (0.45, 0.1)
)


def case_of(name):
    """Pair of 13/16 teeth at 15 degrees, 6 mm wide, and what its flanks and axes are like, as options of `mesh_stiffness`."""
    pair = outsider.pair_of(15.0)
    if name == "involutes":
        return pair, {}
    relief = {"tip_relief": 0.008, "tip_start_roll": pair.gear_1.roll_a - 2.0, "tip_exponent": 2.0}
    flanks = {"pinion": gf.Flank(lead_crowning=0.006, **relief), "wheel": gf.Flank(lead_crowning=0.004)}
    return pair, {"flanks": flanks, "misalignment": gf.Misalignment(F_beta=0.008)}


def solved(name, phase):
    """Curve of `ritz3d` at one phase."""
    pair, flanks = case_of(name)
    return gf.mesh_stiffness(pair, LOAD * pair.gear_1.b, outsider.STEEL, method="ritz3d", phases=[phase], **flanks)


def calculix(name, phase, per_width):
    """Row of the table: the transmission error [um] of `ritz3d` under the load, and the load [N] that CalculiX finds at it."""
    pair, flanks = case_of(name)
    te = round(1e6 * float(solved(name, phase).te[0]), 4)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        options = {"face": "helical", "per_width": per_width, **flanks}
        steels = (outsider.STEEL, outsider.STEEL)
        deck = gf.write_contact_inp(folder / "pair.inp", pair, phase, 1e-3 * te, LOAD, steels, **options)
        seconds = outsider.calculix(folder, "pair")
        first, second = deck.forces(folder / "pair.dat")
    nodes = sum(part.points.shape[1] for part in deck.parts)
    return name, phase, per_width, nodes, round(seconds, 1), te, (first + second) / 2, first / second - 1


def read():
    """Committed rows by case, phase and mesh."""
    if not CSV.is_file():
        return {}
    with CSV.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {(row["case"], float(row["phase"]), float(row["per_width"])): row for row in rows}


def reference():
    """Compute the rows that are not on file, if CalculiX is installed."""
    for case in RUNS:
        if case in read() or not shutil.which("ccx"):
            continue
        row = dict(zip(HEADER, (f"{v:.8g}" if isinstance(v, float) else v for v in calculix(*case)), strict=True))
        rows = [*read().values(), row]
        with written(CSV) as name, open(name, "w", encoding="utf-8", newline="") as file:
            out = csv.DictWriter(file, HEADER, lineterminator="\n")
            out.writeheader()
            out.writerows(rows)
        print(f"  CalculiX, {case}: {row['calculix_N']} N", flush=True)


def differences(row):
    """Error under load and deflection [um] by `ritz3d` today and by CalculiX at the same load, and the larger load share."""
    pair, _ = case_of(row["case"])
    curve = solved(row["case"], float(row["phase"]))
    lacking = LOAD * pair.gear_1.b - float(row["calculix_N"])
    theirs = float(row["te_um"]) + 1e6 * lacking / float(curve.k_tangent[0])
    ours = 1e6 * float(curve.te[0])
    unloaded = 0.0 if curve.unloaded is None else 1e6 * float(curve.unloaded[0])
    return ours, theirs, ours - unloaded, theirs - unloaded, float(curve.share[0].max())


def text():
    """Lines of the page."""
    known = outsider.stored()
    apart = [outsider.apart(known[outsider.SHOWN, outsider.told(mesh)]) for mesh in outsider.STRIP]
    lines = [
        "## Three dimensions beside CalculiX",
        "",
        f"A helical pair 13/16 of m 2, 15 degrees, 6 mm wide, {LOAD:g} N/mm. Its flanks: lead crowning of 6 um (pinion) and 4 um",
        "(wheel), a parabolic tip relief of 8 um over 2 mm of roll length on the pinion, and axes askew by F_beta = 8 um, which",
        "presses it at one end. CalculiX: both whole gears in 20-node hexahedra whose nodes lie on the modified flanks,",
        'surface-to-surface contact, large displacements (`gf.write_contact_inp(face="helical", flanks=..., misalignment=...)`).',
        "Involutes by the same meshes show what of a difference is the mesh's: at phase 0.45 k differs by",
        f"{100 * apart[0]:+.2f} % with one edge per half width and by {100 * apart[1]:+.2f} % with 1.5 ([three.md](three.md)).",
        "",
        "| flanks | phase | edges per half width | nodes | error, `ritz3d` [um] | CalculiX [um] | its part |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in read().values():
        ours, theirs, _, reference, _ = differences(row)
        lines.append(
            f"| {row['case']} | {float(row['phase']):g} | {float(row['per_width']):g} | {row['nodes']} | "
            f"{ours:.3f} | {theirs:.3f} | {100 * (ours - theirs) / reference:+.2f} % |"
        )
    return lines


def worst():
    """Largest difference of the deflections, relative."""
    found = (differences(row) for row in read().values())
    return max(abs((ours - theirs) / reference) for ours, theirs, _, reference, _ in found)
