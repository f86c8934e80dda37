"""Part of the page `flanks.md`: a helical pair with modified flanks and axes askew, against CalculiX in three dimensions."""

import gearfe as gf

from ..shared import outsider
from ..shared.decks import pressed
from ..shared.kept_rows import kept, stored

TABLE = "flanks_three"
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
    flanks = {"pinion": gf.Flank(helix_crowning=0.006, **relief), "wheel": gf.Flank(helix_crowning=0.004)}
    return pair, {"flanks": flanks, "misalignment": gf.Misalignment(F_beta_x=0.008)}


def solved(name, phase):
    """Curve of `ritz3d` at one phase."""
    pair, flanks = case_of(name)
    return gf.mesh_stiffness(pair, LOAD * pair.gear_1.b, outsider.STEEL, method="ritz3d", phases=[phase], **flanks)


def told(run):
    """Name of a run's row."""
    name, phase, per_width = run
    return f"{per_width:g} edges, {name}, phase {phase:g}"


def deck_of(folder, run, approach):
    """Deck of a run closed by an approach [um], in a folder."""
    name, phase, per_width = run
    pair, flanks = case_of(name)
    options = {"face": "helical", "per_width": per_width, **flanks}
    steels = outsider.STEEL, outsider.STEEL
    return gf.write_contact_inp(folder / "pair.inp", pair, phase, 1e-3 * approach, LOAD, steels, **options)


def row_of(run):
    """The transmission error [um] of `ritz3d` under the load, and the load [N] that CalculiX finds at it."""
    approach = round(1e6 * float(solved(*run[:2]).te[0]), 4)
    row, _ = pressed(lambda folder: deck_of(folder, run, approach))
    return row | {"approach": approach, "load": float(f"{row.pop('force'):.8g}")}


def reference():
    """Compute the rows of the finest mesh, the others only if they are not on file."""
    for run in RUNS:
        kept(TABLE, told(run), lambda run=run: row_of(run), again=run[2] == RUNS[-1][2])


def differences(run, row):
    """Error under load and deflection [um] by `ritz3d` today and by CalculiX at the same load, and the larger load share."""
    pair, _ = case_of(run[0])
    curve = solved(*run[:2])
    lacking = LOAD * pair.gear_1.b - row["load"]
    theirs = row["approach"] + 1e6 * lacking / float(curve.k_tangent[0])
    ours = 1e6 * float(curve.te[0])
    unloaded = 0.0 if curve.unloaded is None else 1e6 * float(curve.unloaded[0])
    return ours, theirs, ours - unloaded, theirs - unloaded, float(curve.share[0].max())


def text():
    """Lines of the page."""
    known = outsider.stored()
    apart = [outsider.apart(known[outsider.SHOWN, outsider.told(mesh)]) for mesh in outsider.STRIP]
    lines = [
        f"""
        ## Three dimensions beside CalculiX

        A helical pair 13/16 of m 2, 15 degrees, 6 mm wide, {LOAD:g} N/mm. Its flanks: lead crowning of 6 um (pinion) and 4 um
        (wheel), a parabolic tip relief of 8 um over 2 mm of roll length on the pinion, and axes askew by F_beta_x = 8 um, which
        presses it at one end. CalculiX: both whole gears in 20-node hexahedra whose nodes lie on the modified flanks,
        surface-to-surface contact, large displacements (`gf.write_contact_inp(face="helical", flanks=...,
        misalignment=...)`). Involutes by the same meshes show what of a difference is the mesh's: at phase 0.45 k differs by
        {100 * apart[0]:+.2f} % with one edge per half width and by {100 * apart[1]:+.2f} % with 1.5 ([three.md](three.md)).

        | flanks | phase | edges per half width | nodes | error, `ritz3d` [um] | CalculiX [um] | its part |
        |---|---|---|---|---|---|---|
        """
    ]
    rows = stored(TABLE)
    for run in RUNS:
        row = rows[told(run)]
        ours, theirs, _, reference, _ = differences(run, row)
        lines.append(
            f"| {run[0]} | {run[1]:g} | {run[2]:g} | {row['nodes']} | "
            f"{ours:.3f} | {theirs:.3f} | {100 * (ours - theirs) / reference:+.2f} % |"
        )
    return lines


def worst():
    """Largest difference of the deflections, relative."""
    rows = stored(TABLE)
    found = (differences(run, rows[told(run)]) for run in RUNS)
    return max(abs((ours - theirs) / reference) for ours, theirs, _, reference, _ in found)
