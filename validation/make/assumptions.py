"""How much the stiffness of each scene depends on what the scene assumes: one change at a time."""

import csv
import warnings
from dataclasses import replace
from pathlib import Path

import gearfe as gf
from gearfe.files import written
from gearfe.scene.load import scene_names
from gearfe.units import in_newton_per_um
from geometry.pair.gear_pair import GearPair

from ..shared.places import PAGES, TABLES

PAGE = PAGES / "assumptions.md"
CSV = TABLES / "assumptions.csv"
PITTED = {"planetary_pitting": "mild", "helical_pitting": "severe"}  # scene: case whose pits are changed


def mean(one, changes=({}, {}), force=None):
    """Mean stiffness [N/m] by `ritz` with changed gears or force."""
    gears = (replace(gear, **change) for gear, change in zip((one.pair.gear_1, one.pair.gear_2), changes, strict=True))
    pair = GearPair(*gears, one.pair.a)
    return float(gf.mesh_stiffness(pair, force or one.force, one.materials, method="ritz").k.mean())


def changed(one):
    """(change, arguments of `mean`) for a pair of a scene."""
    gears = one.pair.gear_1, one.pair.gear_2
    for name, factor in (("bores halved", 0.5), ("bores 0.8 times", 0.8), ("bores 1.4 times", 1.4)):
        yield name, {"changes": [{} if g.internal else {"r_bore": factor * g.r_bore} for g in gears]}
    yield "force halved", {"force": one.force / 2}
    yield "force doubled", {"force": 2 * one.force}
    yield "rack tip radius 0.25", {"changes": [{} if g.internal else {"tip_radius": 0.25} for g in gears]}
    ring = gears[1]
    if ring.internal:
        yield "rim one module thicker", {"changes": ({}, {"r_rim": ring.r_rim + ring.m_n})}
        yield "rim one module thinner", {"changes": ({}, {"r_rim": ring.r_rim - ring.m_n})}
        yield "ring cutter of 30 teeth", {"changes": ({}, {"z_cutter": 30})}
        yield "ring addendum 0.1 lower", {"changes": ({}, {"addendum": ring.addendum - 0.1})}


def gears(name):
    """Rows (scene, pair, change, mean stiffness or its change in percent) of a scene."""
    rows = []
    for label, one in gf.load_scene(name).pairs.items():
        base = mean(one)
        rows.append((name, label, "as assumed [N/m]", base))
        rows += [(name, label, change, 100 * (mean(one, **run) / base - 1)) for change, run in changed(one)]
    return rows


def pits(name):
    """The same of the largest loss of stiffness [%] by the pits of a case, by `ritz3d`."""
    case, scene = PITTED[name], gf.load_scene(name)
    label, one = next(iter(scene.pairs.items()))
    run = {"span": "tooth", "phases": 96, "method": "ritz3d"}
    whole = gf.mesh_stiffness(**one.case(), **run).k
    rows = []
    for change, edit in (
        ("as assumed", lambda pit: pit),
        ("half as large", lambda pit: replace(pit, axes=tuple(0.5 * x for x in pit.axes))),
        ("0.5 mm nearer the tip", lambda pit: replace(pit, radius=pit.radius + 0.5)),
        ("0.5 mm nearer the root", lambda pit: replace(pit, radius=pit.radius - 0.5)),
        ("twice as deep", lambda pit: replace(pit, depth=2 * pit.depth)),
    ):
        damage = {"pinion": [edit(pit) for pit in one.damage[case]["pinion"]]}
        k = gf.mesh_stiffness(**one.case(), **run, damage=damage).k
        rows.append((name, label, f"pits {change}: largest loss of k, case {case} [%]", float(100 * (1 - k / whole).max())))
    return rows


def read():
    """Committed rows."""
    with open(CSV, encoding="utf-8", newline="") as file:
        return [(r["scene"], r["pair"], r["change"], float(r["value"])) for r in csv.DictReader(file)]


def text():
    """The page as Markdown, from its table."""
    lines = [
        "# What the assumptions of the scenes do to the stiffness",
        "",
        "Made by `python -m validation assumptions` from [tables/assumptions.csv](tables/assumptions.csv): mean mesh stiffness",
        "by `ritz` (transverse section) with one assumption changed at a time, in percent; pits by `ritz3d`, their largest loss.",
        "",
        "| scene, pair | change | change of the mean k [%] |",
        "|---|---|---|",
    ]
    last = None
    for scene, pair, change, value in read():
        name = f"{scene}, {pair}" if (scene, pair) != last else ""
        last = scene, pair
        shown = f"{value:.4g}" if "[" in change else f"{value:+.1f}"
        if "[N/m]" in change:
            change, shown = change.replace("[N/m]", "[N/um]"), in_newton_per_um(value)
        lines.append(f"| {name} | {change} | {shown} |")
    return "\n".join(lines) + "\n"


def run():
    """Compute the table and write the page."""
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for name in scene_names():
            rows += gears(name)
            if name in PITTED:
                rows += pits(name)
            print(f"  {name}: {len(rows)} rows", flush=True)
    TABLES.mkdir(exist_ok=True)
    with written(CSV) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("scene", "pair", "change", "value"))
        out.writerows((*row[:3], f"{row[3]:.6g}") for row in rows)
    with written(PAGE) as name:
        Path(name).write_text(text(), encoding="utf-8")
    print(f"wrote {PAGE.name}")
