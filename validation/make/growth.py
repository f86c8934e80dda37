"""Page `growth`: stress intensity of polyline cracks by three methods, and crack paths in thin rims by bore support."""

import math
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gearfe as gf
from gearfe.core.files import save_figure
from gearfe.flexibility.finite_elements.fe import EDGES
from gearfe.flexibility.finite_elements.one_tooth import edge_lengths, narrow_load
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.tooth.drawing import outline_points
from gearfe.geometry.tooth.profile import arc_at, fillet_length
from gearfe.strength.tip_response import WIDE, fe_response, ritz_response

from ..shared import kept_rows, page
from ..shared.decks import calculix, installed
from ..shared.places import PAGES

STEEL = gf.Material(E=206e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
GEAR = gf.Gear(z=21, r_bore=9.2, **RACK)
CASE = gf.Case(gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK)), 2000.0, STEEL)
SEEDS, LOADED = 100, (-1, 0, 1)
ROLL = np.array([GEAR.roll_f + 0.6 * (GEAR.roll_a - GEAR.roll_f)])  # place of the load on each tooth [mm]
STEPS_FILED = (1, 3, 5, 8, 11)  # steps of the path that CalculiX computes
FITTED = 0.03, 0.15  # distances from the tip [mm] of the opening that gives K; parts are 0.25 mm long
RATIOS, FREE, PARTS = (3.3, 1.0, 0.5, 0.4, 0.3), (0, 30, 60, 90, 120, 180), (0.9, 0.7, 0.5, 0.3, 0.1)
NASA = {3.3: "TTTTT", 1.0: "TTTTT", 0.3: "RRRRR"}
CURA = {3.3: "TTTTT", 1.0: "TTTRR", 0.5: "TRRRR", 0.4: "RRRRR", 0.3: "RRRRR"}
LETTER = {"tooth lost": "T", "rim cut": "R", "arrested": "A", "unfinished": "U"}


def random_polyline(seed):
    """Return a crack of two to four parts of 0.25 modules from the default start."""
    rng = np.random.default_rng(seed)
    x, y = crack_path(GEAR, gf.Crack(length=0.1)).T[0]
    points, heading = [], math.radians(rng.uniform(150, 250))
    for _ in range(rng.integers(2, 5)):
        heading += math.radians(rng.uniform(-25, 25))
        x, y = x + 0.5 * math.cos(heading), y + 0.5 * math.sin(heading)
        points.append((x, y))
    return gf.Crack(path=points)


def polyline_row(seed):
    """Return the largest difference of K between `ritz` and `fe` under loads on three teeth [% of K under its own load]."""
    crack, carried = random_polyline(seed), (GEAR.roll_f + 0.1 * (GEAR.roll_a - GEAR.roll_f), GEAR.roll_a)
    ritz = ritz_response(GEAR, STEEL, crack, LOADED, 1.0)
    fe = fe_response(GEAR, STEEL, crack, LOADED, 1.0, carried)
    found = np.array([[one.under[tooth](ROLL)[0, -2:] for tooth in LOADED] for one in (ritz, fe)])
    return {"off_percent": 100 * float(np.abs(found[0] - found[1]).max() / np.hypot(*found[1, 1]))}


def calculix_row(step):
    """Return K of one step of a path by `ritz`, and by CalculiX from the opening of quarter points [MPa sqrt(mm)]."""
    model = gf.CrackModel(loading="single", method="ritz")
    grown = gf.grow_crack(CASE, gf.Crack(length=0.4, angle=math.radians(20)), step=0.25, steps=step, model=model)
    roll, line = CASE.pair.path[0] + CASE.pair.p_bt, CASE.force / GEAR.b
    edge = edge_lengths(GEAR, EDGES, 1.0)
    edge["fillet"] /= 4
    mesh = section(
        GEAR, {0: stations(GEAR, edge["flank"])}, fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"],
        cracks=[grown.cracks[-1]],
    )  # fmt: skip
    force = line * narrow_load(mesh, 0, float(arc_at(GEAR, roll)), WIDE * GEAR.m_n).toarray()[:, 0]
    found = correlated(mesh, moved_by_calculix(mesh.mesh, force, mesh.seams[0].faces))
    names = "ritz_K_I", "ritz_K_II", "K_I", "K_II"
    values = grown.K_I[-1], grown.K_II[-1], *found
    return {"length": float(grown.length[-1])} | dict(zip(names, map(float, values), strict=True))


