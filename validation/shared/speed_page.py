"""The page of speed against error, from the tables that the three benchmarks write: sections, three dimensions, dynamics."""

import csv
from pathlib import Path

import numpy as np

from gearfe.files import written

from .places import PAGES, TABLES

PAGE = PAGES / "speed.md"
PICTURE = PAGES / "speed.png"
COLUMNS = ("family", "method", "seconds", "mean error", "max error", "default", "more")
PARTS = {
    "speed_two": ("sections, k over 64 phases", "largest error of k [%]", "seconds for 64 phases"),
    "speed_three": ("three dimensions, k over 64 phases", "largest error of k [%]", "seconds for 64 phases"),
    "speed_dynamics": ("vibration, 55 degrees of freedom", "largest error of a mesh force [%]", "seconds per simulated second"),
}
HEAD = """# Speed against error

Every method on one case, one thread; which machine, at each table. Errors: relative, of k at each phase against the finest
solution (2-D: finite elements; 3-D: the energy model at the highest orders), of mesh forces over their range against DOP853 at
rtol 1e-10. Bold, and circled in the picture: the defaults.

![seconds against error](speed.png)
"""
TITLES = {
    "speed_two": "## Sections (2-D)",
    "speed_three": "## Three dimensions\n\nMore of it: [speed_three.md](speed_three.md).",
    "speed_dynamics": "## Integrators\n\nMore of it, and all four machines: [dynamics.md](dynamics.md).",
}


def save(part, about, rows):
    """Write the rows (as `COLUMNS`) of a part and what they were measured on, then the page."""
    TABLES.mkdir(exist_ok=True)
    with (TABLES / f"{part}.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow([*COLUMNS, "about"])
        for i, row in enumerate(rows):
            out.writerow([*(f"{v:.4g}" if isinstance(v, float) else v for v in row), about if i == 0 else ""])
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    _plot()


def load(part):
    """Rows of a part as dicts; empty if it was never measured."""
    file = TABLES / f"{part}.csv"
    return list(csv.DictReader(file.read_text(encoding="utf-8").splitlines())) if file.is_file() else []


def page():
    """Text of the page, from the tables alone."""
    return "\n".join([HEAD, *(_section(part) for part in PARTS if load(part))])


def _section(part):
    rows = load(part)
    lines = [TITLES[part], "", rows[0]["about"], "", "| method | seconds | mean error | max error |  |", "|---|---|---|---|---|"]
    for row in rows:
        bold = "**" if row["default"] == "1" else ""
        errors = [_percent(row[name]) for name in ("mean error", "max error")]
        lines.append(f"| {bold}{row['method']}{bold} | {float(row['seconds']):.3g} | {' | '.join(errors)} | {row['more']} |")
    return "\n".join([*lines, ""])


def _percent(text):
    value = float(text)
    return "" if np.isnan(value) else "reference" if value == 0 else f"{100 * value:.2g} %"


def _plot():
    from matplotlib.figure import Figure

    from gearfe.pictures.look import MARKS, look

    parts = [part for part in PARTS if load(part)]
    figure = Figure(figsize=(5.2 * len(parts), 3.8), layout="constrained")
    for axes, part in zip(figure.subplots(1, len(parts), squeeze=False)[0], parts, strict=True):
        rows = [row for row in load(part) if float(row["max error"]) > 0]
        for number, family in enumerate(dict.fromkeys(row["family"] for row in rows)):
            line = [(float(row["seconds"]), 100 * float(row["max error"])) for row in rows if row["family"] == family]
            mark = {"marker": MARKS[number % len(MARKS)], "ms": 4 + 2 * (number >= len(MARKS))}
            mark["mfc"] = "none" if number >= len(MARKS) else None  # after all marks once more, larger and hollow
            axes.loglog(*zip(*line, strict=True), label=family, **mark, **look(number))
        for row in rows:
            if row["default"] == "1":
                axes.loglog(float(row["seconds"]), 100 * float(row["max error"]), "o", ms=11, mfc="none", mec="k")
        title, vertical, horizontal = PARTS[part]
        axes.set_title(title, fontsize=10)
        axes.set_ylabel(vertical)
        axes.set_xlabel(horizontal)
        axes.grid(True, which="major", alpha=0.3)
        axes.legend(fontsize=7)
    with written(PICTURE) as name:
        figure.savefig(name, dpi=90)
