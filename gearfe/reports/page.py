"""`report`: a page of a scene in one file that needs no network."""

import base64
import os
import tempfile
import time
from importlib import resources
from pathlib import Path

from ..comparison.told_scene import told_details, told_load, told_supports
from ..core.markdown import table_cells
from ..core.steps import part
from ..core.table import Column, Table
from ..scene.load import Scene, scene_names
from ..stiffness.methods import METHODS
from ..stiffness.provenance import versions
from ..strength.render import enlarged, render_stress, rounded_up
from .figures import cases_figure, curves_figure, part_of_page, share_figure, spectra_figure, tooth_figure
from .findings import find
from .template import page_maker
from .whole_set import set_section

PICTURE, REFINE = (1120, 840), 0.7  # of stress [px], and of its mesh


def report(
    scene: Scene | str | os.PathLike[str],
    path: str | os.PathLike[str],
    case: str | None = None,
    *,
    duration: float = 0.2,
    phases: int = 64,
) -> Path:
    """Write one self-contained page of a scene: assumptions, errors, curves, shares, stress, vibration, and how all was made.

    Parameters
    ----------
    scene : Scene, str or path
        As of `gearfe.load_scene`, or a name or file of one.
    path : path
        A ``.html`` file.
    case : str, optional
        Case of damage shown beside healthy; default the first of the scene.
    duration : float
        Of the vibration of the scene's machine that is kept [s]; 0 leaves the machine out.
    phases : int
        Of the stiffness curves, per mesh cycle.

    Raises
    ------
    ValueError
        If the page could not be written, or there is no such scene or case.
    RuntimeError
        If plotly or jinja2 is missing; the message has the command that installs them.
    """
    write = page_maker(path, "page.html")
    started = time.perf_counter()
    with part("", 0.0, 0.85):
        found = find(scene, case, duration=duration, phases=phases)
    with part("stress pictures", 0.85, 1.0):
        drawing = time.perf_counter()
        pictures = _pictures(found)
        sets = set_section(found.sets)
        found.seconds["stress pictures"] = time.perf_counter() - drawing
    figures = _Figures()
    cost = [*found.seconds.items(), ("all", time.perf_counter() - started)]
    return write(
        found=found, headline=found.headline, scene=found.scene, command=_command(found), case=found.case,
        pairs=_pairs(found, figures), pictures=pictures, sets=sets,
        tooth=_tooth(found, figures), vibration=_vibration(found, figures), methods=_methods(found),
        versions=versions(), duration=duration, total=cost[-1][1],
        cost=Table(("part", Column("time", "s", "{:.1f}")), cost, "What it cost"),
        libraries=Table(["library", "version"], list(versions().items()), "Versions"), assumed=_assumed(found.scene),
        turning=(resources.files("gearfe.reports") / "page.js").read_text(encoding="utf-8"),
    )  # fmt: skip


class _Figures:
    """Figures as text of a page, numbered."""

    def __init__(self):
        self.number = 0

    def __call__(self, figure):
        self.number += 1
        return {"name": f"figure-{self.number}", "html": part_of_page(figure, f"figure-{self.number}")}


def _pairs(found, figures):
    """What is shown of each pair: numbers, comparisons healthy and damaged, curves and shares."""
    out = []
    for name, chosen in found.scene.pairs.items():
        pair = chosen.pair
        told = [told_load(chosen), *told_details(chosen), *pair.notes]
        parts = [_comparison(found.comparisons[key], key[1], figures) for key in found.comparisons if key[0] == name]
        out.append({"name": name, "drawing": pair._repr_html_(), "told": told, "parts": parts})
        if found.case in chosen.damage:
            out[-1]["cases"] = figures(cases_figure(_both(found, name)))
    return out


def _both(found, name):
    """Curves of a pair, healthy and damaged, by the reference and over the same phases."""
    one = found.comparisons[name, found.case]
    reference = next(iter(one.healthy))
    return {f"healthy ({reference})": one.healthy[reference], f"{found.case} ({reference})": one.reference}


