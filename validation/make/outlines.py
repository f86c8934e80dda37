"""The page `outlines`: whole outlines of gears pressed together, compared with gearfe.

The arbiter needs no more of gearfe than the shape of gears.
"""

from ..shared import outlines_page, outlines_three
from ..shared.arbiter import kept
from ..shared.arbiter.cases import fresh
from ..shared.kept_rows import stored


def reference():
    """Compute sections pressed by the arbiter, and whole gears by CalculiX."""
    kept.reference()
    kept.reference(fresh(), kept.FRESH)
    outlines_three.reference()


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    outlines_page.write(again)


def cheap():
    """Rows that `validation.check` computes again: `ritz3d` of the pairs that CalculiX pressed."""
    for name, row in stored(outlines_three.OURS).items():
        yield name, row, lambda name=name: outlines_three.ours_row(name)
