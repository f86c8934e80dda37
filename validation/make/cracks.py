"""Root cracks: reductions against an earlier study, and how much they depend on conventions."""

import math
from pathlib import Path

import gearfe as gf
from gearfe.files import written
from geometry.damage.crack import start_arc
from geometry.tooth.profile import cartesian, root_curve

from ..shared import reference
from ..shared.places import PAGES

PAGE = PAGES / "cracks.md"
CONVENTIONS = {
    "30-degree tangent, 45 degrees": {},
    "start: root circle": {"start": "root"},
    "start: middle of the fillet": {"start": "middle"},
    "angle 30 degrees": {"angle": math.radians(30)},
    "angle 60 degrees": {"angle": math.radians(60)},
    "length: level times the 30-degree chord": {"length": "chord"},
    "turning at the centre-line": {"turning": True},
    "on the unloaded side": {"side": "unloaded"},
}


def run():
    """Write `cracks.md` and print it."""
    table = reference.load()["crack"]
    lines = [
        "# Root cracks: largest reduction of the mesh stiffness",
        "",
        "Made by `python -m validation cracks`. Crack in the pinion, over its whole engagement, no extended contact, level 50 %",
        "at the centre-line.",
        "",
        "Against an earlier plane-strain study (three to five real teeth; source and conventions in `reference.toml`):",
        "",
        "| pair | level | earlier study | gearfe |",
        "|---|---|---|---|",
    ]
    for row in table["rows"]:
        pair = "/".join(map(str, row["z"]))
        lines.append(f"| {pair} | {100 * row['level']:.0f} % | {row['value']} % | {100 * reference.crack_reduction(row):.2f} % |")
    lines += [
        "",
        "The same levels of 18/27 by other conventions:",
        "",
        "| convention | 10 % | 30 % | 60 % |",
        "|---|---|---|---|",
    ]
    for name, crack in CONVENTIONS.items():
        values = [100 * reference.crack_reduction(row, **_sized(row, crack)) for row in table["rows"][:3]]
        lines.append(f"| {name} | " + " | ".join(f"{v:.2f} %" for v in values) + " |")
    text = "\n".join([*lines, ""])
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)


def _sized(row, crack):
    """Crack options of a convention; a length by the chord of the tooth root at its 30-degree tangents."""
    if crack.get("length") != "chord":
        return crack
    entry = next(r for r in reference.load()["healthy"]["rows"] if r["z"] == row["z"])
    gear = reference.healthy_pair(entry)[0].gear_1
    chord = 2 * float(cartesian(*root_curve(gear, start_arc(gear, gf.Crack(level=0.5))))[0])
    return {"level": None, "length": row["level"] * chord}