def moved_by_calculix(mesh, force, faces):
    """Return displacements of both crack faces ``(2, 2, n)`` [mm] by CalculiX, in plane strain (triangles CPE6)."""
    nodes, held = (
        mesh.doflocs,
        np.unique(np.append(mesh.facets[:, mesh.boundaries["held"]], mesh.nvertices + mesh.boundaries["held"])),
    )
    cells = np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f]).T + 1
    (ax, ay), (bx, by) = (nodes[:, mesh.t[k]] - nodes[:, mesh.t[0]] for k in (1, 2))
    clockwise = ax * by < ay * bx
    cells[clockwise] = cells[clockwise][:, [0, 2, 1, 5, 4, 3]]
    text = ["*NODE, NSET=ALL", *(f"{i}, {x:.12g}, {y:.12g}, 0." for i, (x, y) in enumerate(nodes.T.tolist(), 1))]
    text += ["*ELEMENT, TYPE=CPE6, ELSET=E", *(f"{i}, {', '.join(map(str, cell))}" for i, cell in enumerate(cells.tolist(), 1))]
    text += ["*NSET, NSET=HELD", *(f"{i + 1}," for i in held.tolist())]
    text += ["*NSET, NSET=FACES", *(f"{i + 1}," for i in np.unique(faces).tolist())]
    text += ["*MATERIAL, NAME=M", "*ELASTIC", f"{STEEL.E!r}, {STEEL.nu!r}", "*SOLID SECTION, ELSET=E, MATERIAL=M", "1."]
    text += ["*BOUNDARY", "HELD, 1, 2", "*STEP", "*STATIC", "*CLOAD"]
    text += [f"{i // 2 + 1}, {i % 2 + 1}, {force[i]:.12g}" for i in np.flatnonzero(force).tolist()]
    text += ["*NODE PRINT, NSET=FACES", "U", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / "crack.inp").write_text("\n".join(text), encoding="utf-8")
        calculix(folder, "crack")
        rows = [line.split() for line in (folder / "crack.dat").read_text(encoding="utf-8").splitlines()]
    moved = {int(row[0]) - 1: [float(row[1]), float(row[2])] for row in rows if len(row) == 4 and row[0].isdigit()}
    return np.array([[moved[int(node)] for node in face] for face in faces]).transpose(0, 2, 1)


def correlated(mesh, moved):
    """Return K_I and K_II from the opening of the last straight part, extrapolated linearly to the tip.

    ``K(r) = mu / (kappa + 1) sqrt(2 pi / r) opening(r)``: S. K. Chan, I. S. Tuba, W. K. Wilson, Eng. Fract. Mech. 2 (1970) 1-17.
    """
    line = mesh.mesh.doflocs[:, mesh.seams[0].faces[0]]
    ahead = (line[:, -1] - line[:, -3]) / np.hypot(*(line[:, -1] - line[:, -3]))
    away = np.hypot(*(line - line[:, -1:]))
    used = (away > FITTED[0]) & (away < FITTED[1])
    factor = STEEL.shear_modulus / (4 - 4 * STEEL.nu) * np.sqrt(2 * np.pi / away[used])
    opening = (moved[0] - moved[1])[:, used]
    across = np.array([-ahead[1], ahead[0]])
    return [np.polyfit(away[used], factor * (way @ opening), 1)[1] for way in (across, ahead)]


def rim_case(ratio):
    """Return 28/28 teeth of module 3.175 mm with a pinion of a backup ratio."""
    rack = {"m_n": 3.175, "alpha_n": math.radians(20), "b": 6.35}
    rim = gf.Gear(z=28, r_bore=((14 - 1.25) - ratio * 2.25) * 3.175, **rack)
    return gf.Case(gf.GearPair(rim, gf.Gear(z=28, r_bore=15.0, **rack)), 1500.0, STEEL)


