"""Every printed number of the four machines beside ours: `tables/*.csv`, a page for each scene."""

import importlib
import time
import warnings
from functools import cache
from pathlib import Path

import gearfe as gf
from gearfe.files import written
from gearfe.scene import verdicts

from ..shared import places, table_rows

FOLDER = places.PAGES
PAGES = {  # page and its module: scene
    "planetary_pitting": "planetary_pitting",
    "compound_planetary": "compound_planetary",
    "helical_pitting": "helical_pitting",
    "herringbone_machine": "herringbone",
}
ELSEWHERE = {  # references of a scene that another page computes
    "stiffness_analytical": "herringbone",
    "stiffness_fe": "herringbone",
    "stiffness_error": "herringbone",
    "stiffness_reduction": "herringbone",
}
GOLDEN_RTOL = 1e-4
SOON = {  # references whose simulation takes seconds: the ordinary tests compute them again; the slow ones, the others
    "compound_planetary": {"kurtosis", "kurtogram_level", "kurtogram_centre"},
}


def module(page):
    """The functions of a page."""
    return importlib.import_module(f"validation.make.{page}")


def references(page):
    """References of its scene that the page computes."""
    return [one for one in gf.load_scene(PAGES[page]).references if one.id not in ELSEWHERE]


def functions(page, *, quick=False):
    """Functions by reference id; `quick`: only those that need no simulation."""
    home = module(page)
    return home.QUICK if quick else home.QUICK | home.SIMULATED


def computed(page, names):
    """Rows of some references of a page, computed now."""
    found = functions(page)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return [row for one in references(page) if one.id in names for row in verdicts.judge(one, found[one.id]())]


def ordinary(page):
    """Ids of references whose rows the ordinary tests compute again: all without simulation, and some with."""
    return set(functions(page, quick=True)) | SOON.get(page, set())


@cache
def cheap(page):
    """Rows of a page that need no simulation, by id, case and pair, computed once."""
    return {row[:3]: row for row in computed(page, set(functions(page, quick=True)))}


def text(page):
    """The page as Markdown, from its committed rows and its scene."""
    scene = gf.load_scene(PAGES[page])
    rows = table_rows.read(page)
    lines = [
        f"# {scene.title}: printed and found",
        "",
        f"{scene.source}.",
        "",
        f"Made by `python -m validation machines` from [tables/{page}.csv](tables/{page}.csv); the printed values",
        f"are the `[[reference]]` rows of `gearfe/scenes/{PAGES[page]}.toml`.",
        "Verdicts are computed: *reproduced*: within the tolerance; *after a stated correction*; *trend only*: all cases have",
        "the printed order, each 0.1 % from the next; *not reproduced*; *not reproducible*: nothing computed is that quantity.",
        "Reasons: below.",
        "",
        verdicts.text(references(page), rows),
        "",
    ]
    for name, caption in module(page).PICTURES.items():
        lines += [f"![{caption}]({name}.png)", "", f"{caption}.", ""]
    lines += [
        "What the scene assumes, and how much depends on it:",
        "",
        "| assumed | why | what depends on it |",
        "|---|---|---|",
    ]
    lines += [f"| {one['what']} | {one['why']} | {one['depends']} |" for one in scene.assumptions]
    return "\n".join(lines) + "\n"


def write_page(page):
    """Write the Markdown of a page from its rows."""
    with written(FOLDER / f"{page}.md") as name:
        Path(name).write_text(text(page), encoding="utf-8")


def rebuild(page):
    """Compute all rows and pictures of a page and write them."""
    started, rows = time.perf_counter(), []
    for one in references(page):
        rows += computed(page, {one.id})
        print(f"  {page}, {one.id}: {time.perf_counter() - started:.0f} s", flush=True)
    table_rows.write(page, rows)
    module(page).draw(FOLDER)
    write_page(page)
    print(f"wrote {page}.md: {verdicts.counts(rows)}", flush=True)


def run(pages=()):
    """Rebuild some pages, or all."""
    for page in pages or PAGES:
        if page not in PAGES:
            raise ValueError(f"{page} is no page of a machine; there is {', '.join(PAGES)}")
        rebuild(page)
