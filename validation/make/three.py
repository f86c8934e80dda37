"""The page `three`: `ritz3d` beside CalculiX, and beside hexahedra of both whole gears."""

from ..shared import outsider, page
from ..shared.kept_rows import stored
from . import outsider_three, pairs_three

HOW = """
`python -m validation three` makes this page from `tables/outsider_three*` and `tables/pairs_three*` and
computes gearfe's `ritz3d`; `... three --reference` computes the runs of CalculiX (`ccx`) and of the hexahedra.
"""


def answer():
    """The first line."""
    (contact, line), (mean, phase) = outsider_three.worst(), pairs_three.worst()
    return (
        f"`ritz3d` is within {100 * contact:.2f} % of CalculiX in contact ({100 * outsider_three.pits_apart():.2f} % in what pits"
        f" take as lost contact) and {100 * line:.2f} % under line loads, and within "
        f"{100 * mean:.2f} % of hexahedra of both gears in the mean over an engagement, {100 * phase:.2f} % at a phase."
    )


def text(again=False):
    """The page."""
    pairs = pairs_three.section(again)
    return answer(), HOW.strip().splitlines(), outsider_three.section(), pairs


def reference():
    """Compute the runs."""
    outsider.reference()
    pairs_three.reference()


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    outsider.refresh(again)
    page.write("three", *text(again))


def cheap():
    """Rows that `validation.check` computes again: `ritz3d` of all cases."""
    for name, row in stored(outsider.OURS).items():
        yield name, row, lambda name=name: outsider.ritz3d_row(name)
    for name, (_, pair) in pairs_three.pairs().items():
        for case in pairs_three.CASES:
            row = stored(pairs_three.OURS)[f"{name}, {case}"]
            yield row["row"], row["k"], lambda pair=pair, case=case: pairs_three.model_curve(pair, case)[0].tolist()
