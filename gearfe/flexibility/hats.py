"""Hat pressures along a loaded flank: how long they are, and which stand next to the tip corner.

Finite elements load all of a flank by them, the energy model only the part next to the tip corner, where contact is resolved hat
by hat (`gearfe.contact.plane`).
"""

import numpy as np
from numpy.typing import NDArray

SPAN = 2  # edges of the flank on either side of a hat's top
FLANK_EDGES = {"flank": 0.05, "tip": 0.0005, "low": 0.02}  # edges in modules: of the flank, at its tip corner, at its lower end
TIP_ZONE = 0.35  # arc below the tip corner [m_n] in which a contact can be resolved hat by hat


def hat_knots(arc: NDArray, *, corner: bool = False) -> NDArray:
    """Start, top and end ``(3, n)`` [mm] of hats over the flank's edges, a top on every `SPAN`-th inner end of an edge.

    Parameters
    ----------
    arc : ndarray, shape (m,)
        Ends of the edges along the flank, from root to tip [mm].
    corner : bool
        Add a last, one-sided hat with its top at the tip corner.
    """
    knots = np.array([arc[: -2 * SPAN : SPAN], arc[SPAN:-SPAN:SPAN], arc[2 * SPAN :: SPAN]])
    return np.column_stack([knots, [arc[-1 - SPAN], arc[-1], arc[-1]]]) if corner else knots
