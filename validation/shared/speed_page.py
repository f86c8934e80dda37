"""Sections and picture of the page of speed against error, of the values measured in one run."""

from pathlib import Path

from matplotlib.figure import Figure

from gearfe.core.files import written
from gearfe.figures.look import MARKS, look

from .places import PAGES

PICTURE = PAGES / "speed.png"
# columns of a row of a method: its family, name, seconds, mean and largest error, whether it is the default, anything else
FAMILY, METHOD, SECONDS, MEAN, MOST, DEFAULT, MORE = range(7)
PARTS = {
    "sections": ("sections, k over 64 phases", "largest error of k [%]", "seconds for 64 phases"),
    "three": ("three dimensions, k over 64 phases", "largest error of k [%]", "seconds for 64 phases"),
    "dynamics": ("vibration, 55 degrees of freedom", "largest error of a mesh force [%]", "seconds per simulated second"),
}


def table(rows, more=""):
    """Lines: methods with their seconds and errors."""
    lines = [f"| method | seconds | mean error | max error | {more} |", "|---|---|---|---|---|"]
    for row in rows:
        bold = "**" if row[DEFAULT] else ""
        lines.append(
            f"| {bold}{row[METHOD]}{bold} | {row[SECONDS]:.3g} | {_percent(row[MEAN])} | {_percent(row[MOST])} | {row[MORE]} |"
        )
    return lines


def _percent(value):
    return "" if value is None else "reference" if value == 0 else f"{100 * value:.2g} %"


def steps(found):
    """Lines: seconds of each machine at the step that `simulate` chooses."""
    lines = ["| machine | step, us | estimate | seconds |", "|---|---|---|---|"]
    return lines + [f"| {r['name']} | {r['step']:.2g} | {r['estimate']:.1e} | {r['seconds']:.3g} |" for r in found]


def plot(found):
    """Draw seconds against errors of `PARTS`."""
    figure = Figure(figsize=(5.2 * len(PARTS), 3.8), layout="constrained")
    for axes, part in zip(figure.subplots(1, len(PARTS)), PARTS, strict=True):
        rows = [row for row in found[part]["rows"] if row[MOST] > 0]
        for number, family in enumerate(dict.fromkeys(row[FAMILY] for row in rows)):
            line = [(row[SECONDS], 100 * row[MOST]) for row in rows if row[FAMILY] == family]
            mark = {"marker": MARKS[number % len(MARKS)], "ms": 4 + 2 * (number >= len(MARKS))}
            mark["mfc"] = "none" if number >= len(MARKS) else None  # after all marks once more, larger and hollow
            axes.loglog(*zip(*line, strict=True), label=family, **mark, **look(number))
        for row in rows:
            if row[DEFAULT]:
                axes.loglog(row[SECONDS], 100 * row[MOST], "o", ms=11, mfc="none", mec="k")
        title, vertical, horizontal = PARTS[part]
        axes.set_title(title, fontsize=10)
        axes.set_ylabel(vertical)
        axes.set_xlabel(horizontal)
        axes.grid(True, which="major", alpha=0.3)
        axes.legend(fontsize=7)
    with written(PICTURE) as name:
        figure.savefig(Path(name), dpi=90)
