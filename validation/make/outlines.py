"""The page `outlines`: whole outlines of gears, without load and pressed together, beside gearfe.

The arbiter needs no more of gearfe than the shape of gears, so that no change of its contact or flexibility makes rows old; what
else is needed is imported where it is used.
"""


def arbiter():
    """Compute what is not on file: gaps of random pairs, sections pressed by the arbiter, and by CalculiX."""
    from ..shared import outlines_plane
    from ..shared.arbiter import kept, unloaded_table
    from ..shared.arbiter.cases import fresh

    unloaded_table.reference()
    kept.reference()
    kept.reference(fresh(), kept.FRESH)
    outlines_plane.reference()


def reference():
    """Compute what is not on file of whole gears by CalculiX."""
    from ..shared import outlines_three

    outlines_three.reference()


def run(parts=()):
    """Write the page; `parts`: ``arbiter``, or beginnings of the rows whose `ritz3d` is computed anew, or ``all``."""
    if "arbiter" in parts:
        arbiter()
        return
    from ..shared import outlines_page, page

    outlines_page.write(page.anew(parts))
