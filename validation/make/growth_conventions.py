"""Page `growth_conventions`: stiffness and life of straight cracks at assumed angles, and of the computed path."""

import math
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import gearfe as gf
from gearfe.core.files import save_figure
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.tooth.profile import lengths
from gearfe.strength.growth import _loads, _single, _Tip
from gearfe.strength.paris import cycles_along

from ..shared import kept_rows, page
from ..shared.places import PAGES

TEETH, RIMS, ANGLES = (18, 31, 60), (0.8, 1.5, 3.0), (5, 15, 30, 45, 60, 75, 90)
LOADINGS = {"engagement": "moving over the engagement", "single": "at the highest point of single contact"}
FIRST, LAST = 0.15, 0.6  # first length [m_n]; last length relative to the tooth chord at the start of the crack
STEPS, LAW = 8, gf.ParisLaw(5.21e-13, 3.0)
MODULE = 2.0
STEEL = gf.Material(E=206e3, nu=0.3)


def pair_case(z, rim):
    """Return a pair with a 40-tooth wheel. The pinion has a backup ratio, or a larger bore of 0.3 times its root."""
    rack = {"m_n": MODULE, "alpha_n": math.radians(20), "b": 20.0}
    root = (z / 2 - 1.25) * MODULE
    pinion = gf.Gear(z=z, r_bore=max(root - rim * 2.25 * MODULE, 0.3 * root), **rack)
    return gf.Case(gf.GearPair(pinion, gf.Gear(z=40, r_bore=15.0, **rack)), 2000.0, STEEL)


def sizes(case):
    """Return the crack lengths [mm] at which K is computed, for straight cracks and along the path."""
    chord = 2 * abs(crack_path(case.pair.gear_1, gf.Crack(length=FIRST * MODULE))[0, 0])
    return np.linspace(FIRST * MODULE, LAST * chord, STEPS + 1)


def life_row(z, rim, loading):
    """Return the life of straight cracks over that of the computed path, by angle, and the path's final angle [degrees]."""
    case, model = pair_case(z, rim), gf.CrackModel(loading=loading)
    gear, size = case.pair.gear_1, sizes(case)
    grown = gf.grow_crack(case, gf.Crack(length=size[0]), step=size[1] - size[0], steps=STEPS, law=LAW, model=model)
    tip = _Tip(gear, STEEL, model, _loads(case, 0) if loading == "engagement" else _single(case, 0), 1.0)
    ratio = []
    for angle in ANGLES:
        found = np.array([tip.intensity(gf.Crack(length=one, angle=math.radians(angle))) for one in size])
        ratio.append(float(cycles_along(LAW, size, found[:, 0], found[:, 2])[-1] / grown.cycles[-1]))
    path = crack_path(gear, grown.cracks[-1])
    end = math.degrees(math.atan2(*(path[:, -2] - path[:, -1])))
    return {"ratio": ratio, "end_degrees": end, "outcome": grown.outcome, "length": float(lengths(path)[-1])}


def stiffness_row(z, rim):
    """Return the largest loss of k [%] of straight cracks of the final length, by angle, and of the computed path."""
    case = pair_case(z, rim)
    size = sizes(case)
    grown = gf.grow_crack(case, gf.Crack(length=size[0]), step=size[1] - size[0], steps=STEPS)
    run = gf.Solve(method="ritz", span="tooth", phases=32)
    straight = [gf.Crack(length=size[-1], angle=math.radians(angle)) for angle in ANGLES]
    sound = gf.solve(case, run).k
    losses = [
        float(100 * (1 - gf.solve(replace(case, damage={"pinion": [crack]}), run).k / sound).max())
        for crack in (grown.cracks[-1], *straight)
    ]
    return {"path": losses[0], "straight": losses[1:]}


def run(again=True):
    """Compute the rows and write the page."""
    table = "growth_conventions"
    life = {
        (z, rim, loading): kept_rows.kept(table, f"life {z} {rim} {loading}", lambda key=(z, rim, loading): life_row(*key), again)
        for z in TEETH
        for rim in RIMS
        for loading in LOADINGS
    }
    loss = {
        (z, rim): kept_rows.kept(table, f"k {z} {rim}", lambda key=(z, rim): stiffness_row(*key), again)
        for z in TEETH
        for rim in RIMS
    }
    picture(life, loss)
    page.write(table, answer(life, loss), HOW, by_life(life), by_stiffness(loss))


