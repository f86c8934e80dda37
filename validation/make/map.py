"""The error map: closed forms against the energy model over thousands of gear pairs, and that model against finite elements."""

import sys
from itertools import product
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.files import written
from gearfe.studies.errormap import CRACKED, HEALTHY, LOADS, ZONES, build

from ..shared import machine
from ..shared.places import PAGES

PAGE = PAGES / "map.md"
PICTURE = PAGES / "map.png"
DATA = PAGES / "map.csv"
PAIRS = 2000
# corners of the map: tooth numbers, pressure angle, shift, bore, load, crack
CORNERS = product(((12, 12), (80, 120)), (17.5, 25.0), ((0.5, 0.2), (0.0, -0.2)), (0.2, 0.9))
SPLITS = {
    "load 10 MPa": {"load": (10, 10)},
    "load 50 MPa": {"load": (50, 50)},
    "load 250 MPa": {"load": (250, 250)},
    "both bores below 0.5 r_f": {"bore_1": (0, 0.5), "bore_2": (0, 0.5)},
    "both bores above 0.7 r_f": {"bore_1": (0.7, 1), "bore_2": (0.7, 1)},
    "pinion of 12 to 25 teeth": {"z_1": (12, 25)},
    "pinion of 50 to 80 teeth": {"z_1": (50, 80)},
    "pressure angle below 19 degrees": {"alpha_deg": (0, 19)},
    "pressure angle above 23 degrees": {"alpha_deg": (23, 30)},
    "both shifts below 0": {"x_1": (-1, 0), "x_2": (-1, 0)},
    "both shifts above 0.3": {"x_1": (0.3, 1), "x_2": (0.3, 1)},
}
CRACKS = {"level below 0.1": (1e-9, 0.1), "0.1 to 0.3": (0.1, 0.3), "0.3 to 0.5": (0.3, 0.5), "above 0.5": (0.5, 1.0)}


def run():
    """Write `map.md`, `map.png` and `map.csv`, and print the page."""
    corners = _corners()
    found = gf.error_map(PAIRS, progress=_progress)
    found.to_csv(DATA)
    found.plot(PICTURE)
    lines = [
        f"# Error map: {2 * PAIRS} gears",
        "",
        f"Made by `python -m validation map` on {machine.describe()}: {PAIRS} external pairs, {found.columns['load'].size} rows",
        f"of pair, load and crack, in {found.elapsed:.0f} s by {found.workers} processes of one thread,",
        f"{1e3 * np.median(found.seconds):.0f} ms per pair with all its loads and models. The rows are written to `map.csv`,",
        "which is not kept: the sample is fixed (`gearfe.error_map`, seed 0). Loads are F / (b m_n). Errors of k against `ritz`,",
        "without contact beyond the path of contact.",
        "",
        "## Healthy gears",
        "",
        "Error at 5 / 50 / 95 % of the rows; share of the rows within 3 %.",
        "",
        "| formulation | " + " | ".join(ZONES) + " |",
        "|---" * (len(ZONES) + 1) + "|",
    ]
    for name in HEALTHY:
        lines.append(f"| {name} | " + " | ".join(_cell(found.bands(name, zone, crack=(0, 0))) for zone in ZONES) + " |")
    lines += [
        "",
        "Contact beyond the path of contact, which none of them knows, adds",
        f"{_three(found.bands('extended', 'mean', crack=(0, 0)))} % to the mean k.",
        "",
        "Mean over the cycle, by part of the map:",
        "",
        "| part | " + " | ".join(HEALTHY) + " |",
        "|---" * (len(HEALTHY) + 1) + "|",
    ]
    for part, limits in SPLITS.items():
        cells = [_cell(found.bands(name, "mean", crack=(0, 0), **limits)) for name in HEALTHY]
        lines.append(f"| {part} | " + " | ".join(cells) + " |")
    lines += ["", "![median error by load and bore](map.png)", "", "## Cracked pinions", ""]
    lines += ["Over the engagement of the cracked tooth, where it carries alone (single):", ""]
    lines += ["| formulation | " + " | ".join(CRACKS) + " |", "|---" * (len(CRACKS) + 1) + "|"]
    for name in CRACKED:
        lines.append(f"| {name} | " + " | ".join(_cell(found.bands(name, "single", crack=c)) for c in CRACKS.values()) + " |")
    lines += ["", "## Where each may be used", "", *_verdicts(found), "", "## The reference at the corners of the map", ""]
    lines += corners
    with written(PAGE) as name:
        Path(name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


def _three(band):
    return " / ".join(f"{100 * v:+.1f}" for v in band[:3])


def _cell(band):
    return f"{_three(band)}; {100 * band[3]:.0f} %" if band[4] else "-"


def _verdicts(found):
    """In words, from the numbers."""
    out = []
    for name in HEALTHY:
        good = {zone: found.bands(name, zone, crack=(0, 0)) for zone in ("single", "double", "mean")}
        share = ", ".join(f"{100 * band[3]:.0f} % of {zone}" for zone, band in good.items())
        parts = [part for part, limits in SPLITS.items() if found.bands(name, "mean", crack=(0, 0), **limits)[3] >= 0.9]
        where = (
            f"it holds (nine rows in ten) for: {'; '.join(parts)}" if parts else "no part of the map above holds nine rows in ten"
        )
        out.append(f"- `{name}` is within 3 % in {share}; for the mean over the cycle {where}.")
    for name in CRACKED:
        worst = [100 * found.bands(name, "single", crack=c)[3] for c in CRACKS.values()]
        out.append(
            f"- `{name}` with a crack: within 3 % in {' / '.join(f'{w:.0f}' for w in worst)} % of the rows of the table above."
        )
    out.append("- `ritz` is the reference here; its own error is in the last table and in `speed.md`.")
    return out


def _corners():
    lines = ["Largest difference of k at any phase between `ritz` and `fe` (refine 2), contact beyond the path included:", ""]
    lines += ["| z | pressure angle | shifts | bore / r_f | healthy | 30 % crack |", "|---|---|---|---|---|---|"]
    for z, alpha, x, bore in CORNERS:
        sample = {"z_1": z[0], "z_2": z[1], "alpha_deg": alpha, "x_1": x[0], "x_2": x[1], "tip_radius": 0.25}
        name = f"| {z[0]}/{z[1]} | {alpha:g} | {x[0]:g}, {x[1]:g} | {bore:g} | "
        try:
            pair = build(sample | {"bore_1": bore, "bore_2": bore})
        except ValueError as error:
            lines.append(name + f"{str(error).split(':')[0].split(';')[0]} | |")
            continue
        cells = []
        for damage in (None, {"pinion": [gf.Crack(level=0.3)]}):
            run = {"material": gf.Material(), "phases": 16, "damage": damage, "force": LOADS[1]}
            try:
                k, truth = (gf.mesh_stiffness(pair, method=m, refine=r, **run).k for m, r in (("ritz", 1.0), ("fe", 2.0)))
            except ValueError as error:
                cells.append(str(error).split(";")[0])
                continue
            cells.append(f"{100 * np.abs(k / truth - 1).max():.2f} %")
        lines.append(name + " | ".join(cells) + " |")
    return lines


def _progress(done, total):
    if done % max(1, total // 20) == 0:
        print(f"{done} of {total} pairs", file=sys.stderr, flush=True)
