"""The page `three`: `ritz3d` beside CalculiX, and beside hexahedra of both whole gears."""

from ..shared import decks, outlines_three, outsider, page
from . import outsider_three, pairs_three

HOW = """
`python -m validation three` makes this page from `tables/outsider_three*` and `tables/pairs_three*`; `... three all` computes
gearfe's `ritz3d` anew; `... three --reference` computes the runs of CalculiX (`ccx`) and of the hexahedra that are not on file;
`... three decks` writes the decks of all runs, which tells those that a change of gearfe made old.
"""


def answer():
    """The first line."""
    (contact, line), (mean, phase) = outsider_three.worst(), pairs_three.worst()
    return (
        f"`ritz3d` is within {100 * contact:.2f} % of CalculiX in contact ({100 * outsider_three.pits_apart():.2f} % in what pits"
        f" take as lost contact) and {100 * line:.2f} % under line loads, and within "
        f"{100 * mean:.2f} % of hexahedra of both gears in the mean over an engagement, {100 * phase:.2f} % at a phase."
    )


def text(again=()):
    """The page."""
    pairs = pairs_three.section(again)
    return answer(), HOW.strip().splitlines(), outsider_three.section(), pairs


def reference():
    """Compute the runs that are not on file."""
    outsider.reference()
    pairs_three.reference()


def run(parts=()):
    """Write the page; `parts`: beginnings of the rows of `ritz3d` that are computed anew, or ``all``; or write ``decks``."""
    if "decks" in parts:
        from . import flanks  # here, so that no row of this page depends on it

        decks.write(outsider.write_decks, outlines_three.write_decks, flanks.write_decks)
        return
    again = page.anew(parts)
    outsider.refresh(again)
    page.write("three", *text(again))
