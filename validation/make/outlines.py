"""Page `outlines`: whole outlines of gears pressed together, compared with gearfe.

The independent solver (`shared.arbiter`) takes only the tooth shapes from gearfe.
"""

from ..shared import outlines_page
from ..shared.arbiter import kept
from ..shared.arbiter.cases import fresh


def reference():
    """Compute the sections with the independent solver."""
    kept.reference()
    kept.reference(fresh(), kept.FRESH)


def run(again=True):
    """Write the page from the stored rows and present results of gearfe."""
    outlines_page.write()
