"""Page `printed`: every number that the articles print is judged, used as an input, or unused for a stated reason."""

import tomllib

from gearfe.core.table import Column, Table

from ..shared import page
from ..shared.places import SOURCES, TABLES
from ..shared.table_rows import write_table

KINDS = {"verdict": "judged", "used": "input: used", "unused": "input: not used"}
VERDICTS = """
## Verdicts and kinds

| verdict | meaning |
|---|---|
| reproduced | within the tolerance |
| reproduced after a stated correction | the corrected value is within the tolerance; only the corrected value counts |
| trend only | all cases have the printed order, each 0.1 % from the next; their relative changes from the first case are a third to three times the printed ones |
| set by an assumption | agrees because of a value that the scene assumes |
| depends | a statement that holds in some [random draws](joint.md) of the unprinted inputs and fails in others |
| not reproduced | outside the tolerance |
| not reproducible | gearfe computes no such quantity |

| kind | meaning |
|---|---|
| input | put in, or found from this very value |
| arithmetic | follows from printed numbers |
| model | the result of a model, which could have been different |
| statement | a sentence of the article without a number; the table states in how many draws it holds |

The printed values are the `[[reference]]` rows of the scene files. The statements that an article "says, too" are those of
`validation/sources/statements.toml`. They were added after a first run.

## Printed numbers that are not used

`validation/sources/printed.toml` lists every printed number with the reference of its verdict, or the place of its use.
"""  # noqa: E501
CSV = TABLES / "printed.csv"
PAGES = {  # by page: references shown on it
    "planetary_pitting": "planetary_pitting",
    "compound_planetary": "compound_planetary",
    "helical_pitting": "helical_pitting",
    "herringbone": "herringbone_machine",
}


def ledger():
    """Return the rows of `sources/printed.toml`: article, quantity, values, and verdict, use or reason."""
    return tomllib.loads((SOURCES / "printed.toml").read_text(encoding="utf-8"))["printed"]


def kind(row):
    """Return which of `KINDS` a row is. Raises ValueError for none or several."""
    found = [name for name in KINDS if row.get(name)]
    if len(found) != 1:
        raise ValueError(f"{row['article']}, {row['what']}: it has {found or 'none'} of {', '.join(KINDS)}; give one")
    return found[0]


def counts(rows, article):
    """Count the printed numbers of an article by kind, in the order of `KINDS`."""
    own = [row for row in rows if row["article"] == article]
    return [sum(len(row["values"]) for row in own if kind(row) == name) for name in KINDS]


def lines(rows):
    """Return the table of the printed numbers that are not used, and of the results by page, as Markdown."""
    out = []
    for row in rows:
        which = kind(row)
        if which not in ("verdict", "used"):
            out.append([row["article"], ", ".join(f"{value:.6g}" for value in row["values"]), row["what"], row[which]])
    return Table(("article", "printed", "what", "not used, because"), out).markdown()


def answer(rows):
    """Return the first sentence of the page."""
    total = [sum(one) for one in zip(*(counts(rows, name) for name in articles(rows)), strict=True)]
    return (
        f"Of {sum(total)} printed numbers {total[0]} are results, each with a verdict on its page, {total[1]} are inputs that "
        f"gearfe uses, and {total[2]} inputs that it does not use, each with the reason."
    )


def articles(rows):
    """Return the names of the articles."""
    return list(dict.fromkeys(row["article"] for row in rows))


def run(again=True):
    """Write the table and the page."""
    rows = ledger()
    write_table(CSV, ("article", *KINDS.values()), [(name, *counts(rows, name)) for name in articles(rows)])
    how = [
        "`python -m validation printed` writes this page from `sources/printed.toml`, which contains every number as printed.",
        "A test compares it with scenes, references and code. A number that is printed twice is listed where its rows are.",
        "Statements without a number are rows on the pages of the machines.",
    ]
    head = ("article", *(Column(name, form="{}") for name in ("results", "inputs used", "inputs not used")))
    small = Table(head, [[name, *counts(rows, name)] for name in articles(rows)]).markdown()
    page.write("printed", answer(rows), small, VERDICTS, lines(rows), ["## Method", "", *how])
