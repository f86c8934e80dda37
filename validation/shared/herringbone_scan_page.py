# ruff: noqa: E501 lines of Markdown
"""The page of the scan, from its tables alone."""

import csv
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import gearfe as gf
from gearfe.comparison.case_table import damage_cycle
from gearfe.core.units import NEWTON_PER_UM, in_newton_per_um

from . import herringbone_scan
from .herringbone_scan import GROUPS, NAME, RANGES, READINGS, SCENE, Reading, load, table
from .herringbone_scan_sets import CLAIM, WIDER, Scan, printed, rows, sets
from .places import TABLES

CHECKED = 10  # readings solved directly, besides those that agree
NAMES = {"printed": "foundation for both gears, as S4 prints it", "external": "no foundation of the ring"}
PAGE = """
## Under which unprinted values formulas and finite elements agree

{paragraph}

![agreement against stiffness](tables/{name}.png)

### What was scanned

{size} readings of a scrambled Sobol sequence over {dimensions} unprinted values; in {refused} of them the crack leaves no section of
the tooth's tip or cuts the body, and `published` or `ritz3d` has no value. Nothing is fitted to S4: the ranges are set beforehand. Pits lie in rows along the axis in one half, as in the scene; other layouts: above.

{ranges}

The reference is `ritz3d`, {fe}. It is interpolated from {nodes} solves with order 2 (`{name}_nodes.csv`): in bores and crack
length jointly, by groups of crack angle, crack start and face width; load, rack tip radius, rim and pits as factors, each
measured alone. At the scene's own reading it is the committed `ritz3d` of full order, which takes {anchor} off the solves.
{checks} `published` and `textbook` are evaluated for every reading; `textbook` is beyond 3 % in the healthy row of sun and
planet in all but {textbook} of them.

### Which readings bear what

| set | {first} | {second} |
|---|---|---|
{sets}

'Printed stiffness' is taken after the correction of the swapped rows, of the pair or, where 60 mm are those of a half, of one half,
whichever is nearer; both the column of the formulas (ours: `published`) and of finite elements (`ritz3d`).

### The ten rows under the best reading that agrees, and under the default

Best (reading {best}): {best_text}. Default: the scene's assumptions (bores of half the root radius), finite elements on file.

| pair | case | S4 formulas | FE [N/um] | S4 error | best: `published` | `ritz3d` [N/um] | error | without the ring's foundation | default: `published` | `fe3d` [N/um] | error | without the ring's foundation |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
{ten}

### Agreement in the mean is no agreement

In the readings whose ten means agree below 3 %, at six phases of the cycle (as many tooth pairs as ever touch, or one less; 'none'
where no phase has fewer):

| row | error of the mean | where most pairs touch | where one less touches | of the maximum | at the worst phase | reduction by `ritz3d`, printed |
|---|---|---|---|---|---|---|
{zones}
"""


def to_check():
    """Numbers of readings to solve directly: those that agree, and the first `CHECKED` others."""
    scan = Scan()
    valued = np.isfinite(scan.mean["printed"]).all(axis=1)
    numbers = scan.column("number").astype(int)
    return [*numbers[scan.agree("printed")].tolist(), *numbers[valued][:CHECKED].tolist()]


def checked(scan):
    """Numbers of the readings solved directly, and the errors ``(n, 10)`` [%] of the interpolation there, its anchor taken off."""
    anchor = herringbone_scan.Ritz3D().anchor
    taken = np.array([anchor[key] for key in herringbone_scan.rows()])
    place = {int(number): i for i, number in enumerate(scan.column("number"))}
    found = [row for row in load("_checks") if int(row["number"]) in place]
    direct = np.array([[float(row[f"{pair} {case}"]) for pair, case in rows()] for row in found])
    ours = np.array([scan.mean["ritz3d"][place[int(row["number"])]] for row in found])
    if not found:
        raise RuntimeError("no reading was solved directly: run python -m validation herringbone")
    both = (np.isfinite(ours) & np.isfinite(direct)).all(axis=1)  # a crack that cuts the body has no value in one row of ten
    return [int(row["number"]) for row, there in zip(found, both, strict=True) if there], 100 * (ours / taken / direct - 1)[both]