def rim_row(ratio, free, part):
    """Return outcome and path of a crack that starts at a part of the fillet's arc, for a bore free over an arc [degrees]."""
    case = rim_case(ratio)
    held = [(math.radians(free / 2), math.radians(360 - free / 2))] if free else None
    start = gf.Crack(length=0.26, start=part * fillet_length(case.pair.gear_1))
    grown = gf.grow_crack(case, start, step=0.5, model=gf.CrackModel(held=held))
    path = crack_path(case.pair.gear_1, grown.cracks[-1])
    least = float((grown.K_min / grown.K_I).min())
    return {"outcome": grown.outcome, "path": np.round(path, 3).tolist(), "least": least}


def rims(again):
    """Return the rows of the scan, by ratio, free arc and start."""
    return {
        (ratio, free, part): kept_rows.kept(
            "growth_rims", f"{ratio} {free} {part}", lambda key=(ratio, free, part): rim_row(*key), again
        )
        for ratio in RATIOS
        for free in FREE
        for part in PARTS
    }


def picture(rows, free, file):
    """Draw the paths from all starts in the four rims of the tests, for a bore free over an arc [degrees]."""
    figure = Figure(figsize=(10, 2.9), layout="constrained")
    for axes, ratio in zip(figure.subplots(1, 4), (3.3, 1.0, 0.5, 0.3), strict=True):
        gear = rim_case(ratio).pair.gear_1
        axes.plot(*outline_points(gear), color="0.3", linewidth=0.8)
        angle = np.linspace(-0.5, 0.5, 200)
        axes.plot(gear.held * np.sin(angle), gear.held * np.cos(angle), color="0.3", linewidth=0.8)
        for part in PARTS:
            axes.plot(*np.array(rows[ratio, free, part]["path"]), linewidth=1.2)
        axes.set(xlim=(-10, 10), ylim=(max(gear.held, 32) - 1, gear.r_a + 1), aspect="equal", title=f"backup ratio {ratio:g}")
        axes.axis("off")
    save_figure(figure, file, dpi=90)


def run(again=True):
    """Compute the rows and write the page."""
    off = [kept_rows.kept("growth_polylines", str(seed), lambda s=seed: polyline_row(s), again) for seed in range(SEEDS)]
    if not again or installed():
        filed = [kept_rows.kept("growth_calculix", str(n), lambda n=n: calculix_row(n), again) for n in STEPS_FILED]
    else:
        filed = list(kept_rows.stored("growth_calculix").values())
    rows = rims(again)
    picture(rows, 90, PAGES / "growth_rims.png")
    off = np.array([row["off_percent"] for row in off])
    page.write("growth", answer(off, filed, rows), intensity(off, filed), supports(rows), PAPERS)


def letters(rows, ratio, free):
    """Return the outcome from each start as a letter."""
    return "".join(LETTER[rows[ratio, free, part]["outcome"]] for part in PARTS)


def as_nasa(rows, free):
    """Return whether a free arc gives the outcomes of NASA's tests and predictions."""
    return all(letters(rows, ratio, free) == want for ratio, want in NASA.items()) and set(letters(rows, 0.5, free)) == set("TR")


def as_cura(rows, free):
    """Return the number of outcomes, out of 25, that agree with Cura's table."""
    return sum(a == b for ratio, want in CURA.items() for a, b in zip(letters(rows, ratio, free), want, strict=True))


def answer(off, filed, rows):
    """Return the first lines of the page."""
    worst = max(abs(row["ritz_K_I"] / row["K_I"] - 1) for row in filed)
    good = [f"{free}" for free in FREE if as_nasa(rows, free)]
    best = max(FREE, key=lambda free: as_cura(rows, free))
    found = f"with the bore free over {', '.join(good)} degrees under the tooth" if good else "with none of these supports"
    held = {letters(rows, ratio, 0) for ratio in RATIOS}
    always = " A bore held all around loses a tooth at every ratio." if held == {"TTTTT"} else ""
    return (
        f"- K of `ritz` and `fe` differ by at most {off.max():.2f} % on {off.size} random polylines (median "
        f"{np.median(off):.2f} %). K_I of `ritz` and CalculiX differ by at most {100 * worst:.1f} % along a path.\n"
        f"- The failures of NASA's gears are found {found}.{always}\n"
        f"- Of Cura's 25 outcomes, {as_cura(rows, best)} are found with the bore free over {best} degrees, and "
        f"{as_cura(rows, 0)} with a held bore."
    )