def _comparison(one, case, figures):
    rows = [
        {"zone": zone, "truth": truth / 1e6, "doubt": 100 * doubt, "others": [(k / 1e6, 100 * e) for k, e in others.values()]}
        for zone, truth, doubt, others in one.rows()
    ]
    names = list(one.curves)
    return {
        "case": case or "healthy",
        "headline": one.headline,
        "definition": one.definition,
        "losses": _table(one.loss_table()),
        "reasons": one.reasons(),
        "names": names,
        "rows": rows,
        "seconds": [one.seconds[name] for name in names],
        "curves": figures(curves_figure(one.curves)),
        "share": figures(share_figure(one.reference)),
        "supports": told_supports(one.reference),
    }


def _pictures(found):
    """Pictures of stress, healthy and damaged, as data of the page; without a renderer what is missing."""
    name = found.hurt_pair
    chosen, out = found.scene.pair(name), []
    for case in dict.fromkeys([None, found.case if found.case in chosen.damage else None]):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "stress.png"
            title = f"{found.scene.name}, {name}, {case or 'healthy'}"
            try:
                told = render_stress(chosen, file, case=case, size=PICTURE, refine=REFINE, title=title)
            except (RuntimeError, ValueError) as error:
                out.append({"missing": f"{title}: {error}"})
                continue
            data = base64.b64encode(file.read_bytes()).decode()
        out.append({"data": data, "title": title, "told": told, "refine": REFINE})
    return out


def _tooth(found, figures):
    if found.tooth is None:
        return None
    name, pressed, field = found.tooth
    scale = enlarged(field.opening, pressed.sector.gear.m_n)
    return {
        "figure": figures(tooth_figure(pressed, field, scale, rounded_up(field.root))),
        "pair": name,
        "gear": pressed.gear,
        "phase": float(pressed.contact.phase[0]),
        "load": float(pressed.load[0]),
        "root": field.root,
        "enlarged": scale,
        "unknowns": pressed.unknowns,
    }


def _vibration(found, figures):
    if found.vibration is None:
        return None
    return {
        "figure": figures(spectra_figure(found.vibration)),
        "lines": found.vibration.lines_table(),
        "hidden": found.vibration.hidden_lines(),
        "indicators": found.vibration.indicators_table(),
        "stats": {case: one.stats for case, one in found.responses.items()},
        "machine": repr(next(iter(found.responses.values())).machine).strip("<>"),
    }


def _table(markdown):
    """Rows of a Markdown table, the head first."""
    rows = [table_cells(line) for line in markdown.splitlines() if line.startswith("|")]
    return [row for row in rows if not all(set(cell) <= set("-: ") for cell in row)]


def _methods(found):
    """`Table` of the methods that were used, what each is, and its error."""
    used = dict.fromkeys(name for comparison in found.comparisons.values() for name in comparison.curves)
    closed = "a closed form: no estimate of its own, its error is that of the table"
    error = {False: closed, True: "can be refined to the limit"}
    rows = [(row.name, row.about, error[row.converged] + "; estimated from coarser solves" * (row.converged and bool(row.error)))
            for name in used if (row := METHODS.get(name))]  # fmt: skip
    return Table(("method", "what it is", "its error"), rows, "methods")


def _assumed(scene):
    """`Table` of what a scene assumes."""
    rows = [(one["what"], one["why"], one["depends"] or "not stated") for one in scene.assumptions]
    return Table(("assumed", "why", "what depends on it"), rows, "assumptions")


def _command(found):
    """What was typed for the page, the file of a scene of one's own without its folder."""
    name = found.scene.name if found.scene.name in scene_names() else f"{found.scene.name}.toml"
    return f"gearfe report {name}{f' --case {found.case}' if found.case else ''} -o page.html"