def bore_factor(ritz=None):
    """By how much k of the healthy sun and planet grows from bores of 0.33 to 0.85 of the root radius."""
    ritz, base = ritz or herringbone_scan.Ritz3D(), herringbone_scan.SCENE_READING
    low, high = (ritz.stiffness(replace(base, sun=q, planet=q), "sun_planet", None).mean() for q in (0.33, 0.85))
    return float(high / low)


def full_rows():
    """Rows of the committed table of the ten rows."""
    with (TABLES / f"{SCENE}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def default_published():
    """`published` of the scene as it is [N/m], computed now, by (pair, case, foundation of the ring)."""
    scene, out = gf.load_scene(SCENE), {}
    for pair, case in herringbone_scan.rows():
        run = scene.pairs[pair].case(case).as_dict() | {"phases": damage_cycle(scene.pairs[pair]), "method": "published"}
        for kind in READINGS:
            found = gf.mesh_stiffness(**run, variants={"foundation": kind})
            out[pair, case or "healthy", kind] = float(found.k.mean())
    return out


def _span(values, form="+.1f"):
    values = values[np.isfinite(values)]
    return f"{values.min():{form}} ... {values.max():{form}} %" if values.size else "none"


def _ranges():
    groups = ", ".join(f"{angle:g} degrees from '{start}' with {half:g} mm" for angle, start, half in GROUPS)
    said = {
        "group": ("crack angle to the centre-line, its start, width of a half", groups, "S4: 45 degrees, start not given; 60 mm, and 'of one herringbone half' beside L"),
        "length": ("length of a crack of level 1, in tooth chords at its start", "", "not given: 0.71 is the way to the centre-line, 1 the chord, 1.41 twice that way (50 % at the centre-line)"),
        "sun": ("bore of the sun, part of the root radius", "", "not given; Sainsot's formula is fitted for 0.14 to 0.71"),
        "planet": ("bore of the planet", "", "not given"),
        "load": ("binary logarithm of the load", "", "S4: 400 N m in the dynamics; that of its finite elements not given"),
        "tip": ("rack tip radius [m_n]", "", "not given; ISO 53 has 0.25 to 0.38"),
        "rim": ("outer radius of the ring, held there [mm]", "", "not given"),
        "radius": ("radius of a pit [mm]", "", "S4: 1 mm diameter on the test gears, p_d of the model not given"),
        "depth": ("depth of a pit [mm]", "", "not given"),
        "shift": ("place of the pits from the pitch circle [mm]", "", "not given"),
        "own": ("level of a crack in the formulas", "as long as in `ritz3d`; or the same part of their own beam's foot", "not given"),
    }  # fmt: skip
    lines = ["| value | range | why |", "|---|---|---|"]
    for name, (what, own, why) in said.items():
        lines.append(f"| {what} | {own or ' to '.join(f'{v:g}' for v in RANGES[name])} | {why} |")
    return "\n".join(lines)


def _ten(scan, best):
    default = {(r["pair"], r["case"], r["method"]): float(r["mean [N/m]"]) for r in full_rows()}
    printed_default = default_published()
    lines, analytical, fe = [], printed("stiffness_analytical"), printed("stiffness_fe")
    for k, (pair, case) in enumerate(rows()):
        cells = [
            pair,
            case,
            in_newton_per_um(analytical[k], 3),
            in_newton_per_um(fe[k], 3),
            f"{100 * (analytical[k] / fe[k] - 1):+.1f} %",
        ]
        ours, truth = scan.mean["printed"][best, k], scan.mean["ritz3d"][best, k]
        cells += [f"{1e3 * ours:.0f}", f"{1e3 * truth:.0f}", f"{100 * (ours / truth - 1):+.1f} %"]
        cells += [f"{scan.errors('external')[best, k]:+.1f} %" if pair == "planet_ring" else "same"]
        truth, own = default[pair, case, "fe3d"], [printed_default[pair, case, kind] for kind in READINGS]
        cells += [in_newton_per_um(own[0]), in_newton_per_um(truth), f"{100 * (own[0] / truth - 1):+.1f} %"]
        cells += [f"{100 * (own[1] / truth - 1):+.1f} %" if pair == "planet_ring" else "same"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _zones(scan, which):
    lines, reduced = [], printed("stiffness_reduction")
    for k, (pair, case) in enumerate(rows()):
        cells = [f"{pair} {case}", _span(scan.errors("printed")[which, k])]
        cells += [_span(scan.zone[zone][which, k]) for zone in ("most", "fewest")]
        cells.append(_span(scan.errors_of_max("printed")[which, k]))
        cells.append(_span(scan.phase[which, k], ".1f"))
        cells.append("" if case == "healthy" else f"{_span(scan.drop['ritz3d'][which, k], '.1f')}, {reduced[k]:.1f} %")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _text(row):
    own = {name: row[name] for name in Reading.__slots__}
    angle, start, half = GROUPS[int(own.pop("group"))]
    foot = "as the same part of their own foot" if own.pop("own") == "1" else "as long"
    return (
        f"a half {half:g} mm wide, crack at {angle:g} degrees from '{start}' and {float(own['length']):.2f} chords long at level 1, in "
        f"the formulas {foot}; bores {float(own['sun']):.2f} and {float(own['planet']):.2f}, load {2 ** float(own['load']):.2f} times, "
        f"tip radius {float(own['tip']):.2f}, rim {float(own['rim']):.0f} mm, pits of {float(own['radius']):.2f} mm radius, "
        f"{float(own['depth']):.2f} mm deep, {float(own['shift']):+.2f} mm from the pitch circle"
    )


def _paragraph(scan, which):
    healthy = scan.mean["ritz3d"][which, 0]
    sun, planet, length = (scan.column(name)[which] for name in ("sun", "planet", "length"))
    alone = [int(scan.agree("printed", [0, 5]).sum()), int(scan.agree("printed", slice(0, 5)).sum())]
    case4 = scan.drop["ritz3d"][:, [4, 9]]
    worst = scan.phase[which].max(axis=1)
    return (
        f"What survives: the claim is possible. It is also cheap: the formulas' bodies are too stiff or too soft by an amount that the "
        f"bores set, so the mean passes through the truth somewhere between 0.3 and 0.85 ({alone[0]} readings for both healthy rows, "
        f"{alone[1]} for the five rows of sun and planet), and the crack's length, free between conventions, can then be the one at which "
        f"the sections left of the beam lose as much as the body does. The readings in which all ten agree have bores of "
        f"{sun.min():.2f} to {sun.max():.2f} (sun) and {planet.min():.2f} to {planet.max():.2f} (planet) and cracks of {length.min():.2f} to "
        f"{length.max():.2f} chords; at single phases the formulas are then off by {worst.min():.1f} to {worst.max():.1f} %, and the healthy k of "
        f"sun and planet is {1e3 * healthy.min():.0f} to {1e3 * healthy.max():.0f} N/um (of both halves, 60 or 120 mm), where S4 prints 1230. Case 4 takes "
        f"{np.nanmin(case4):.1f} to {np.nanmax(case4):.1f} % in the readings of this scan, whose pits lie in rows along the axis in one half; S4 prints 31.4 and 28.0, "
        "which take pits along the contact line in both halves. Agreement in the "
        "mean is no evidence for the formulas: one unknown bore per pair is enough to make it. From 0.33 to 0.85 of the root radius "
        f"the bores alone move the healthy k of sun and planet {bore_factor():.2f} times."
    )


def answer():
    """Which readings bear the claim, in a sentence."""
    scan = Scan()
    which = np.flatnonzero(scan.agree("printed"))
    valued = int(np.isfinite(scan.mean["printed"]).all(axis=1).sum())
    stiff = int(scan.absolute("printed", limit=WIDER)[which].sum())
    return (
        f"Its claim, formulas within 3 % of finite elements, holds in all ten means in {which.size} of {valued} readings of what it does not print, pits "
        f"along the axis, {stiff} of them with the printed stiffness within 5 %: bores and the crack's length decide, and agreement there is cheap."
    )


def section():
    """Lines of the page."""
    scan = Scan()
    which, best = np.flatnonzero(scan.agree("printed")), scan.best("printed")
    valued = int(np.isfinite(scan.mean["printed"]).all(axis=1).sum())
    numbers, away = checked(scan)
    own = scan.column("sun_planet healthy textbook mean") / scan.mean["ritz3d"][:, 0] - 1
    full = [row for row in full_rows() if row["method"] == "ritz3d"]
    taken = [100 * abs(1 - value) for value in herringbone_scan.Ritz3D().anchor.values()]
    made = PAGE.format(
        name=NAME,
        paragraph=_paragraph(scan, which),
        size=len(scan.table),
        dimensions=len(RANGES),
        refused=len(scan.table) - valued,
        ranges=_ranges(),
        fe=f"within {100 * max(abs(float(row['error of mean'])) for row in full):.2f} % of `fe3d` in the ten rows of the scene",
        nodes=len(herringbone_scan.nodes.load()[0]),
        anchor=f"{min(taken):.1f} to {max(taken):.1f} %",
        checks=f"{len(numbers)} readings solved directly differ from it by {np.median(np.abs(away)):.2f} % in the median, {np.quantile(np.abs(away), 0.9):.2f} % "
        f"in nine rows of ten and {np.abs(away).max():.1f} % at most.",
        textbook=int((100 * np.abs(own) < CLAIM).sum()),
        first=NAMES["printed"],
        second=NAMES["external"],
        sets="\n".join(f"| {what} | {first} | {second} |" for what, first, second in sets(scan)),
        best=scan.table[best]["number"],
        best_text=_text(scan.table[best]),
        ten=_ten(scan, best),
        zones=_zones(scan, which),
    )
    return made.strip().splitlines()


def picture():
    """Worst error of the ten means against the healthy stiffness of sun and planet, in both readings of the ring's foundation."""
    scan, target = Scan(), printed("stiffness_fe")[0] / NEWTON_PER_UM
    wide = np.array([GROUPS[int(group)][2] == 60.0 for group in scan.column("group")])
    figure = Figure(figsize=(7.0, 3.6), layout="constrained")
    axes = figure.subplots()
    for kind, mark, colour in (("printed", "o", "#0072B2"), ("external", "^", "#D55E00")):
        k = np.where(wide, 0.5e3, 1e3) * scan.mean["ritz3d"][:, 0]
        axes.scatter(
            k, np.abs(scan.errors(kind)).max(axis=1), s=9, marker=mark, color=colour, alpha=0.6, label=NAMES[kind], linewidths=0
        )
    axes.axhline(CLAIM, color="black", linewidth=1.0)
    axes.text(0.99, CLAIM, "S4's claim", transform=axes.get_yaxis_transform(), ha="right", va="bottom", fontsize=8)
    axes.axvline(target, color="black", linewidth=1.0, linestyle="--")
    axes.text(target, 0.02, " S4's finite elements", transform=axes.get_xaxis_transform(), fontsize=8)
    axes.set(xlabel="healthy k of sun and planet, 60 mm of width [N/µm]", ylabel="worst error of ten means [%]", yscale="log")
    axes.set_yticks([1, 3, 10, 30, 100], ["1", "3", "10", "30", "100"])
    axes.legend(fontsize=8, loc="upper left")
    figure.savefig(table("").with_suffix(".png"), dpi=110)
