"""Page `three`: `ritz3d` compared with CalculiX."""

from ..shared import outsider, page
from ..shared.kept_rows import stored
from . import outsider_three

HOW = """
`python -m validation three` writes this page from `tables/outsider_three*` and computes `ritz3d`. With `--reference`, CalculiX
(`ccx`) computes the finest mesh of each case. Coarser meshes on file show the remaining change of k.
"""
PAIRS = "[pairs_three.md](pairs_three.md) has hexahedra of pairs over their engagement."


def answer():
    """Return the first sentence of the page."""
    contact, line = outsider_three.worst()
    return (
        f"`ritz3d` is within {100 * contact:.2f} % of CalculiX in contact, {100 * outsider_three.pits_apart():.2f} % in "
        "the loss of k"
        f" by pits as lost contact, and {100 * line:.2f} % under line loads."
    )


def text():
    """Return the arguments of `page.text` from the tables."""
    return answer(), HOW, outsider_three.section(), [PAIRS]


def reference():
    """Compute the runs."""
    outsider.reference()


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    outsider.refresh(again)
    page.write("three", *text())


def cheap():
    """Yield the rows that `validation.check` computes again: `ritz3d` for all cases."""
    for name, row in stored(outsider.OURS).items():
        yield name, row, lambda name=name: outsider.ritz3d_row(name)
