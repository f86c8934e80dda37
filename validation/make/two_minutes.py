"""Page `two_minutes`: each article with its claim, the verdict and the cause, from the tables of the other pages."""

from gearfe.core.table import Table
from gearfe.scene import verdicts

from ..shared import herringbone_page, table_rows
from ..shared.openings import OPENINGS
from ..shared.page import MACHINES, write
from .machines import ARTICLES, CommittedRows, decided

STIFFNESS = (
    "that its formulas for the mesh stiffness are within 3 % of finite elements",
    "bores, crack lengths and the layout of the pits, which are not printed",
)


def rows():
    """Return article, claim, verdicts, deciding inputs and link of each page."""
    out = []
    for page in MACHINES:
        found = table_rows.read(page)
        claim, _, decides = OPENINGS[page](CommittedRows(found))
        out.append([ARTICLES[page], claim, _told(decided(page, found)), decides, f"[{page}]({page}.md)"])
    claim, decides = STIFFNESS
    out.append(["article S4, stiffness", claim, _told(herringbone_page.judged()[1]), decides, "[herringbone](herringbone.md)"])
    return out


def _told(found):
    """Return the counts of the verdicts of a model."""
    return verdicts.counts(
        [row for row in found if row.kind in ("model", verdicts.STATEMENT) and row.verdict != verdicts.FORMULA]
    )


def run(again=True):
    """Write the page."""
    write(
        "two_minutes",
        "Few printed numbers of the five articles are reproduced, because the articles leave out bores, loads, bearings and "
        "damping. Most of their statements hold for some of these values and fail for others.",
        Table(("article", "it claims", "verdict", "what decides it", "page"), rows()).markdown().splitlines(),
        [
            "A number is *reproduced* within the tolerance that its page states. A statement *depends* on unprinted inputs if "
            "it holds in some of their joint draws only. The linked pages contain every number.",
        ],
    )