def intensity(off, filed):
    """Return the section on stress intensity."""
    lines = ["## Stress intensity", "", POLYLINES.format(off.size)]
    lines += ["", "| differences | cracks |", "|---|---|"]
    for low, high in ((0.0, 0.1), (0.1, 0.3), (0.3, 1.0), (1.0, math.inf)):
        name = f"{low:g} to {high:g} %" if high < math.inf else "above 1 %"
        lines.append(f"| {name} | {int(((off >= low) & (off < high)).sum())} |")
    lines += ["", BY_CALCULIX]
    lines += ["", "| length [mm] | K_I `ritz` | K_II `ritz` | K_I CalculiX | K_II CalculiX |", "|---|---|---|---|---|"]
    names = "ritz_K_I", "ritz_K_II", "K_I", "K_II"
    lines += [f"| {row['length']:.2f} | {' | '.join(f'{row[name]:.1f}' for name in names)} |" for row in filed]
    return lines


def supports(rows):
    """Return the section on the supports of thin rims."""
    lines = ["## Thin rims by the support of the bore", "", "![paths in four rims](growth_rims.png)", "", SUPPORT, ""]
    lines += ["| backup ratio | NASA | Cura | " + " | ".join("held" if not free else f"{free}" for free in FREE) + " |"]
    lines += ["|---" * (3 + len(FREE)) + "|"]
    printed = {3.3: "tooth", 1.0: "tooth", 0.5: "either", 0.3: "rim"}
    for ratio in RATIOS:
        cells = " | ".join(letters(rows, ratio, free) for free in FREE)
        lines.append(f"| {ratio:g} | {printed.get(ratio, '')} | {CURA[ratio]} | {cells} |")
    counts = " | ".join(str(as_cura(rows, free)) for free in FREE)
    lines.append(f"| as Cura, of 25 | | | {counts} |")
    least = min(rows[0.3, 90, part]["least"] for part in PARTS)
    lines += [
        "",
        f"At a ratio of 0.3 and 90 degrees, loads on the next tooth press the crack shut: K_min is down to {least:.1f} K_I.",
    ]
    return lines


POLYLINES = """
The {} cracks have two to four parts of 0.25 modules, with turns of up to 25 degrees. Three teeth carry loads. `ritz` and `fe`
share the profile, the path and the formula of the interaction integral. The differences are relative to K under the load on the
cracked tooth.
"""
BY_CALCULIX = """
CalculiX solves a mesh of `fe` with triangles CPE6. Its K follows from the opening of the faces at 0.03 to 0.15 mm from the tip,
extrapolated to the tip by a line. The path is grown by `ritz`, with the load at the highest point of single contact:
"""
SUPPORT = """
The gears have 28 teeth of module 3.175 mm and a rigid hub. Module and tooth form are assumed. The bore is free over an arc of
30 to 180 degrees, symmetric about the cracked tooth. The five letters are starts at 0.9, 0.7, 0.5, 0.3 and
0.1 of the arc of the fillet, from its upper end down. T: the tooth is lost. R: the rim is cut. The picture is for 90 degrees.
Neither report prints its support. Cura's gear data were not available. The gear of NASA replaces it, with a ratio of 3.3 for
the full gear and the five starts for A to E.
"""
PAPERS = """
D. G. Lewicki, R. Ballarini, NASA TM-107229 (1996): ratios of 3.3 and 1.0 lost teeth and 0.3 broke the rim, in tests and
predictions. At 0.5 the tests broke rims, and the predictions were either. F. Cura, A. Mura, C. Rosso, Frattura ed Integrita
Strutturale 30 (2014) 446-453, Table 3.
"""


def cheap():
    """Yield the cheap rows: (name, stored numbers, function that computes them)."""
    return [
        (f"rim {key}", {"outcome": row["outcome"]}, lambda key=key: rim_row(*map(float, key.split())))
        for key, row in kept_rows.stored("growth_rims").items()
        if key.startswith("0.3")  # longer cracks of thicker rims are not cheap
    ]
