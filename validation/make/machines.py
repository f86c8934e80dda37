"""All printed numbers of the four machines with computed values: `tables/*.csv`, and a page for each scene."""

import importlib
import time
import tomllib
from functools import cache

import gearfe as gf
from gearfe.core.threads import own_warnings
from gearfe.scene import verdicts
from gearfe.scene.reading import checked
from gearfe.scene.references import read_references

from ..shared import places, table_rows
from ..shared.openings import OPENINGS
from ..shared.page import put
from . import joint

FOLDER = places.PAGES
PAGES = {  # by page (and module): scene
    "planetary_pitting": "planetary_pitting",
    "compound_planetary": "compound_planetary",
    "helical_pitting": "helical_pitting",
    "herringbone_machine": "herringbone",
}
ARTICLES = {
    "planetary_pitting": "articles S0 and S1",
    "compound_planetary": "article S2",
    "helical_pitting": "article S3",
    "herringbone_machine": "article S4",
}
ELSEWHERE = {  # references of a scene that another page reproduces
    "stiffness_analytical": "herringbone",
    "stiffness_fe": "herringbone",
    "stiffness_error": "herringbone",
    "stiffness_reduction": "herringbone",
}
GOLDEN_RTOL = 1e-4


def module(page):
    """Return the functions of a page."""
    return importlib.import_module(f"validation.make.{page}")


FURTHER = places.SOURCES / "statements.toml"


def references(page):
    """Return the references of its scene that the page computes, and further statements."""
    more = tomllib.loads(FURTHER.read_text(encoding="utf-8"))
    own = [one for one in gf.load_scene(PAGES[page]).references if one.id not in ELSEWHERE]
    rows = [checked("gearfe.scene", "reference", FURTHER.name, f"reference {i + 1}", row) for i, row in enumerate(more[page])]
    return [*own, *read_references(FURTHER.name, rows)]


def functions(page, *, quick=False):
    """Return functions by reference id. With `quick`, only those without simulation."""
    home = module(page)
    return home.QUICK if quick else home.QUICK | home.SIMULATED


def computed(page, names):
    """Compute the rows of some references of a page."""
    found, out = functions(page), []
    with own_warnings():
        for one in references(page):
            if one.id in names:
                out += verdicts.judge(one, found[one.id]())
    return out


@cache
def quick_rows(page):
    """Compute the rows of a page that require no simulation, by id, case and pair. They are cached."""
    return {row[:3]: row for row in computed(page, set(functions(page, quick=True)))}


def text(page):
    """Return the page as Markdown, from its committed rows and its scene."""
    scene, home = gf.load_scene(PAGES[page]), module(page)
    rows = table_rows.read(page)
    claim, find, decide = OPENINGS[page](CommittedRows(rows))
    rows = decided(page, rows)
    drawn = f"{drawn_jointly(page)}" if joint.rows_of(page) else ""
    lines = [
        f"# {scene.title}: which printed numbers of {ARTICLES[page]} are reproduced?",
        "",
        f"- Claim of the article: {claim}.",
        f"- Result of gearfe: {find}.",
        f"- Cause of the difference: {decide}.",
        *([f"- Unprinted inputs: {drawn}"] if drawn else []),
        "",
        verdicts.text([one for one in references(page) if one.id not in plain(page, rows)], rows, joint.said(page)),
        "",
        *joint.section(page, rows),
    ]
    for number, (name, caption) in enumerate(home.PICTURES.items(), 1):
        lines += [f"![Figure {number}]({name}.png)", "", f"Figure {number}. {caption}.", ""]
    lines += [
        "## Method and source",
        "",
        "[variants.md](variants.md) has the effect of other assumptions on the verdicts.",
        f"{scene.source}.",
        "",
        f"`python -m validation {page}` computes this page and [tables/{page}.csv](tables/{page}.csv), which",
        "also lists reproduced inputs, arithmetic and statements, and values without a printed number.",
        f"`gearfe stiffness {PAGES[page]} --assumptions` prints the {len(scene.assumptions)} assumptions of the scene.",
        "[printed.md](printed.md) defines verdicts and kinds.",
    ]
    return "\n".join(lines) + "\n"


def plain(page, rows):
    """Return ids of references whose values are reproduced and no numbers of a model, or have no printed number.

    Statements in the table of joint draws are not considered.
    """
    by_id = {}
    for row in rows:
        if not (row.kind == verdicts.STATEMENT and row.case in joint.said(page)):
            reproduced = row.kind != "model" and row.verdict == verdicts.REPRODUCED
            by_id.setdefault(row.id, []).append(reproduced or row.verdict == verdicts.FORMULA)
    return [name for name, found in by_id.items() if all(found)]


def decided(page, rows):
    """Return rows with the verdict `verdicts.DEPENDS` for statements that hold in some joint draws only."""
    shares = {case: held.mean() for case, held in joint.judged(page).items()} if joint.rows_of(page) else {}
    return [
        row._replace(verdict=verdicts.DEPENDS)
        if row.kind == verdicts.STATEMENT and row.verdict != verdicts.ASSUMED and 0 < shares.get(row.case, 1) < 1
        else row
        for row in rows
    ]


def drawn_jointly(page):
    """Return a sentence on how many statements depend on inputs that the article does not print."""
    below = "([below](#within-which-unprinted-inputs-statements-hold))"
    return f"all of them are drawn at random together. {joint.sentence(page)} {below}."


class CommittedRows:
    """Stored rows by id, case and pair."""

    def __init__(self, rows):
        """Sort `verdicts.PrintedRow` objects."""
        self.rows = {row[:3]: row for row in rows}

    def ours(self, name, case, pair=""):
        """Return the computed value."""
        return self.rows[name, case, pair].ours

    def all(self, name):
        """Return the computed values of a reference in the order of its rows."""
        return [row.ours for row in self.rows.values() if row.id == name]

    def printed(self, name):
        """Return the printed values of a reference in the order of its rows."""
        return [row.printed for row in self.rows.values() if row.id == name]

    def counted(self):
        """Return the counts of the verdicts."""
        return verdicts.counts(list(self.rows.values()))


def write_page(page):
    """Write the Markdown of a page from its rows."""
    put(page, text(page))


def compute(page):
    """Compute all rows and pictures of a page and write them."""
    started, rows = time.perf_counter(), []
    for one in references(page):
        rows += computed(page, {one.id})
        print(f"  {page}, {one.id}: {time.perf_counter() - started:.0f} s", flush=True)
    table_rows.write(page, rows)
    module(page).draw(FOLDER)
    print(f"{page}: {verdicts.counts(rows)}", flush=True)


def run(page, again=True):
    """Write a page. With `again`, its stored rows are computed again."""
    if again:
        compute(page)
    write_page(page)


def cheap(page):
    """Yield the rows of a page that `validation.check` computes again: those without simulation."""
    known = table_rows.read(page)
    for name in functions(page, quick=True):
        yield name, _judged(row for row in known if row.id == name), lambda name=name: _judged(computed(page, {name}))


def _judged(rows):
    return [[row.verdict, row.ours] for row in rows]