def answer(life, loss):
    """Return the first lines of the page."""
    ratio = np.array([row["ratio"] for row in life.values()])
    off = np.array([np.subtract(row["straight"], row["path"]) for row in loss.values()])
    lines = []
    for angle in (45, 60):
        life_of, off_of = ratio[:, ANGLES.index(angle)], off[:, ANGLES.index(angle)]
        lines.append(
            f"- A straight crack at {angle} degrees has {life_of.min():.2f} to {life_of.max():.2f} times the life of the path. "
            f"Its largest loss of stiffness differs by {off_of.min():+.1f} to {off_of.max():+.1f} points of a percent."
        )
    lines.append(
        f"- Over all angles from 5 to 90 degrees, the life is {ratio.min():.2f} to {ratio.max():.2f} times that of the path."
    )
    return "\n".join(lines)


def by_life(life):
    """Return the table of the life."""
    lines = ["## Life", "", "Revolutions of a straight crack over those of the computed path:", ""]
    lines += ["| teeth | backup ratio | load | end [degrees] | " + " | ".join(f"{angle}" for angle in ANGLES) + " |"]
    lines += ["|---" * (4 + len(ANGLES)) + "|"]
    for (z, rim, loading), row in life.items():
        cells = " | ".join(f"{value:.2f}" for value in row["ratio"])
        lines.append(f"| {z} | {rim:g} | {LOADINGS[loading]} | {row['end_degrees']:.0f} | {cells} |")
    return lines


def by_stiffness(loss):
    """Return the table of the stiffness."""
    lines = [
        "## Stiffness",
        "",
        "Largest loss of k of the path, and what straight cracks of the same length change [points]:",
        "",
    ]
    lines += ["| teeth | backup ratio | path | " + " | ".join(f"{angle}" for angle in ANGLES) + " |"]
    lines += ["|---" * (3 + len(ANGLES)) + "|"]
    for (z, rim), row in loss.items():
        cells = " | ".join(f"{value - row['path']:+.1f}" for value in row["straight"])
        lines.append(f"| {z} | {rim:g} | {row['path']:.1f} % | {cells} |")
    return lines


def picture(life, loss):
    """Draw both maps."""
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    one, two = figure.subplots(1, 2)
    ratio = np.array([row["ratio"] for row in life.values()])
    names = [f"z {z}, rim {rim:g}, {loading}" for z, rim, loading in life]
    off = np.array([np.subtract(row["straight"], row["path"]) for row in loss.values()])
    _map(figure, one, np.log2(ratio), names, "binary logarithm of the life over that of the path")
    _map(figure, two, off, [f"z {z}, rim {rim:g}" for z, rim in loss], "error of the largest loss of k [points]")
    save_figure(figure, PAGES / "growth_conventions.png", dpi=90)


def _map(figure, axes, values, names, title):
    most = np.abs(values).max()
    shown = axes.imshow(values, cmap="RdBu_r", vmin=-most, vmax=most, aspect="auto")
    axes.set_xticks(range(len(ANGLES)), [f"{angle}°" for angle in ANGLES])
    axes.set_yticks(range(len(names)), names, fontsize=7)
    axes.set(xlabel="angle between crack and centre-line", title=title)
    figure.colorbar(shown, ax=axes)


HOW = f"""
![maps of the errors](growth_conventions.png)

`python -m validation growth_conventions` computes the page. All cracks start at the 30-degree tangent of the pinion, of module
{MODULE:g} mm. The wheel has 40 teeth, and the load is 2000 N on 20 mm. The path starts with {FIRST:g} modules at 45 degrees. It
ends at {LAST:g} of the chord of the tooth at the start of the crack, as the straight cracks do. Lives are from the first length
to the last, by Paris's law with an exponent of 3 and without a threshold. The bore is held all around. Its radius is at least
0.3 of the root circle, which limits the backup ratio of 18 teeth. The path ends at the stated angle to the centre-line.
"""
