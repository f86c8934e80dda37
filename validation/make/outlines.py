"""The page `outlines`: whole outlines of gears pressed together, compared with gearfe.

The independent solver (`shared.arbiter`) uses only the shape of gears of gearfe.
"""

from ..shared import outlines_page
from ..shared.arbiter import kept
from ..shared.arbiter.cases import fresh


def reference():
    """Compute sections pressed by the arbiter."""
    kept.reference()
    kept.reference(fresh(), kept.FRESH)


def run(again=True):
    """Write the page, which compares the rows on file with the present gearfe."""
    outlines_page.write()
